"""Draws shapes over an object, in every 3D view."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import bpy
from mathutils import Matrix

from .shapes import Shape

# An object and what is drawn over it.
Drawing = tuple[bpy.types.Object, Iterable[Shape]]

_MOST_LIFT = 0.3  # beyond it what lies behind would come to the front

_handler: Any = None


def start(drawings: Callable[[], Iterable[Drawing]]) -> None:
    """Draws what `drawings` gives whenever a 3D view is drawn, until :func:`stop`."""
    global _handler
    stop()
    _handler = bpy.types.SpaceView3D.draw_handler_add(_draw_all, (drawings,), "WINDOW", "POST_VIEW")


def stop() -> None:
    """Draws nothing any more."""
    global _handler
    handler, _handler = _handler, None
    if handler is not None:
        bpy.types.SpaceView3D.draw_handler_remove(handler, "WINDOW")


def is_on() -> bool:
    """Whether 3D views are drawn over."""
    return _handler is not None


def redraw() -> None:
    """Has all 3D views drawn again."""
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                area.tag_redraw()


def _draw_all(drawings: Callable[[], Iterable[Drawing]]) -> None:
    context = bpy.context
    space = context.space_data
    if space is None or space.type != "VIEW_3D" or not space.overlay.show_overlays:
        return
    for obj, shapes in drawings():
        if obj.visible_in_viewport_get(space):
            for shape in shapes:
                _draw(context, obj, shape)


def _draw(context: bpy.types.Context, obj: bpy.types.Object, shape: Shape) -> None:
    import gpu  # not in background mode, where nothing is drawn

    if not len(shape.points):
        return
    shader = gpu.shader.from_builtin(_shader_name(shape.kind))
    if shape.batch is None:
        shape.batch = _batch_of(shader, shape)
    is_solid = shape.kind == "TRIS"
    former = gpu.state.depth_mask_get()
    gpu.state.depth_test_set("LESS_EQUAL")
    gpu.state.depth_mask_set(is_solid)
    gpu.state.blend_set("ALPHA")
    try:
        with gpu.matrix.push_pop():
            gpu.matrix.load_matrix(_nearer(context.region_data, obj, shape) @ obj.matrix_world)
            shader.bind()
            if not is_solid:
                shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
                shader.uniform_float("lineWidth", shape.width * context.preferences.system.ui_scale)
            shape.batch.draw(shader)
    finally:
        gpu.state.blend_set("NONE")
        gpu.state.depth_mask_set(former)
        gpu.state.depth_test_set("NONE")


def _nearer(view: bpy.types.RegionView3D, obj: bpy.types.Object, shape: Shape) -> Matrix:
    """The view's matrix, with everything a little nearer to the eye, at the same place of the picture."""
    gap = shape.gap * max(obj.matrix_world.to_scale())
    is_perspective = view.window_matrix[3][3] == 0
    if is_perspective:
        # About the eye: the picture stays, depths shrink.
        distance = max((view.view_matrix @ obj.matrix_world.translation).length, max(obj.dimensions))
        return Matrix.Scale(1.0 - min(shape.lift + gap / distance, _MOST_LIFT), 4) @ view.view_matrix
    return Matrix.Translation((0.0, 0.0, shape.lift * max(obj.dimensions) + gap)) @ view.view_matrix


def _shader_name(kind: str) -> str:
    name = "POLYLINE_FLAT_COLOR" if kind == "LINES" else "SMOOTH_COLOR"
    return name if bpy.app.version >= (4, 0, 0) else f"3D_{name}"


def _batch_of(shader: Any, shape: Shape) -> Any:
    from gpu_extras.batch import batch_for_shader

    return batch_for_shader(shader, shape.kind, {"pos": shape.points, "color": shape.colors}, indices=shape.indices)
