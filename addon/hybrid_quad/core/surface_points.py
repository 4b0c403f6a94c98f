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
    tree = _BoxTree(vertices[triangles])
    positions = np.empty((len(points), 3))
    found = np.empty(len(points), np.int64)
    for begin in range(0, len(points), _POINTS):
        part = slice(begin, begin + _POINTS)
        positions[part], found[part] = tree.nearest(points[part])
    return SurfacePoints(positions, found)


class _BoxTree:
    """Boxes around triangles that lie together, around pairs of these, and so on up to one box around all.

    Parameters
    ----------
    corners : (t, 3, 3) float64
    """

    def __init__(self, corners: FloatArray) -> None:
        order = np.argsort(_place_on_curve(corners.mean(axis=1)), kind="stable")
        leaves = 1 << max(0, int(np.ceil(np.log2(len(order) / _LEAF))))
        # The last triangle again and again fills the last boxes.
        self._triangles = np.concatenate([order, np.repeat(order[-1], leaves * _LEAF - len(order))])
        self._corners = corners[self._triangles]
        boxed = self._corners.reshape(leaves, 3 * _LEAF, 3)
        low, high = boxed.min(axis=1), boxed.max(axis=1)
        self._levels = [(low, high)]  # from the root down
        while len(low) > 1:
            low, high = low.reshape(-1, 2, 3).min(axis=1), high.reshape(-1, 2, 3).max(axis=1)
            self._levels.insert(0, (low, high))

    def nearest(self, points: FloatArray) -> tuple[FloatArray, npt.NDArray[np.int64]]:
        """Of each point the nearest place of a triangle, and which: level by level, all boxes that may hold it."""
        which, box = np.arange(len(points)), np.zeros(len(points), np.int64)
        bound = np.full(len(points), np.inf)
        gap = np.zeros(len(points))
        for level, (low, high) in enumerate(self._levels):
            if level:
                which, box = np.repeat(which, 2), (2 * box[:, None] + (0, 1)).ravel()
            below, above = low[box] - points[which], points[which] - high[box]
            gap = np.linalg.norm(np.maximum(np.maximum(below, above), 0), axis=1)
            # No place in a box is farther than its farthest corner.
            np.minimum.at(bound, which, np.linalg.norm(np.maximum(np.abs(below), np.abs(above)), axis=1))
            near = gap <= bound[which]
            which, box, gap = which[near], box[near], gap[near]
        # The most promising box of each point first: it leaves few of the others.
        order = np.lexsort((gap, which))
        first = order[np.searchsorted(which[order], np.arange(len(points)))]
        places, squared, triangles = self._nearest_in_boxes(points, which[first], box[first])
        best = (np.sqrt(squared), places, triangles)
        others = gap <= best[0][which]
        others[first] = False
        which, box = which[others], box[others]
        for begin in range(0, len(which), _PAIRS // _LEAF):
            part = slice(begin, begin + _PAIRS // _LEAF)
            places, squared, triangles = self._nearest_in_boxes(points, which[part], box[part])
            order = np.lexsort((squared, which[part]))
            owners, chosen = np.unique(which[part][order], return_index=True)
            chosen = order[chosen]
            closer = np.sqrt(squared[chosen]) < best[0][owners]
            for kept, new in zip(best, (np.sqrt(squared), places, triangles), strict=True):
                kept[owners[closer]] = new[chosen[closer]]
        return best[1], best[2]

    def _nearest_in_boxes(
        self, points: FloatArray, which: npt.NDArray[np.int64], box: npt.NDArray[np.int64]
    ) -> tuple[FloatArray, FloatArray, npt.NDArray[np.int64]]:
        """For pairs of a point and a box: the nearest place, its squared distance, and its triangle."""
        at = (_LEAF * box[:, None] + np.arange(_LEAF)).ravel()
        own = np.repeat(points[which], _LEAF, axis=0)
        places = nearest_in_triangles(own, self._corners[at])
        squared = ((places - own) ** 2).sum(axis=1).reshape(-1, _LEAF)
        chosen = _LEAF * np.arange(len(box)) + squared.argmin(axis=1)
        return places[chosen], squared.min(axis=1), self._triangles[at[chosen]]


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
    """Points sorted into cells as large as a radius, so that those within it of other points are found quickly.

    Parameters
    ----------
    others : (n, 3) float64
        At least one.
    radius : float
    """

    def __init__(self, others: FloatArray, radius: float) -> None:
        self._others, self._radius = others, radius
        self._low = others.min(axis=0)
        cells = np.floor((others - self._low) / radius).astype(np.int64)
        self._size = cells.max(axis=0) + 3  # a border of empty cells all around
        keys = _cell_keys(cells, self._size)
        self._order = np.argsort(keys, kind="stable")
        self._keys = keys[self._order]

    def pairs(self, points: FloatArray) -> Iterator[tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], FloatArray]]:
        """All pairs of one of `points` and a point of the grid closer than the radius, as :func:`pairs_within` gives them."""
        own = np.floor((points - self._low) / self._radius).astype(np.int64)
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
