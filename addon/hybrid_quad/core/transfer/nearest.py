"""Nearest triangles, edges and vertices of a surface, over one search tree."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from ..mesh_arrays import FloatArray, IntArray, unit_vectors
from ..surface_places import Indices, TriangleMesh
from ..surface_points import BoxTree, Pairs, as_near_as_the_nearest

# Share of the surface's extent by which distances differ through rounding alone. Not more: on a bent surface the nearest place
# of a triangle that is farther by this is aside by about its square root.
_AS_NEAR = 1e-10
_AS_WELL = 6  # digits of the cosines by which triangles as near are told apart


class NearestTriangles:
    """Finds triangles of a surface that face as what looks for them does.

    Where sheets are thin, the nearest triangle can be one of the other side; normals tell.
    """

    def __init__(self, mesh: TriangleMesh) -> None:
        normals = mesh.normals()
        # Triangles without area have no side; where there are only such, any will do.
        self._triangles = np.flatnonzero((normals**2).sum(axis=1) > 0)
        if not len(self._triangles):
            self._triangles = np.arange(len(mesh.vertices))
        self._normals = unit_vectors(normals[self._triangles])
        corners = mesh.points[mesh.vertices[self._triangles]]
        self._slack = _AS_NEAR * float(np.ptp(corners.reshape(-1, 3), axis=0).max())
        self._tree = BoxTree(corners)

    def find(self, points: FloatArray, normals: FloatArray, reach: FloatArray) -> Indices:
        """For every point the nearest triangle of those within `reach` that do not face against `normals`.

        The nearest one of all, where there is none of these. Of triangles as near (rounding left aside) the one whose normal
        agrees best with the point's; of several that agree as well, the one with the lowest number.

        Parameters
        ----------
        points : (k, 3) float64
        normals : (k, 3) float64
            Of length 1 or less; zero where every side is as good.
        reach : (k,) float64
        """
        found = np.zeros(len(points), np.int64)
        self._choose(found, normals, self._tree.as_near(points, self._slack))
        against = np.flatnonzero((self._normals[found] * normals).sum(axis=1) < 0)
        facing = self._facing(points, normals, reach, against)
        self._choose(found, normals, facing)
        return self._triangles[found]

    def _facing(self, points: FloatArray, normals: FloatArray, reach: FloatArray, chosen: Indices) -> Iterator[Pairs]:
        """Of some points the triangles within `reach` that face as they do, as far as they are as near as the nearest of these."""
        for which, triangles, gaps in self._tree.within(points[chosen], reach[chosen]):
            owners = chosen[which]
            facing = (self._normals[triangles] * normals[owners]).sum(axis=1) > 0
            yield as_near_as_the_nearest(owners[facing], triangles[facing], gaps[facing], self._slack)

    def _choose(self, found: Indices, normals: FloatArray, pairs: Iterable[Pairs]) -> None:
        """Sets, for the points in `pairs`, which triangle each has found."""
        for which, triangles, _ in pairs:
            agreement = (self._normals[triangles] * normals[which]).sum(axis=1).round(_AS_WELL)
            order = np.lexsort((triangles, -agreement, which))
            owners, first = np.unique(which[order], return_index=True)
            found[owners] = triangles[order][first]


class NearestEdges:
    """Finds edges of a surface.

    Parameters
    ----------
    points : (n, 3) float64
    edges : (k, 2) int
        Vertex pairs, at least one.
    """

    def __init__(self, points: FloatArray, edges: Indices | IntArray) -> None:
        # An edge is a triangle with two corners alike.
        self._tree = BoxTree(points[edges[:, [0, 1, 0]]])

    def find(self, points: FloatArray, reach: FloatArray) -> Indices:
        """(k,) for every point the nearest edge within `reach` (k,), or -1."""
        return self._tree.nearest(points, reach)[1]

    def find_all(self, points: FloatArray, reach: FloatArray) -> tuple[Indices, Indices, FloatArray]:
        """All pairs of a point and an edge within its `reach` (k,): numbers of both and their distance."""
        parts = list(self._tree.within(points, reach))
        if not parts:
            return np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros(0)
        owners, edges, gaps = (np.concatenate(column) for column in zip(*parts, strict=True))
        return owners, edges, gaps


class NearestVertices:
    """Finds points of a set.

    Parameters
    ----------
    points : (n, 3) float64
        At least one.
    """

    def __init__(self, points: FloatArray) -> None:
        # A point is a triangle with three corners alike.
        self._tree = BoxTree(np.repeat(points[:, None], 3, axis=1))

    def find(self, points: FloatArray) -> tuple[Indices, FloatArray]:
        """(k,) for every point the nearest one of the set, and how far it is."""
        places, found = self._tree.nearest(points)
        return found, np.linalg.norm(places - points, axis=1)
