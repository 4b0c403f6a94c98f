"""Nearest points of a triangle surface, in numpy alone."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .mesh_arrays import FloatArray, IntArray, Polygons

_CHUNK = 4_000_000  # pairs looked at together: bounds the memory


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

    Only those triangles are measured whose bounding sphere can hold the nearest point.

    Parameters
    ----------
    points : (k, 3) float64
    vertices : (n, 3) float64
    triangles : (t, 3) int
    """
    corners = vertices[triangles]
    centers = corners.mean(axis=1)
    radii = np.linalg.norm(corners - centers[:, None], axis=2).max(axis=1)
    positions = np.empty((len(points), 3))
    found = np.empty(len(points), np.int64)
    step = max(1, _CHUNK // max(1, len(triangles)))
    for begin in range(0, len(points), step):
        chunk = points[begin : begin + step]
        distance = _pair_distances(chunk, centers)
        farthest = (distance + radii).min(axis=1)
        slack = 1e-6 * (farthest + radii.max())  # of the rounding in the distances
        which, candidate = np.nonzero(distance - radii <= (farthest + slack)[:, None])
        nearest = _nearest_in_triangles(chunk[which], corners[candidate])
        squared = ((nearest - chunk[which]) ** 2).sum(axis=1)
        order = np.lexsort((candidate, squared, which))
        first = order[np.searchsorted(which[order], np.arange(len(chunk)))]
        positions[begin : begin + step] = nearest[first]
        found[begin : begin + step] = candidate[first]
    return SurfacePoints(positions, found)


def pairs_within(
    points: FloatArray, others: FloatArray, radius: float
) -> Iterator[tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], FloatArray]]:
    """All pairs of a point and an other one closer than `radius`: indices of both and their distance, in parts."""
    low = others.min(axis=0)
    cells = np.floor((others - low) / radius).astype(np.int64)
    size = cells.max(axis=0) + 3  # a border of empty cells all around
    keys = _cell_keys(cells, size)
    order = np.argsort(keys, kind="stable")
    keys = keys[order]
    own = np.floor((points - low) / radius).astype(np.int64)
    for shift in np.ndindex(3, 3):
        # Three cells in a row along z are one range of keys.
        cell = own + np.array([shift[0] - 1, shift[1] - 1, 0])
        inside = ((cell >= -1) & (cell <= size - 2)).all(axis=1)
        at = np.flatnonzero(inside)
        middle = _cell_keys(cell[at], size)
        first = np.searchsorted(keys, middle - 1, "left")
        count = np.searchsorted(keys, middle + 1, "right") - first
        ends = np.cumsum(count)
        for begin, end in _parts(ends, _CHUNK):
            part = count[begin:end]
            which = np.repeat(at[begin:end], part)
            within = np.arange(len(which)) - np.repeat(np.cumsum(part) - part, part)
            other = order[np.repeat(first[begin:end], part) + within]
            distance = np.linalg.norm(points[which] - others[other], axis=1)
            near = distance < radius
            yield which[near], other[near], distance[near]


def _cell_keys(cells: npt.NDArray[np.int64], size: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    keys: npt.NDArray[np.int64] = ((cells[:, 0] + 1) * size[1] + cells[:, 1] + 1) * size[2] + cells[:, 2] + 1
    return keys


def _parts(ends: npt.NDArray[np.int64], most: int) -> Iterator[tuple[int, int]]:
    """Ranges of rows with about `most` items each, `ends` counting the items up to and with each row."""
    begin = 0
    while begin < len(ends):
        done = int(ends[begin - 1]) if begin else 0
        end = max(begin + 1, int(np.searchsorted(ends, done + most, "right")))
        yield begin, end
        begin = end


def _pair_distances(a: FloatArray, b: FloatArray) -> FloatArray:
    """(k, l) distances of two lists of points, to about 1e-7 of their extent."""
    middle = b.mean(axis=0)
    a, b = a - middle, b - middle
    squared = (a**2).sum(axis=1)[:, None] + (b**2).sum(axis=1) - 2 * (a @ b.T)
    distances: FloatArray = np.sqrt(np.maximum(squared, 0))
    return distances


def _nearest_in_triangles(p: FloatArray, corners: FloatArray) -> FloatArray:
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
