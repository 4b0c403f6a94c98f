"""What is painted, and the brush, drawn over the 3D view while the tool is active."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import bpy
import gpu
import numpy as np
from gpu_extras.batch import batch_for_shader
from mathutils import Matrix

from ...core.mesh_arrays import FloatArray
from ...core.painting.brush_surface import BrushSurface
from ...core.surface_points import fan_triangles
from . import paint_surface, stored_values
from .paint_stroke import PaintStroke
from .painted_lines import PaintedLines

TOOL = "hybrid_quad.paint"

_DIRECTION = np.array([0.05, 0.95, 0.4, 1.0])
_LINES = {"LOOP": (1.0, 0.65, 0.05, 1.0), "RING": (0.25, 0.75, 1.0, 1.0)}
_DENSER, _COARSER = np.array([0.95, 0.45, 0.05]), np.array([0.1, 0.45, 0.95])
_RIM = {"NORMAL": (1.0, 1.0, 1.0, 0.8), "SMOOTH": (0.6, 0.8, 1.0, 0.9), "INVERT": (1.0, 0.55, 0.5, 0.9)}
_CELLS = 90  # about as many directions along the longest side of a mesh at most
_LIFT = 0.004  # what is drawn is so much nearer to the viewer than the surface: of the distance, or of the mesh's size
_CORNERS_OF_CIRCLE = 64

_stroke: PaintStroke | None = None
_handles: list[Callable[[], object]] = []  # how to take each away; the pointer's last


class _Batch(NamedTuple):
    owner: int
    kind: str
    linear: FloatArray
    surface: BrushSurface
    values: FloatArray
    points: Any
    batch: Any


_latest: _Batch | None = None
_is_current = False  # whether nothing can have changed since `_latest` was made


def show(stroke: PaintStroke | None) -> None:
    """From now on shows a stroke under way, or none."""
    global _stroke
    _stroke = stroke


def forget() -> None:
    """Lets go of all that is kept."""
    global _stroke, _latest, _is_current
    _stroke = _latest = None
    _is_current = False


def is_tool_active(context: bpy.types.Context) -> bool:
    """Whether ours is the active tool of the window's mode."""
    tool = context.workspace.tools.from_space_view3d_mode(context.mode, create=False)
    return tool is not None and tool.idname == TOOL


def draw_painted() -> None:
    """Handler of the 3D view: directions, densities or lines on the active object, and the line being drawn."""
    context = bpy.context
    obj = context.object
    if obj is None or obj.type != "MESH" or not is_tool_active(context) or not context.space_data.overlay.show_overlays:
        return
    if not obj.visible_get() or not len(obj.data.polygons):
        return
    kind = context.workspace.hybrid_quad_brush.kind
    with _blended(), gpu.matrix.push_pop():
        gpu.matrix.multiply_matrix(_towards_viewer(context.region_data, max(obj.dimensions)) @ obj.matrix_world)
        if kind in ("DIRECTION", "DENSITY"):
            _draw_values(obj, kind)
        else:
            _draw_lines(obj)


def draw_cursor(place: tuple[int, int]) -> None:
    """Handler of the mouse pointer: the brush's circle."""
    context = bpy.context
    if context.region is None or context.region.type != "WINDOW" or not is_tool_active(context):
        return
    radius = context.workspace.hybrid_quad_brush.size
    angle = np.linspace(0, 2 * np.pi, _CORNERS_OF_CIRCLE + 1)
    rim = np.stack([place[0] + radius * np.cos(angle), place[1] + radius * np.sin(angle), 0 * angle], axis=1)
    shader = _shader("POLYLINE_UNIFORM_COLOR")
    batch = batch_for_shader(shader, "LINE_STRIP", {"pos": rim.astype(np.float32)})
    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", 1.5)
    shader.uniform_float("color", _RIM["NORMAL" if _stroke is None else _stroke.settings.mode])
    gpu.state.blend_set("ALPHA")
    batch.draw(shader)
    gpu.state.blend_set("NONE")


class _blended:
    """Drawing onto the view's depth, nothing behind the surface."""

    def __enter__(self) -> None:
        gpu.state.blend_set("ALPHA")
        gpu.state.depth_test_set("LESS_EQUAL")
        gpu.state.depth_mask_set(False)

    def __exit__(self, *_: object) -> None:
        gpu.state.depth_mask_set(True)
        gpu.state.depth_test_set("NONE")
        gpu.state.blend_set("NONE")


def _towards_viewer(view: bpy.types.RegionView3D, size: float) -> Matrix:
    """Moves what is drawn out of the surface without moving it on the screen."""
    to_world = view.view_matrix.inverted()
    if not view.is_perspective:
        return Matrix.Translation(to_world.col[2].xyz.normalized() * _LIFT * size)
    eye = to_world.translation
    return Matrix.Translation(eye) @ Matrix.Scale(1 - _LIFT, 4) @ Matrix.Translation(-eye)


def _shader(name: str) -> Any:
    # Before Blender 4.0 the names said how many dimensions there are.
    return gpu.shader.from_builtin(name if bpy.app.version >= (4, 0, 0) else f"3D_{name}")


def _draw_values(obj: bpy.types.Object, kind: str) -> None:
    kept = _batch_of(obj, kind)
    if kept is None or kept.batch is None:
        return
    shader = _shader("POLYLINE_SMOOTH_COLOR" if kind == "DIRECTION" else "SMOOTH_COLOR")
    shader.bind()
    if kind == "DIRECTION":
        shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
        shader.uniform_float("lineWidth", 2.2 * bpy.context.preferences.system.pixel_size)
    kept.batch.draw(shader)


def _batch_of(obj: bpy.types.Object, kind: str) -> _Batch | None:
    """What is drawn for an object's values, made anew where they, or their places, are others."""
    global _latest, _is_current
    linear = np.array(obj.matrix_world.to_3x3(), np.float64)
    kept = _latest
    if kept is not None and (
        kept.owner != obj.as_pointer() or kept.kind != kind or not np.array_equal(kept.linear, linear)
    ):
        kept = None
    if kept is not None and _is_current and _stroke is None:
        return kept
    found = _values_of(obj, kind)
    if found is None:
        return None
    surface, values, points = found
    if (
        kept is None
        or kept.surface is not surface
        or kept.points is not points
        or not np.array_equal(kept.values, values)
    ):
        make = _direction_batch if kind == "DIRECTION" else _density_batch
        batch = make(surface, values, points, linear)
        _latest = kept = _Batch(obj.as_pointer(), kind, linear, surface, values.copy(), points, batch)
    _is_current = _stroke is None
    return kept


def _values_of(obj: bpy.types.Object, kind: str) -> tuple[BrushSurface, FloatArray, Any] | None:
    """The surface, its values, and where its vertices are seen in the object's space; None where nothing is painted."""
    if _stroke is not None and _stroke.obj == obj and _stroke.values is not None and _stroke.settings.kind == kind:
        return _stroke.values.surface, _stroke.values.values, _stroke.surface.shown_points()
    linear = np.array(obj.matrix_world.to_3x3(), np.float64)
    try:
        if not stored_values.is_there(obj.data, kind):
            return None
        of_faces = stored_values.are_of_faces(obj.data, kind)
        values = stored_values.read(obj.data, kind, linear)
    except stored_values.WrongAttributeError:
        return None
    shape = paint_surface.shape_of(obj.data)
    surface = paint_surface.brush_surface(shape, linear, of_faces=of_faces)
    if len(values) != len(surface.positions):  # the mesh is being changed
        return None
    points = _latest.points if _latest is not None and _latest.surface is surface else shape.points
    return surface, values, points


def _direction_batch(surface: BrushSurface, values: FloatArray, points: Any, linear: FloatArray) -> Any:
    strength = np.linalg.norm(values, axis=1)
    size = _size_of(surface)
    cell = max(size / _CELLS, 1.3 * surface.spacing, 1e-12)
    painted = np.flatnonzero(strength > 0.02)
    if not len(painted):
        return None
    # Of each cell one, always the same.
    _, first = np.unique(np.floor(surface.positions[painted] / cell), axis=0, return_index=True)
    chosen = painted[first]
    inverse = np.linalg.inv(linear)
    places = surface.positions[chosen] @ inverse.T if surface.of_faces else points[chosen].astype(np.float64)
    along = 0.45 * cell * (values[chosen] / strength[chosen, None]) @ inverse.T
    ends = np.stack([places - along, places + along], axis=1).reshape(-1, 3)
    colors = np.tile(_DIRECTION, (len(chosen), 1))
    colors[:, 3] *= 0.25 + 0.75 * strength[chosen]
    content = {"pos": ends.astype(np.float32), "color": np.repeat(colors, 2, axis=0).astype(np.float32)}
    return batch_for_shader(_shader("POLYLINE_SMOOTH_COLOR"), "LINES", content)


def _density_batch(surface: BrushSurface, values: FloatArray, points: Any, _linear: FloatArray) -> Any:
    triangles = fan_triangles(surface.polygons)
    shown = triangles[(np.abs(values) > 1e-3)[triangles].any(axis=1)]
    if not len(shown):
        return None
    amount = np.clip(np.abs(values) / np.log(4), 0, 1)
    colors = np.empty((len(values), 4))
    colors[:, :3] = np.where((values > 0)[:, None], _DENSER, _COARSER)
    colors[:, 3] = 0.75 * np.sqrt(amount)
    content = {"pos": np.ascontiguousarray(points, np.float32), "color": colors.astype(np.float32)}
    return batch_for_shader(_shader("SMOOTH_COLOR"), "TRIS", content, indices=np.ascontiguousarray(shown, np.int32))


def _draw_lines(obj: bpy.types.Object) -> None:
    """Loops and rings, and the line that is being drawn."""
    for kind, color in _LINES.items():
        lines = [
            np.concatenate([line.points, line.points[:1]]) if line.is_closed else line.points
            for line in PaintedLines(obj, kind).read()
        ]
        if _stroke is not None and _stroke.obj == obj and _stroke.settings[:2] == (kind, "NORMAL") and _stroke.way:
            lines.append(_stroke.surface.to_object(np.array(_stroke.way)))
        pieces = [np.stack([line[:-1], line[1:]], axis=1).reshape(-1, 3) for line in lines if len(line) > 1]
        if not pieces:
            continue
        shader = _shader("POLYLINE_UNIFORM_COLOR")
        # Point after point: Blender takes the memory as it lies, and that of a stroke lies coordinate after coordinate.
        batch = batch_for_shader(shader, "LINES", {"pos": np.ascontiguousarray(np.concatenate(pieces), np.float32)})
        shader.bind()
        shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
        shader.uniform_float("lineWidth", 3.0 * bpy.context.preferences.system.pixel_size)
        shader.uniform_float("color", color)
        batch.draw(shader)


def _size_of(surface: BrushSurface) -> float:
    return float(np.ptp(surface.vertices, axis=0).max())


def register() -> None:
    """Adds the handlers."""
    unregister()
    handle = bpy.types.SpaceView3D.draw_handler_add(draw_painted, (), "WINDOW", "POST_VIEW")
    _handles.append(lambda: bpy.types.SpaceView3D.draw_handler_remove(handle, "WINDOW"))
    _add_cursor()
    for handlers, function in _app_handlers():
        handlers.append(function)


def unregister() -> None:
    """Takes them away again, where there are any."""
    while _handles:
        _handles.pop()()
    for handlers, function in _app_handlers():
        while function in handlers:
            handlers.remove(function)
    forget()


def _app_handlers() -> list[tuple[Any, Callable[..., None]]]:
    handlers = bpy.app.handlers
    return [
        (handlers.load_post, _on_load),
        (handlers.depsgraph_update_post, _on_change),
        (handlers.undo_post, _on_change),
        (handlers.redo_post, _on_change),
    ]


def _add_cursor() -> None:
    cursor = bpy.types.WindowManager.draw_cursor_add(draw_cursor, (), "VIEW_3D", "WINDOW")
    _handles.append(lambda: bpy.types.WindowManager.draw_cursor_remove(cursor))


@bpy.app.handlers.persistent
def _on_load(*_: object) -> None:
    """Windows that come with a file know nothing of what is drawn at the mouse pointer."""
    forget()
    _handles.pop()()
    _add_cursor()


@bpy.app.handlers.persistent
def _on_change(*_: object) -> None:
    global _is_current
    _is_current = False
