"""A mesh object as a surface to paint on: what is under the mouse, and where that is on the mesh that carries the values."""

from __future__ import annotations

from typing import Any, NamedTuple

import bmesh
import bpy
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree

from ...core.mesh_arrays import FloatArray, Polygons
from ...core.painting.brush_surface import BrushSurface, Dabs, Indices
from ...core.painting.stroke_path import PenPlace
from ...core.surface_places import weights_in
from ...core.surface_points import nearest_in_triangles
from ..transfer import buffers


class MeshShape(NamedTuple):
    """What decides where things are on a mesh.

    Attributes
    ----------
    points : (n, 3) float32
        In the object's space.
    polygons : Polygons
    """

    points: Any
    polygons: Polygons

    def equals(self, other: MeshShape) -> bool:
        """Whether both are the same bit by bit."""
        return self is other or (np.array_equal(self.points, other.points) and self.has_polygons_of(other))

    def has_polygons_of(self, other: MeshShape) -> bool:
        """Whether both have the same polygons, wherever their vertices are."""
        if len(self.points) != len(other.points):
            return False
        return all(np.array_equal(own, theirs) for own, theirs in zip(self.polygons, other.polygons, strict=True))


class _Kept(NamedTuple):
    shape: MeshShape
    linear: FloatArray
    of_faces: bool
    surface: BrushSurface


# Of the latest mesh: strokes mostly go on where the last one was.
_kept_surface: _Kept | None = None
_kept_trees: list[tuple[MeshShape, BVHTree]] = []
_MOST_TREES = 2  # the mesh as it is seen, and the own one


def forget() -> None:
    """Lets go of all that is kept."""
    global _kept_surface
    _kept_surface = None
    _kept_trees.clear()


def shape_of(mesh: bpy.types.Mesh) -> MeshShape:
    """A copy of a mesh's shape."""
    sizes = buffers.read(mesh.polygons, "loop_total", np.int32)
    starts = buffers.read(mesh.polygons, "loop_start", np.int32).astype(np.int64)
    corners = buffers.read(mesh.loops, "vertex_index", np.int32)
    first = np.cumsum(sizes, dtype=np.int64) - sizes
    order = np.repeat(starts - first, sizes) + np.arange(int(sizes.sum()))
    return MeshShape(buffers.read(mesh.vertices, "co", np.float32, 3), Polygons(sizes, corners[order]))


def brush_surface(shape: MeshShape, linear: FloatArray, *, of_faces: bool) -> BrushSurface:
    """The mesh in the size it has in the scene: brushes are round there."""
    global _kept_surface
    kept = _kept_surface
    if (
        kept is None
        or kept.of_faces != of_faces
        or not np.array_equal(kept.linear, linear)
        or not kept.shape.equals(shape)
    ):
        surface = BrushSurface(shape.points.astype(np.float64) @ linear.T, shape.polygons, of_faces=of_faces)
        _kept_surface = kept = _Kept(shape, linear, of_faces, surface)
    return kept.surface


class PaintSurface:
    """The surface of an object, as a stroke finds it.

    Strokes act on the object's own mesh. Where modifiers and shape keys only move its vertices, the mouse is over the moved surface;
    where they make another mesh, what is under the mouse goes to the nearest place of the own one, if that is near.

    Parameters
    ----------
    obj : bpy.types.Object
        A mesh object with polygons.
    depsgraph : bpy.types.Depsgraph
    of_faces : bool
        Whether faces carry the values, not vertices.

    Attributes
    ----------
    brush : BrushSurface
        In world space without the object's translation.
    linear : (3, 3) float64
        From the object's space to that.
    """

    def __init__(self, obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, *, of_faces: bool = False) -> None:
        matrix = obj.matrix_world.copy()
        self._to_world, self._to_object = matrix, matrix.inverted_safe()
        self._translation = np.array(matrix.translation, np.float64)
        self.linear = np.array(matrix.to_3x3(), np.float64)
        self._mesh = obj.data
        self._own = shape_of(obj.data)
        self._ends = np.concatenate([[0], np.cumsum(self._own.polygons.sizes, dtype=np.int64)])
        self.brush = brush_surface(self._own, self.linear, of_faces=of_faces)
        if _shows_own_mesh(obj):
            self._seen, self._tree = self._own, _tree_of(self._own, obj.data)
        else:
            evaluated = obj.evaluated_get(depsgraph)
            try:
                mesh = evaluated.to_mesh()
                self._seen = shape_of(mesh)
                self._tree = _tree_of(self._seen, mesh)
            finally:
                evaluated.to_mesh_clear()
        self.moves_only = self._seen.has_polygons_of(self._own)

    def under(self, origin: Vector, direction: Vector) -> tuple[Vector, PenPlace | None] | None:
        """What a ray, given in world space, hits first: where that is seen, in world space, and the place on the own mesh.

        None where it hits nothing; no place where what is seen is not near the own mesh.
        """
        local = self._to_object @ origin
        towards = ((self._to_object @ (origin + direction)) - local).normalized()
        location, _normal, polygon, _distance = self._tree.ray_cast(local, towards)
        if location is None:
            return None
        seen = self._to_world @ location
        if self._seen is self._own:
            return seen, self._place(np.array(location, np.float64), polygon)
        if self.moves_only:
            return seen, self._place(self._moved_back(np.array(location, np.float64), polygon), polygon)
        nearest, _normal, polygon, _distance = _tree_of(self._own, self._mesh).find_nearest(location)
        if nearest is None:
            return seen, None
        place = self._place(np.array(nearest, np.float64), polygon)
        gap = float(np.linalg.norm(self.linear @ np.array(location - nearest)))
        return seen, place if gap <= self._size_of(polygon) else None

    def nearest(self, point: FloatArray) -> PenPlace | None:
        """The place on the own mesh nearest to a point in the brush's space; None where there is no mesh."""
        location, _normal, polygon, _distance = _tree_of(self._own, self._mesh).find_nearest(
            Vector(np.linalg.solve(self.linear, point))
        )
        return None if location is None else self._place(np.array(location, np.float64), polygon)

    def from_world(self, point: FloatArray) -> FloatArray:
        """A point of world space in the brush's space."""
        moved: FloatArray = point - self._translation
        return moved

    def to_object(self, points: FloatArray) -> FloatArray:
        """(k, 3) points of the brush's space in the object's."""
        local: FloatArray = np.linalg.solve(self.linear, points.T).T
        return local

    def mirrored(self, dabs: Dabs, axes: tuple[int, ...]) -> Dabs:
        """Dabs on the other side of the object's planes across some of its axes, put onto the surface there."""
        flip = np.eye(3)
        for axis in axes:
            flip[axis, axis] = -1
        across = self.linear @ flip @ np.linalg.inv(self.linear)
        places = [self.nearest(across @ position) for position in dabs.positions]
        found = np.array([place is not None for place in places], np.bool_)
        there = [place for place in places if place is not None]
        kept = dabs.among(found)
        tangents = kept.tangents @ across.T
        normals = np.array([place.normal for place in there], np.float64).reshape(-1, 3)
        tangents = tangents - np.einsum("ij,ij->i", tangents, normals)[:, None] * normals
        length = np.linalg.norm(tangents, axis=1, keepdims=True)
        return Dabs(
            np.array([place.position for place in there], np.float64).reshape(-1, 3),
            np.divide(tangents, length, out=np.zeros_like(tangents), where=length > 1e-6),
            np.array([place.polygon for place in there], np.int64),
            kept.strengths,
            kept.sizes,
        )

    def shown_points(self) -> FloatArray:
        """(n, 3) in the object's space: where the own mesh's vertices are seen, as far as they are."""
        points: FloatArray = (self._seen if self.moves_only else self._own).points
        return points

    def _place(self, location: FloatArray, polygon: int) -> PenPlace:
        return PenPlace(self.linear @ location, self.brush.polygon_normals[polygon], polygon)

    def _corners(self, polygon: int) -> Indices:
        begin, end = self._ends[polygon : polygon + 2]
        return self._own.polygons.vertices[begin:end].astype(np.int64)

    def _size_of(self, polygon: int) -> float:
        points = self.brush.vertices[self._corners(polygon)]
        return float(np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).max())

    def _moved_back(self, location: FloatArray, polygon: int) -> FloatArray:
        """A place on a polygon as it is seen, on the same polygon of the own mesh."""
        corners = self._corners(polygon)
        fan = np.array([(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)])
        seen = self._seen.points[fan].astype(np.float64)
        at = np.repeat(location[None], len(fan), axis=0)
        places = nearest_in_triangles(at, seen)
        best = int(((places - at) ** 2).sum(axis=1).argmin())
        weights = weights_in(places[best : best + 1], seen[best : best + 1])[0]
        moved: FloatArray = weights @ self._own.points[fan[best]].astype(np.float64)
        return moved


def _shows_own_mesh(obj: bpy.types.Object) -> bool:
    """Whether the viewport shows the object's own mesh, as Sculpt Mode leaves it without telling the depsgraph."""
    return not obj.data.shape_keys and not any(modifier.show_viewport for modifier in obj.modifiers)


def _tree_of(shape: MeshShape, mesh: bpy.types.Mesh) -> BVHTree:
    """To find places on a mesh of this shape."""
    for kept, tree in _kept_trees:
        if kept.equals(shape):
            return tree
    copy = bmesh.new()
    try:
        copy.from_mesh(mesh)
        tree = BVHTree.FromBMesh(copy)
    finally:
        copy.free()
    _kept_trees.append((shape, tree))
    del _kept_trees[:-_MOST_TREES]
    return tree
