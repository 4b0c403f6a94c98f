"""Which places of the source surface the vertices, faces, face corners and edges of a result correspond to."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..mesh_arrays import FloatArray, IntArray, unit_vectors
from ..surface_places import Indices, Places, TriangleMesh, places_in
from ..surface_walk import BoolArray, CornerPlaces, SurfaceWalk
from .nearest import NearestEdges, NearestTriangles

# An edge follows another one that passes within this share of its length and runs along it.
_FOLLOWING_DISTANCE = 0.25
_FOLLOWING_COSINE = np.cos(np.radians(30))


class Correspondence:
    """Places of a source surface for each element of a quad mesh that was made of it.

    Parameters
    ----------
    source : TriangleMesh
    points : (n, 3) float64
        Vertices of the quad mesh, in the same space.
    quads : (m, 4) int
        Wound as the source's triangles.
    """

    def __init__(self, source: TriangleMesh, points: FloatArray, quads: IntArray) -> None:
        self.source = source
        self.points = points
        self.quads = quads.astype(np.int64)
        corners = points[self.quads]
        self._middles = corners.mean(axis=1)
        self._normals = unit_vectors(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]))
        self._radii = np.linalg.norm(corners - self._middles[:, None], axis=2).max(axis=1)
        self._corner_places: dict[bytes, CornerPlaces] = {}

    @cached_property
    def walk(self) -> SurfaceWalk:
        """Neighbours of the source's triangles."""
        return SurfaceWalk(self.source)

    @cached_property
    def vertices(self) -> Places:
        """Of the n vertices."""
        found = self._nearest.find(self.points, self._vertex_normals, self.vertex_reach)
        return places_in(self.points, self.source, found)

    @cached_property
    def vertex_reach(self) -> FloatArray:
        """(n,) the radius of the largest quad at each vertex."""
        reach = np.zeros(len(self.points))
        for corner in self.quads.T:
            np.maximum.at(reach, corner, self._radii)
        return reach

    @cached_property
    def faces(self) -> Places:
        """Of the middles of the m quads."""
        found = self._nearest.find(self._middles, self._normals, self._radii)
        return places_in(self._middles, self.source, found)

    @cached_property
    def polygons(self) -> Indices:
        """(m,) the source polygon at the middle of each quad."""
        return self.source.polygons[self.faces.triangles]

    @cached_property
    def vertices_against(self) -> int:
        """How many vertices correspond to places that face the other way, for want of others."""
        own = self.source.normals()[self.vertices.triangles]
        return int(((own * self._vertex_normals).sum(axis=1) < 0).sum())

    def corners(self, walls: BoolArray) -> CornerPlaces:
        """Of the 4 * m corners, all corners of a face on one side of walls (t, 3) between the source's triangles."""
        key = np.packbits(walls).tobytes()
        if key not in self._corner_places:
            self._corner_places[key] = self._find_corners(walls)
        return self._corner_places[key]

    def followed(self, edges: IntArray, source_points: FloatArray, source_edges: IntArray) -> Indices:
        """For each of some edges of the result the source edge that it runs along, or -1."""
        begin, end = (self.points[edges[:, side]] for side in (0, 1))
        along, length = unit_vectors(end - begin), np.linalg.norm(end - begin, axis=1)
        source_along = unit_vectors(source_points[source_edges[:, 1]] - source_points[source_edges[:, 0]])
        owner, edge, gap = NearestEdges(source_points, source_edges).find_all(
            0.5 * (begin + end), _FOLLOWING_DISTANCE * length
        )
        fits = np.abs(np.einsum("ij,ij->i", source_along[edge], along[owner])) > _FOLLOWING_COSINE
        owner, edge, gap = owner[fits], edge[fits], gap[fits]
        order = np.lexsort((gap, owner))
        owners, first = np.unique(owner[order], return_index=True)
        result = np.full(len(edges), -1, np.int64)
        result[owners] = edge[order][first]
        return result

    @cached_property
    def _vertex_normals(self) -> FloatArray:
        """(n, 3) means of the quads' normals: short where these cancel out."""
        normals = np.zeros_like(self.points)
        for corner in self.quads.T:
            np.add.at(normals, corner, self._normals)
        uses = np.bincount(self.quads.ravel(), minlength=len(self.points))
        return normals / np.maximum(uses, 1)[:, None]

    @cached_property
    def _nearest(self) -> NearestTriangles:
        return NearestTriangles(self.source)

    def _find_corners(self, walls: BoolArray) -> CornerPlaces:
        of_corners = self.vertices.among(self.quads.ravel())
        edges = self.walk.wall_edges(walls)
        near = np.zeros(0, np.int64)
        if len(edges):
            # Corners may be beyond a wall that is farther away: across a thin part from the middle.
            islands = self.walk.islands(walls)
            strays = islands[of_corners.triangles].reshape(-1, 4) != islands[self.faces.triangles][:, None]
            is_near = NearestEdges(self.source.points, edges).find(self._middles, 1.01 * self._radii) >= 0
            near = np.flatnonzero(is_near | strays.any(axis=1))
        corner = (4 * near[:, None] + np.arange(4)).ravel()
        quads = self.quads[near]
        found = self.walk.corner_places(
            walls, self.faces.among(near), self.points[quads], quads, of_corners.among(corner)
        )
        triangles, weights = of_corners.triangles.copy(), of_corners.weights.copy()
        triangles[corner], weights[corner] = found.places
        return found._replace(places=Places(triangles, weights), beyond=corner[found.beyond])
