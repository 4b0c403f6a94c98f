"""Edges at which something about a polygon mesh changes: its direction, or a value of faces or of their corners."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .mesh_arrays import FloatArray, IntArray, Polygons, unit_vectors

BoolArray = npt.NDArray[np.bool_]


class EdgeSides:
    """Which two polygons meet at each of some edges, and with which of their corners.

    Edges with one polygon, or more than two, have no sides here: nothing can change across them.

    Parameters
    ----------
    polygons : Polygons
    edges : (k, 2) int32
        Vertex pairs, in any order of the two.
    vertex_count : int
    """

    def __init__(self, polygons: Polygons, edges: IntArray, vertex_count: int) -> None:
        self._polygons = polygons
        self._edge_count = len(edges)
        following = following_corners(polygons)
        sides = np.stack([polygons.vertices, polygons.vertices[following]], axis=1)
        keys, wanted = edge_keys(sides, vertex_count), edge_keys(edges, vertex_count)
        order = np.argsort(keys, kind="stable")
        keys = keys[order]
        # Looked for in their order: each is then found where the one before was.
        along = np.argsort(wanted)
        first, count = (np.empty(len(wanted), np.int64) for _ in range(2))
        first[along] = np.searchsorted(keys, wanted[along], "left")
        count[along] = np.searchsorted(keys, wanted[along], "right")
        count -= first
        self._inner = np.flatnonzero(count == 2)
        # Corners at which the edge begins in either polygon, and those at which it ends.
        self._begin = np.stack([order[first[self._inner]], order[first[self._inner] + 1]], axis=1)
        self._end = following[self._begin]

    def where_faces_bend(self, vertices: FloatArray, angle: float) -> BoolArray:
        """(k,) Whether the normals of an edge's polygons differ by more than `angle` radians."""
        normals = polygon_normals(vertices, self._polygons)[self._owners()]
        return self._spread(np.einsum("ij,ij->i", normals[:, 0], normals[:, 1]) < np.cos(angle))

    def where_faces_differ(self, values: npt.ArrayLike) -> BoolArray:
        """(k,) Whether an edge's polygons have different values, one value a polygon."""
        own = np.asarray(values)[self._owners()]
        return self._spread(own[:, 0] != own[:, 1])

    def where_corners_differ(self, values: npt.ArrayLike, tolerance: float = 1e-6) -> BoolArray:
        """(k,) Whether the values of an edge's two polygons differ at either end of it.

        Parameters
        ----------
        values : (C, d) float
            For every corner of every polygon, for example its place in a UV map.
        """
        at = np.asarray(values, np.float64)
        vertices = self._polygons.vertices
        # Two polygons of one orientation pass their edge in opposite directions.
        alike = vertices[self._begin[:, 0]] == vertices[self._begin[:, 1]]
        begin = np.where(alike, self._begin[:, 1], self._end[:, 1])
        end = np.where(alike, self._end[:, 1], self._begin[:, 1])
        gap: Any = np.abs(at.take(self._begin[:, 0], axis=0) - at.take(begin, axis=0))
        np.maximum(gap, np.abs(at.take(self._end[:, 0], axis=0) - at.take(end, axis=0)), out=gap)
        return self._spread((gap > tolerance).any(axis=1))

    def _owners(self) -> Any:
        return np.repeat(np.arange(len(self._polygons.sizes)), self._polygons.sizes)[self._begin]

    def _spread(self, of_inner: BoolArray) -> BoolArray:
        result = np.zeros(self._edge_count, np.bool_)
        result[self._inner] = of_inner
        return result


def uses_of_edges(edges: IntArray, polygons: Polygons, vertex_count: int) -> npt.NDArray[np.int64]:
    """(k,) how many sides of polygons lie on each of some vertex pairs."""
    sides = np.stack([polygons.vertices, polygons.vertices[following_corners(polygons)]], axis=1)
    keys = np.sort(edge_keys(sides, vertex_count))
    wanted = edge_keys(edges, vertex_count)
    uses: npt.NDArray[np.int64] = np.searchsorted(keys, wanted, "right") - np.searchsorted(keys, wanted, "left")
    return uses


def following_corners(polygons: Polygons) -> Any:
    """(C,) The corner after each, around its polygon."""
    following = np.arange(1, len(polygons.vertices) + 1)
    filled = polygons.sizes > 0
    ends = np.cumsum(polygons.sizes)[filled]
    following[ends - 1] = ends - polygons.sizes[filled]
    return following


def edge_keys(edges: IntArray, vertex_count: int) -> npt.NDArray[np.int64]:
    """One number for each vertex pair, the same for both orders of the two."""
    one, other = edges[:, 0].astype(np.int64), edges[:, 1].astype(np.int64)
    keys: npt.NDArray[np.int64] = np.minimum(one, other) * vertex_count + np.maximum(one, other)
    return keys


def polygon_normals(vertices: FloatArray, polygons: Polygons) -> FloatArray:
    """(#F, 3) Unit normals by Newell's rule; zero for a polygon without area."""
    filled = polygons.sizes > 0
    starts = (np.cumsum(polygons.sizes) - polygons.sizes)[filled]
    corner = vertices[polygons.vertices]
    first = np.repeat(corner[starts], polygons.sizes[filled], axis=0)  # near origin: no cancellation far away
    cross = np.cross(corner - first, corner[following_corners(polygons)] - first)
    normals = np.zeros((len(polygons.sizes), 3))
    if len(starts):
        normals[filled] = np.add.reduceat(cross, starts, axis=0)
    return unit_vectors(normals)
