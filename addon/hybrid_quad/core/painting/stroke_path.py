"""From the places that a pen passes to evenly spaced dabs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..mesh_arrays import FloatArray, unit_vectors
from .brush_surface import Dabs

_SHORTEST = 0.25  # of the spacing: the least that a stroke's end makes a dab of


class PenPlace(NamedTuple):
    """Where a pen is on a surface.

    Attributes
    ----------
    position, normal : (3,) float64
    polygon : int
    pressure : float
        0..1.
    size : float
        Above 0, to 1: the part of the brush's radius that it reaches here.
    """

    position: FloatArray
    normal: FloatArray
    polygon: int
    pressure: float = 1.0
    size: float = 1.0


class StrokePath:
    """Makes dabs of the way of a pen.

    A dab lies in the middle of a piece of the way as long as the spacing and points from its one end to its other, so that it says
    where the stroke goes there, whatever the hand's trembling within less. Places should be closer than the spacing.

    Parameters
    ----------
    spacing : float
        Of dabs of full size; smaller ones lie closer.
    """

    def __init__(self, spacing: float) -> None:
        self._spacing = spacing
        self._piece: list[PenPlace] = []
        self._length = 0.0
        self._has_dabs = False

    def add(self, place: PenPlace) -> Dabs:
        """Goes on to a place; returns the dab that it completes, or none."""
        if self._piece:
            self._length += float(np.linalg.norm(place.position - self._piece[-1].position))
        self._piece.append(place)
        if self._length < self._spacing * place.size:
            return dabs_of([])
        dab = self._dab()
        self._piece, self._length = [place], 0.0
        return dab

    def lift(self) -> Dabs:
        """Ends the way, maybe to go on elsewhere; returns the dab of what is left of it, or none.

        A way without length is a dab without direction.
        """
        piece, has_dabs = self._piece, self._has_dabs
        is_long = self._length > _SHORTEST * self._spacing
        dab = self._dab() if piece and (is_long or not has_dabs) else dabs_of([])
        self._piece, self._length, self._has_dabs = [], 0.0, False
        return dab

    def _dab(self) -> Dabs:
        points = np.array([place.position for place in self._piece])
        along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        middle = self._piece[int(np.abs(along - along[-1] / 2).argmin())]
        heading = points[-1] - points[0]
        tangent = heading - (heading @ middle.normal) * middle.normal
        self._has_dabs = True
        return dabs_of([(middle, tangent)])


def dabs_of(places: list[tuple[PenPlace, FloatArray]]) -> Dabs:
    """Dabs at some places, along vectors of any length."""
    return Dabs(
        np.array([place.position for place, _ in places], np.float64).reshape(-1, 3),
        unit_vectors(np.array([vector for _, vector in places], np.float64).reshape(-1, 3)),
        np.array([place.polygon for place, _ in places], np.int64),
        np.array([place.pressure for place, _ in places], np.float64),
        np.array([place.size for place, _ in places], np.float64),
    )
