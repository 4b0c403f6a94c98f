"""The limit surface of a result: what a worker is asked, the shapes that its answer becomes, and the modifier that shows it."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np
import numpy.typing as npt

from ...core.errors import InputError
from ...core.mesh_arrays import FloatArray, IntArray, Polygons
from ...worker.limit_request import LimitRequest, LimitSurface
from .. import edge_marks, result_features
from ..operators import ActiveMeshOperator
from .session import Session
from .shapes import Floats, Shape, ramp

_LIFT = 0.003
_GAPS = 1.2  # it counts as nearer by so many times what it is from the control mesh, which would hide it
# Near, middle, far, with middles that are light enough to be told apart without red.
_DISTANCES = ((0.13, 0.31, 0.75), (0.55, 0.75, 0.95), (0.95, 0.95, 0.9), (0.98, 0.65, 0.35), (0.75, 0.1, 0.1))
_SHADE = 0.35  # how much darker it is where it faces away from the light
_LIGHT = np.array([0.4, -0.5, 0.77])
_PLAIN = (0.75, 0.75, 0.75, 1.0)
_FULL = 1.0  # Blender's crease that never wears off


class Distance(NamedTuple):
    """From the limit surface to the object that the quads were made of, in scene units."""

    largest: float
    mean: float
    percent: float  # the largest, of the diagonal of that object's bounding box


class LimitPreview:
    """What is drawn after a run.

    Attributes
    ----------
    session : Session
    distance : Distance or None
        None where there is nothing to measure it to.
    """

    def __init__(self) -> None:
        self.session: Session[LimitSurface] = Session(self._ask, self._signature, self._take)
        self.distance: Distance | None = None
        self._matrix: FloatArray = np.eye(4)
        self._diagonal = 0.0
        self._shapes: list[Shape] = []

    def shapes(self, _settings: Any) -> list[Shape]:
        """The surface, if there is one."""
        return self._shapes if self.session.result is not None else []

    def _ask(self, obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> list[LimitRequest]:
        self._matrix = np.array(obj.matrix_world, np.float64)
        mesh = obj.data
        if not mesh.polygons:
            raise InputError("no_faces", f'"{obj.name}" has no faces')
        source = bpy.data.objects.get(obj.hybrid_quad.source_name)
        surface = (
            _surface_of(source, depsgraph) if source is not None and source != obj else (np.zeros((0, 3)), _NO_FACES)
        )
        self._diagonal = float(np.linalg.norm(np.ptp(surface[0], axis=0))) if len(surface[0]) else 0.0
        creases, corners = result_features.creases_of(mesh)
        levels = bpy.context.window_manager.hybrid_quad_preview.limit_levels
        points = _in_world(_points_of(mesh), self._matrix)
        return [LimitRequest(points, _polygons_of(mesh), *creases, *corners, *surface, levels=levels)]

    def _signature(self, obj: bpy.types.Object) -> Any:
        levels = bpy.context.window_manager.hybrid_quad_preview.limit_levels
        return obj.hybrid_quad.source_name, levels, tuple(value for row in obj.matrix_world for value in row)

    def _take(self, obj: bpy.types.Object, found: LimitSurface) -> None:
        self.distance = None
        colors = np.tile(np.array(_PLAIN, np.float32), (len(found.vertices), 1))
        if len(found.distances):
            largest = float(found.distances.max())
            percent = 100.0 * largest / self._diagonal if self._diagonal else 0.0
            self.distance = Distance(largest, float(found.distances.mean()), percent)
            colors = ramp(found.distances / largest if largest else found.distances, _DISTANCES)
        self._shapes = [_surface_shape(found, colors, np.linalg.inv(self._matrix), _points_of(obj.data))]


class OBJECT_OT_hybrid_quad_apply_subdivision(ActiveMeshOperator):
    """Give the active object a Subdivision Surface modifier, and creases on its features"""

    bl_idname = "object.hybrid_quad_apply_subdivision"
    bl_label = "Apply as Subdivision Surface"
    bl_options = {"REGISTER", "UNDO"}

    levels: bpy.props.IntProperty(
        name="Levels", description="Subdivisions in the viewport and in renders", default=2, min=1, max=6
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not super().poll(context):
            return False
        if context.object.data.library is not None:
            cls.poll_message_set("The mesh is linked from another file; make it local first")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.object
        edges, corners = result_features.features_of(obj.data)
        edge_marks.crease(obj.data, edges, corners)
        obj.data.update()
        modifier = next((each for each in obj.modifiers if each.type == "SUBSURF"), None)
        modifier = modifier or obj.modifiers.new("Subdivision", "SUBSURF")
        modifier.levels = modifier.render_levels = self.levels
        modifier.subdivision_type = "CATMULL_CLARK"
        modifier.use_creases = modifier.use_limit_surface = True
        modifier.boundary_smooth = "ALL"
        self.report({"INFO"}, f"{len(edges)} edges and {len(corners)} corners are creases")
        return {"FINISHED"}


def _surface_of(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> tuple[FloatArray, Polygons]:
    """An object's surface in world space, with its modifiers."""
    evaluated = obj.evaluated_get(depsgraph)
    matrix = np.array(obj.matrix_world, np.float64)
    if evaluated.is_evaluated:
        mesh = evaluated.to_mesh()
        try:
            return _in_world(_points_of(mesh), matrix), _polygons_of(mesh)
        finally:
            evaluated.to_mesh_clear()
    if any(modifier.show_viewport for modifier in obj.modifiers):
        raise InputError("not_evaluated", f'"{obj.name}" is hidden, so that its modifiers are unknown: show it')
    return _in_world(_points_of(obj.data), matrix), _polygons_of(obj.data)


def _surface_shape(found: LimitSurface, colors: Floats, from_world: FloatArray, control: FloatArray) -> Shape:
    """The surface in object space. `control`: vertices of the control mesh, to which the first of the surface belong."""
    light = _LIGHT / np.linalg.norm(_LIGHT)
    shade = (1.0 - _SHADE * (0.5 - 0.5 * (found.normals @ light))).astype(np.float32)
    shaded = colors.copy()
    shaded[:, :3] *= shade[:, None]
    triangles = np.concatenate([found.quads[:, [0, 1, 2]], found.quads[:, [0, 2, 3]]])
    points = _in_world(found.vertices, from_world).astype(np.float32)
    count = min(len(control), len(points))
    gap = _GAPS * float(np.linalg.norm(points[:count] - control[:count], axis=1).max())
    return Shape("TRIS", points, shaded, np.ascontiguousarray(triangles, np.int32), lift=_LIFT, gap=gap)


def _in_world(points: FloatArray, matrix: FloatArray) -> FloatArray:
    moved: FloatArray = points @ matrix[:3, :3].T + matrix[:3, 3]
    return moved


def _points_of(mesh: bpy.types.Mesh) -> FloatArray:
    return _read(mesh.vertices, "co", np.float32, 3).reshape(-1, 3).astype(np.float64)


def _polygons_of(mesh: bpy.types.Mesh) -> Polygons:
    starts, sizes = _read(mesh.polygons, "loop_start", np.int32), _read(mesh.polygons, "loop_total", np.int32)
    corners = _read(mesh.loops, "vertex_index", np.int32)
    if np.array_equal(starts, np.cumsum(sizes) - sizes):
        return Polygons(sizes, corners)
    return Polygons(sizes, np.concatenate([corners[a : a + n] for a, n in zip(starts, sizes, strict=True)]))


def _read(collection: Any, name: str, dtype: type, width: int = 1) -> npt.NDArray[Any]:
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(name, values)
    return values


_NO_INTS: IntArray = np.zeros(0, np.int32)
_NO_FACES = Polygons(_NO_INTS, _NO_INTS)

CLASSES = (OBJECT_OT_hybrid_quad_apply_subdivision,)
