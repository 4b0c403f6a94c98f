"""What a stroke does to the values of a surface's elements.

A stroke is a function of the values before it and of its path: where it passes an element more than once, or its dabs lie closer,
that changes nothing but by the strongest of them. Only smoothing goes on as long as the brush stays.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np

from ..mesh_arrays import FloatArray
from .brush_surface import BrushSurface, Dabs, Indices
from .falloff import falloff_at

# Of the radius: the deviation of the bell over which the directions of a stroke are averaged.
_BLUR = 0.14
# Smoothing reaches this part of the radius with every dab, in at most so many rounds.
_REACH = 0.5
_MOST_ROUNDS = 12
_DAMPING = 0.5  # with more, values that alternate would go on alternating


class Brush(NamedTuple):
    """A brush.

    Attributes
    ----------
    radius : float
        In the units of the surface.
    falloff : str
        One of :data:`~.falloff.FALLOFFS`.
    """

    radius: float
    falloff: str = "smooth"


class ValueStroke:
    """A stroke under way.

    Parameters
    ----------
    surface : BrushSurface
    values : (n,) or (n, 3) float64
        Of the surface's elements before the stroke. Zero is what they have where nothing was painted.
    brush : Brush

    Attributes
    ----------
    values : (n,) or (n, 3) float64
        After the dabs so far.
    """

    def __init__(self, surface: BrushSurface, values: FloatArray, brush: Brush) -> None:
        self.surface, self.brush = surface, brush
        self.values = values.copy()
        self._before = values
        self._coverage = np.zeros(len(values))

    def add(self, dabs: Dabs) -> Indices:
        """Goes on with some dabs; returns the elements whose values they changed."""
        raise NotImplementedError

    def _cover(self, dabs: Dabs) -> tuple[Indices, FloatArray]:
        """The elements touched, and how strongly each has been by the strongest dab of the whole stroke."""
        touches = self.surface.touched(dabs, self.brush.radius)
        weight = falloff_at(touches.distances, *self.brush) * dabs.strengths[touches.dabs]
        np.maximum.at(self._coverage, touches.elements, weight)
        elements = np.unique(touches.elements[weight > 0])
        return elements, self._coverage[elements]


class Erase(ValueStroke):
    """Takes away what was painted, as far as the brush is strong."""

    def add(self, dabs: Dabs) -> Indices:
        elements, coverage = self._cover(dabs)
        left = (1 - coverage).reshape(-1, *[1] * (self.values.ndim - 1))
        self.values[elements] = left * self._before[elements]
        return elements


class Shift(ValueStroke):
    """Adds a number, as far as the brush is strong.

    Parameters
    ----------
    amount : float
    bounds : (float, float)
        What comes of it is kept between these.
    """

    def __init__(
        self, surface: BrushSurface, values: FloatArray, brush: Brush, amount: float, bounds: tuple[float, float]
    ) -> None:
        super().__init__(surface, values, brush)
        self._amount, self._bounds = amount, bounds

    def add(self, dabs: Dabs) -> Indices:
        elements, coverage = self._cover(dabs)
        self.values[elements] = np.clip(self._before[elements] + coverage * self._amount, *self._bounds)
        return elements


class Comb(ValueStroke):
    """Turns directions along the stroke. They are mixed as crosses: a quarter turn makes no difference."""

    def __init__(self, surface: BrushSurface, values: FloatArray, brush: Brush) -> None:
        super().__init__(surface, values, brush)
        self._sum = np.zeros(len(values), np.complex128)
        self._heading = np.zeros_like(values)

    def add(self, dabs: Dabs) -> Indices:
        moving = np.asarray(dabs.tangents.any(axis=1))
        dabs = dabs.among(moving)
        touches = self.surface.touched(dabs, self.brush.radius)
        part = touches.distances / self.brush.radius
        weight = falloff_at(touches.distances, *self.brush) * dabs.strengths[touches.dabs]
        acting = weight > 0
        dab, element, part, weight = touches.dabs[acting], touches.elements[acting], part[acting], weight[acting]
        normals = self.surface.polygon_normals[dabs.polygons[dab]]
        along = self.surface.towards(dabs.tangents[dab], normals, element)
        # The nearest part of the stroke decides on the direction, the strongest on the strength.
        share = weight**2 * np.exp(-0.5 * (part / _BLUR) ** 2)
        np.add.at(self._sum, element, share * self.surface.crosses(along, element))
        np.maximum.at(self._coverage, element, weight)
        self._heading[element] = along
        elements = np.unique(element)
        size = np.abs(self._sum[elements])
        wanted = np.divide(self._sum[elements], size, out=np.zeros(len(elements), np.complex128), where=size > 0)
        coverage = self._coverage[elements]
        mixed = (1 - coverage) * self.surface.crosses(self._before[elements], elements) + coverage * wanted
        self.values[elements] = self.surface.vectors(mixed, elements, self._heading[elements])
        return elements


class _Smooth(ValueStroke):
    def add(self, dabs: Dabs) -> Indices:
        changed = []
        reach = _REACH * self.brush.radius / max(self.surface.spacing, 1e-300)
        rounds = int(np.clip(2 * reach, 1, _MOST_ROUNDS))
        touches = self.surface.touched(dabs, self.brush.radius)
        weight = _DAMPING * falloff_at(touches.distances, *self.brush) * dabs.strengths[touches.dabs]
        ends = np.searchsorted(touches.dabs, np.arange(len(dabs.positions) + 1))
        for begin, end in itertools.pairwise(ends):
            elements = touches.elements[begin:end]
            which, others = self.surface.neighbor_pairs(elements)
            for _ in range(rounds if len(which) else 0):
                self._smooth(elements, which, others, weight[begin:end])
            changed.append(elements)
        return np.unique(np.concatenate(changed)) if changed else np.zeros(0, np.int64)

    def _smooth(self, elements: Indices, which: Indices, others: Indices, weight: FloatArray) -> None:
        """Moves the elements' values towards the mean of their neighbours', `others[i]` being one of `elements[which[i]]`."""
        raise NotImplementedError


class SmoothNumbers(_Smooth):
    """Evens out numbers."""

    def _smooth(self, elements: Indices, which: Indices, others: Indices, weight: FloatArray) -> None:
        means = _means(self.values[others], which, self.values[elements])
        self.values[elements] += weight * (means - self.values[elements])


class SmoothDirections(_Smooth):
    """Evens out directions and strengths, each for itself: where directions disagree they do not become weaker."""

    def _smooth(self, elements: Indices, which: Indices, others: Indices, weight: FloatArray) -> None:
        own = self.surface.crosses(self.values[elements], elements)
        turned = self.surface.towards(self.values[others], self.surface.normals[others], elements[which])
        theirs = self.surface.crosses(turned, elements[which])
        mean = _means(theirs.real, which, own.real) + 1j * _means(theirs.imag, which, own.imag)
        strength = (1 - weight) * np.abs(own) + weight * _means(np.abs(theirs), which, np.abs(own))
        mixed = (1 - weight) * own + weight * mean
        scaled = strength * mixed / np.maximum(np.abs(mixed), 1e-12)
        # What was free gets the arm that its neighbours have.
        like = self.values[elements]
        free = ~like.any(axis=1)
        of_free = free[which] & turned.any(axis=1)
        like[which[of_free]] = np.where(free[which[of_free]][:, None], turned[of_free], like[which[of_free]])
        self.values[elements] = self.surface.vectors(scaled, elements, like)


def _means(values: FloatArray, which: Indices, without: FloatArray) -> FloatArray:
    """Of `values` the mean of those of each number in `which`; `without` where there are none."""
    count = np.bincount(which, minlength=len(without))
    sums = np.bincount(which, values, len(without))
    means: FloatArray = np.where(count > 0, sums / np.maximum(count, 1), without)
    return means
