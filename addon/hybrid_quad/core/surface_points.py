"""Nearest points of a triangle surface, in numpy alone."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .mesh_arrays import FloatArray, IntArray, Polygons

# What is looked at together: bounds the memory.
_POINTS = 2000
_PAIRS = 1_000_000
_LEAF = 8  # triangles of the smallest boxes
_MOST_CELLS = 1 << 20  # along each axis: their number is a whole one of 64 bits
_BEAM = 6  # boxes that are looked into for a first bound
# How much the squared distance to a box's middle counts beside the one to the box: little, so that it only tells apart boxes that
# hold a point, or are about as far from it. Any value gives a true bound; it says how tight that is.
_AWAY = 1e-3


class SurfacePoints(NamedTuple):
    """Points on a surface.

    Attributes
    ----------
    positions : (k, 3) float64
    triangles : (k,) int64
        The one each lies in.
    """

    positions: FloatArray
    triangles: npt.NDArray[np.int64]


def fan_triangles(polygons: Polygons) -> IntArray:
    """(t, 3) int32: every polygon as a fan from its first corner."""
    sizes = polygons.sizes.astype(np.int64)
    starts = np.cumsum(sizes) - sizes
    count = np.maximum(sizes - 2, 0)
    polygon = np.repeat(np.arange(len(sizes)), count)
    within = np.arange(len(polygon)) - np.repeat(np.cumsum(count) - count, count)
    first = starts[polygon]
    return np.stack([polygons.vertices[first + shift] for shift in (0 * within, within + 1, within + 2)], axis=1)


def nearest_on_surface(points: FloatArray, vertices: FloatArray, triangles: IntArray) -> SurfacePoints:
    """For every point the nearest one of some triangles, of which there must be one.

    Parameters
    ----------
    points : (k, 3) float64
    vertices : (n, 3) float64
    triangles : (t, 3) int
    """
    return SurfacePoints(*BoxTree(vertices[triangles]).nearest(points))


# Numbers of points and of triangles, and their distances.
Pairs = tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], FloatArray]


def as_near_as_the_nearest(
    which: npt.NDArray[np.int64], others: npt.NDArray[np.int64], gaps: FloatArray, slack: float
) -> Pairs:
    """Those of some pairs that are at most `slack` farther than the nearest one of the same point."""
    owners, own = np.unique(which, return_inverse=True)
    least = np.full(len(owners), np.inf)
    np.minimum.at(least, own, gaps)
    near = gaps <= least[own] + slack
    return which[near], others[near], gaps[near]


class BoxTree:
    """Boxes around triangles that lie together, around pairs of these, and so on up to one box around all.

    Parameters
    ----------
    corners : (t, 3, 3) float64
    """

    def __init__(self, corners: FloatArray) -> None:
        order = np.argsort(_place_on_curve(corners.mean(axis=1)), kind="stable")
        leaves = 1 << max(0, int(np.ceil(np.log2(len(order) / _LEAF))))
        # The last triangle again and again fills the last boxes.
        self._count = len(order)
        self._triangles = np.concatenate([order, np.repeat(order[-1], leaves * _LEAF - len(order))])
        self._corners = corners[self._triangles]
        self._low, self._high = self._corners.min(axis=1), self._corners.max(axis=1)
        low, high = (each.reshape(leaves, _LEAF, 3) for each in (self._low, self._high))
        low, high = low.min(axis=1), high.max(axis=1)
        self._levels = [(low, high)]  # from the root down
        while len(low) > 1:
            low, high = low.reshape(-1, 2, 3).min(axis=1), high.reshape(-1, 2, 3).max(axis=1)
            self._levels.insert(0, (low, high))

    def nearest(self, points: FloatArray, reach: FloatArray | None = None) -> tuple[FloatArray, npt.NDArray[np.int64]]:
        """(k, 3) and (k,) of each point the nearest place of a triangle, and which; of several the one with the lowest number.

        With a `reach` (k,), -1 and any place where no triangle is as near.
        """
        positions = np.zeros((len(points), 3))
        found = np.full(len(points), -1, np.int64)
        for which, triangles, places, squared in self._nearest_candidates(points, 0.0, reach):
            order = np.lexsort((triangles, squared, which))
            owners, first = np.unique(which[order], return_index=True)
            positions[owners], found[owners] = places[order][first], triangles[order][first]
        return positions, found

    def as_near(self, points: FloatArray, slack: float) -> Iterator[Pairs]:
        """All pairs of a point and a triangle at most `slack` farther than its nearest one, which are there for each point.

        In parts; all pairs of a point are in one of them.
        """
        for which, triangles, _, squared in self._nearest_candidates(points, slack):
            yield as_near_as_the_nearest(which, triangles, np.sqrt(squared), slack)

    def within(self, points: FloatArray, reach: FloatArray) -> Iterator[Pairs]:
        """All pairs of a point and a triangle within its `reach` (k,).

        In parts; all pairs of a point are in one of them.
        """
        for begin in range(0, len(points), _POINTS):
            part = slice(begin, begin + _POINTS)
            for which, triangles, _, squared in self._candidates(points[part], reach[part] ** 2):
                near = squared <= reach[begin + which] ** 2
                yield begin + which[near], triangles[near], np.sqrt(squared[near])

    def _nearest_candidates(
        self, points: FloatArray, slack: float, reach: FloatArray | None = None
    ) -> Iterator[_Candidates]:
        """As `_candidates`: all triangles at most `slack` farther than the nearest, within `reach` (k,) if given, and some more."""
        for begin in range(0, len(points), _POINTS):
            part = slice(begin, begin + _POINTS)
            bound = self._squared_bound(points[part])
            if slack:
                bound = (np.sqrt(bound) + slack) ** 2
            if reach is None:
                for which, triangles, places, squared in self._candidates(points[part], bound):
                    yield begin + which, triangles, places, squared
                continue
            squared_reach = reach[part] ** 2
            for which, triangles, places, squared in self._candidates(points[part], np.minimum(bound, squared_reach)):
                near = squared <= squared_reach[which]
                yield begin + which[near], triangles[near], places[near], squared[near]

    def _squared_bound(self, points: FloatArray) -> FloatArray:
        """(k,) squared distances of points to some corner of a triangle near each: on the way down the few nearest boxes stay."""
        box = np.zeros((len(points), 1), np.int64)
        for low, high in self._levels[1:]:
            box = (2 * box[:, :, None] + (0, 1)).reshape(len(points), -1)
            if box.shape[1] > _BEAM:
                gap = _squared_gaps(points[:, None], low[box], high[box])
                offset = points[:, None] - 0.5 * (low[box] + high[box])
                away = gap + _AWAY * np.einsum("...i,...i->...", offset, offset)
                box = np.take_along_axis(box, np.argpartition(away, _BEAM, axis=1)[:, :_BEAM], axis=1)
        at = (_LEAF * box[:, :, None] + np.arange(_LEAF)).reshape(len(points), -1)
        corners = self._corners[at, 0]
        squared: FloatArray = _squared_gaps(points[:, None], corners, corners).min(axis=1)
        return squared

    def _candidates(self, points: FloatArray, squared_reach: FloatArray) -> Iterator[_Candidates]:
        """Pairs of a point and a triangle whose box is within a point's reach: all that are near enough, and some more.

        In parts; all pairs of a point are in one of them.
        """
        which, box = np.arange(len(points)), np.zeros(len(points), np.int64)
        for level, (low, high) in enumerate(self._levels):
            if level:
                which, box = np.repeat(which, 2), (2 * box[:, None] + (0, 1)).ravel()
            near = _squared_gaps(points[which], low[box], high[box]) <= squared_reach[which]
            which, box = which[near], box[near]
        ends = np.cumsum(np.bincount(which, minlength=len(points)))
        for first, last in parts(ends, _PAIRS // _LEAF):
            part = slice(ends[first - 1] if first else 0, ends[last - 1])
            at = (_LEAF * box[part, None] + np.arange(_LEAF)).ravel()
            owners = np.repeat(which[part], _LEAF)
            near = at < self._count
            near &= _squared_gaps(points[owners], self._low[at], self._high[at]) <= squared_reach[owners]
            at, owners = at[near], owners[near]
            places = nearest_in_triangles(points[owners], self._corners[at])
            yield owners, self._triangles[at], places, ((places - points[owners]) ** 2).sum(axis=1)


# Numbers of points and of triangles, the triangles' places nearest to the points, and their squared distances.
_Candidates = tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], FloatArray, FloatArray]


def _squared_gaps(points: FloatArray, low: FloatArray, high: FloatArray) -> FloatArray:
    """(...) squared distances of points to boxes, zero inside."""
    gaps = np.maximum(np.maximum(low - points, points - high), 0)
    squared: FloatArray = np.einsum("...i,...i->...", gaps, gaps)
    return squared


def _place_on_curve(points: FloatArray) -> npt.NDArray[np.int64]:
    """(k,) Places on a curve through space along which neighbours lie together (Morton order)."""
    extent = np.ptp(points, axis=0).max() or 1.0
    cells = np.minimum((points - points.min(axis=0)) / extent * 2**20, 2**20 - 1).astype(np.int64)
    place = np.zeros(len(points), np.int64)
    for bit in range(20):
        for axis in range(3):
            place |= ((cells[:, axis] >> bit) & 1) << (3 * bit + axis)
    return place


def pairs_within(
    points: FloatArray, others: FloatArray, radius: float
) -> Iterator[tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], FloatArray]]:
    """All pairs of a point and an other one closer than `radius`: indices of both and their distance, in parts."""
    return PointGrid(others, radius).pairs(points)


class PointGrid:
    """Points sorted into cells no smaller than a radius, so that those within it of other points are found quickly.

    Parameters
    ----------
    others : (n, 3) float64
        At least one.
    radius : float
    """

    def __init__(self, others: FloatArray, radius: float) -> None:
        self._others, self._radius = others, radius
        self._low = others.min(axis=0)
        self._cell = max(radius, float(np.ptp(others, axis=0).max()) / _MOST_CELLS)
        cells = np.floor((others - self._low) / self._cell).astype(np.int64)
        self._size = cells.max(axis=0) + 3  # a border of empty cells all around
        keys = _cell_keys(cells, self._size)
        self._order = np.argsort(keys, kind="stable")
        self._keys = keys[self._order]

    def pairs(self, points: FloatArray) -> Iterator[tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], FloatArray]]:
        """All pairs of one of `points` and a point of the grid closer than the radius, as :func:`pairs_within` gives them."""
        own = np.floor((points - self._low) / self._cell).astype(np.int64)
        for shift in np.ndindex(3, 3):
            # Three cells in a row along z are one range of keys.
            cell = own + np.array([shift[0] - 1, shift[1] - 1, 0])
            inside = ((cell >= -1) & (cell <= self._size - 2)).all(axis=1)
            at = np.flatnonzero(inside)
            middle = _cell_keys(cell[at], self._size)
            first = np.searchsorted(self._keys, middle - 1, "left")
            count = np.searchsorted(self._keys, middle + 1, "right") - first
            ends = np.cumsum(count)
            for begin, end in parts(ends, _PAIRS):
                part = count[begin:end]
                which = np.repeat(at[begin:end], part)
                within = np.arange(len(which)) - np.repeat(np.cumsum(part) - part, part)
                other = self._order[np.repeat(first[begin:end], part) + within]
                distance = np.linalg.norm(points[which] - self._others[other], axis=1)
                near = distance < self._radius
                yield which[near], other[near], distance[near]


def _cell_keys(cells: npt.NDArray[np.int64], size: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    keys: npt.NDArray[np.int64] = ((cells[:, 0] + 1) * size[1] + cells[:, 1] + 1) * size[2] + cells[:, 2] + 1
    return keys


def parts(ends: npt.NDArray[np.int64], most: int) -> Iterator[tuple[int, int]]:
    """Ranges of rows with about `most` items each, `ends` counting the items up to and with each row."""
    begin = 0
    while begin < len(ends):
        done = int(ends[begin - 1]) if begin else 0
        end = max(begin + 1, int(np.searchsorted(ends, done + most, "right")))
        yield begin, end
        begin = end


def nearest_in_triangles(p: FloatArray, corners: FloatArray) -> FloatArray:
    """(k, 3) the point of each triangle nearest to each point: inside, or on the nearest of three sides."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    sides = [_nearest_on_segment(p, begin, end) for begin, end in ((a, b), (b, c), (c, a))]
    squared = np.stack([((p - q) ** 2).sum(axis=1) for q in sides])
    result: FloatArray = np.stack(sides)[squared.argmin(axis=0), np.arange(len(p))]
    normal = np.cross(b - a, c - a)
    area = (normal**2).sum(axis=1)
    inside = area > 0
    for begin, end in ((a, b), (b, c), (c, a)):
        inside &= (np.cross(end - begin, p - begin) * normal).sum(axis=1) >= 0
    height = np.divide(((p - a) * normal).sum(axis=1), area, out=np.zeros(len(p)), where=area > 0)
    result[inside] = (p - height[:, None] * normal)[inside]
    return result


def _nearest_on_segment(p: FloatArray, begin: FloatArray, end: FloatArray) -> FloatArray:
    along = end - begin
    length = (along**2).sum(axis=1)
    share = np.divide(((p - begin) * along).sum(axis=1), length, out=np.zeros(len(p)), where=length > 0)
    nearest: FloatArray = begin + np.clip(share, 0, 1)[:, None] * along
    return nearest
