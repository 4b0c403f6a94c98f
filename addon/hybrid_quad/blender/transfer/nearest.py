"""Nearest triangles and edges of a surface, by Blender's own search tree."""

from __future__ import annotations

import numpy as np
from mathutils.bvhtree import BVHTree

from ...core.mesh_arrays import FloatArray
from ...core.surface_places import Indices, TriangleMesh


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
        self._normals = normals[self._triangles]
        # Blender's tree is of single precision: near the origin it keeps more digits.
        self._center = 0.5 * (mesh.points.min(axis=0) + mesh.points.max(axis=0))
        self._tree = BVHTree.FromPolygons(
            (mesh.points - self._center).tolist(), mesh.vertices[self._triangles].tolist(), all_triangles=True
        )

    def find(self, points: FloatArray, normals: FloatArray, reach: FloatArray) -> Indices:
        """For every point the nearest triangle of those within `reach` that do not face against `normals`.

        The nearest one of all, where there is none of these.

        Parameters
        ----------
        points, normals : (k, 3) float64
        reach : (k,) float64
        """
        local = (points - self._center).tolist()
        nearest = self._tree.find_nearest
        found = np.fromiter((nearest(point)[2] for point in local), np.int64, len(local))
        for index in np.flatnonzero((self._normals[found] * normals).sum(axis=1) < 0).tolist():
            near = self._tree.find_nearest_range(local[index], float(reach[index]))
            facing = [(hit[3], hit[2]) for hit in near if self._normals[hit[2]] @ normals[index] > 0]
            if facing:
                found[index] = min(facing)[1]
        return self._triangles[found]


class NearestEdges:
    """Finds edges of a surface.

    Parameters
    ----------
    points : (n, 3) float64
    edges : (k, 2) int
        Vertex pairs, at least one.
    """

    def __init__(self, points: FloatArray, edges: Indices) -> None:
        self._center = 0.5 * (points.min(axis=0) + points.max(axis=0))
        # An edge is a triangle with two corners alike.
        self._tree = BVHTree.FromPolygons(
            (points - self._center).tolist(), edges[:, [0, 1, 0]].tolist(), all_triangles=True
        )

    def find(self, points: FloatArray, reach: FloatArray) -> Indices:
        """(k,) for every point the nearest edge within `reach` (k,), or -1."""
        nearest = self._tree.find_nearest
        found = (
            nearest(point, distance)[2]
            for point, distance in zip((points - self._center).tolist(), reach.tolist(), strict=True)
        )
        return np.fromiter((-1 if index is None else index for index in found), np.int64, len(points))

    def find_all(self, points: FloatArray, reach: FloatArray) -> tuple[Indices, Indices, FloatArray]:
        """All pairs of a point and an edge within its `reach` (k,): numbers of both and their distance."""
        near = self._tree.find_nearest_range
        hits = [
            near(point, distance)
            for point, distance in zip((points - self._center).tolist(), reach.tolist(), strict=True)
        ]
        owners = np.repeat(np.arange(len(points)), [len(some) for some in hits])
        edges = np.fromiter((hit[2] for some in hits for hit in some), np.int64, len(owners))
        gaps = np.fromiter((hit[3] for some in hits for hit in some), np.float64, len(owners))
        return owners, edges, gaps
