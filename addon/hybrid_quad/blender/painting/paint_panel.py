"""Painting in the sidebar: what is painted, where it may come from, and how to get rid of it."""

from __future__ import annotations

from typing import Any

import bpy

from ..panel_base import HybridQuadPanel, draw_text
from . import stored_values
from .brush_settings import KINDS
from .density_operator import HYBRID_QUAD_OT_clear_painted, HYBRID_QUAD_OT_density_from_layer
from .painted_lines import PaintedLines
from .stroke_view import TOOL, is_tool_active


class VIEW3D_PT_hybrid_quad_painting(HybridQuadPanel, bpy.types.Panel):
    """Painted guides of the active object."""

    bl_label = "Painting"
    bl_parent_id = "VIEW3D_PT_hybrid_quad_guides"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        obj = context.object
        column = layout.column(align=True)
        for identifier, name, _description, icon, _number in KINDS:
            row = column.row()
            row.label(text=f"{name}: {_state_of(obj, identifier)}", icon=icon)
            clear: Any = row.operator(HYBRID_QUAD_OT_clear_painted.bl_idname, text="", icon="X")
            clear.kind = identifier
        layout.label(text="Density from")
        row = layout.row(align=True)
        for source, name, is_there in (
            ("VERTEX_GROUP", "Vertex Group", bool(obj.vertex_groups)),
            ("COLOR", "Color", bool(obj.data.color_attributes)),
        ):
            part = row.row(align=True)
            part.active = is_there  # not disabled: pressed, it says what is missing
            part.operator(HYBRID_QUAD_OT_density_from_layer.bl_idname, text=name).source = source


def draw_tool_button(self: Any, context: bpy.types.Context) -> None:
    """Top of the panel of guides."""
    if context.mode not in ("OBJECT", "SCULPT"):
        draw_text(self.layout, "Guides are painted in Object Mode and Sculpt Mode", "INFO")
        return
    depress = is_tool_active(context)
    self.layout.operator("wm.tool_set_by_id", text="Paint Guides", icon="BRUSH_DATA", depress=depress).name = TOOL


def _state_of(obj: bpy.types.Object, kind: str) -> str:
    if kind in ("LOOP", "RING"):
        count = len(PaintedLines(obj, kind).read())
        return f"{count} lines" if count != 1 else "1 line"
    try:
        return "painted" if stored_values.is_there(obj.data, kind) else "none"
    except stored_values.WrongAttributeError:
        return "another attribute has its name"
