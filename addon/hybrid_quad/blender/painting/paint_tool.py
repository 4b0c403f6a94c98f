"""The tool "Quad Guides" in the 3D view's toolbar, and its keys."""

from __future__ import annotations

from typing import Any

import bpy

from .paint_operator import HYBRID_QUAD_OT_paint_guide, problem_of
from .stroke_view import TOOL

_PAINT = HYBRID_QUAD_OT_paint_guide.bl_idname
_KEYMAP = (
    (_PAINT, {"type": "LEFTMOUSE", "value": "PRESS"}, {"properties": [("mode", "NORMAL")]}),
    (_PAINT, {"type": "LEFTMOUSE", "value": "PRESS", "ctrl": True}, {"properties": [("mode", "INVERT")]}),
    (_PAINT, {"type": "LEFTMOUSE", "value": "PRESS", "shift": True}, {"properties": [("mode", "SMOOTH")]}),
    (
        "wm.radial_control",
        {"type": "F", "value": "PRESS"},
        {"properties": [("data_path_primary", "workspace.hybrid_quad_brush.size")]},
    ),
    (
        "wm.radial_control",
        {"type": "F", "value": "PRESS", "shift": True},
        {"properties": [("data_path_primary", "workspace.hybrid_quad_brush.strength")]},
    ),
)


def draw_settings(context: bpy.types.Context, layout: Any, _tool: Any, *, extra: bool = False) -> None:
    """The tool's header."""
    del extra
    problem = problem_of(context)
    if problem:
        layout.label(text=problem, icon="INFO")
        return
    brush = context.workspace.hybrid_quad_brush
    layout.prop(brush, "kind", text="")
    row = layout.row(align=True)
    row.prop(brush, "size", slider=True)
    if brush.kind in ("DIRECTION", "DENSITY"):
        row.prop(brush, "use_pressure_size", text="", icon="STYLUS_PRESSURE")
        row = layout.row(align=True)
        row.prop(brush, "strength", slider=True)
        row.prop(brush, "use_pressure_strength", text="", icon="STYLUS_PRESSURE")
        layout.prop(brush, "falloff", text="")
    if brush.kind == "DENSITY":
        layout.prop(brush, "density_action", text="")
        row = layout.row()
        row.active = brush.density_action in ("DENSER", "COARSER")
        row.prop(brush, "density_factor")
    if context.mode == "OBJECT":  # Sculpt Mode's header has them
        row = layout.row(align=True)
        for axis in "xyz":
            row.prop(context.object.data, f"use_mirror_{axis}", text=axis.upper(), toggle=True)


class _PaintTool:
    bl_space_type = "VIEW_3D"
    bl_idname = TOOL
    bl_label = "Quad Guides"
    bl_description = (
        "Paint how quads should run: directions, edge loops, rings and density.\n"
        "Drag to paint, with Ctrl to erase or do the opposite, with Shift to smooth; F sets the radius, Shift F the strength"
    )
    bl_icon = "brush.particle.comb"
    bl_cursor = "PAINT_CROSS"
    bl_keymap = _KEYMAP
    draw_settings = staticmethod(draw_settings)


class ObjectPaintTool(_PaintTool, bpy.types.WorkSpaceTool):
    """In Object Mode."""

    bl_context_mode = "OBJECT"


class SculptPaintTool(_PaintTool, bpy.types.WorkSpaceTool):
    """In Sculpt Mode."""

    bl_context_mode = "SCULPT"


TOOLS = (ObjectPaintTool, SculptPaintTool)


def register() -> None:
    """Adds the tool to the toolbar of both modes."""
    for tool in TOOLS:
        bpy.utils.register_tool(tool, separator=True)


def unregister() -> None:
    """Takes it away again, where it is."""
    for tool in TOOLS:
        if hasattr(tool, "_bl_tool"):
            bpy.utils.unregister_tool(tool)
