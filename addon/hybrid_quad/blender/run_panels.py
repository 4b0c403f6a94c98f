"""The panels that say what a result takes along, and when a run is ended."""

from __future__ import annotations

from typing import Any

import bpy

from .panel_base import HybridQuadPanel, settings_layout
from .transfer.kinds import KINDS

# What the sidebar shows whole, as wide as Blender makes it.
_SHORT = {
    "color_attributes": "Colors",
    "custom_normals": "Normals",
    "bevel_weights": "Bevel Weight",
    "freestyle_marks": "Freestyle",
    "vertex_groups": "Vertex Group",
    "custom_properties": "Properties",
}


class VIEW3D_PT_hybrid_quad_transfer(HybridQuadPanel, bpy.types.Panel):
    """What the result takes along."""

    bl_label = "Transfer"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = settings_layout(self)
        settings = context.object.hybrid_quad
        columns: dict[str, Any] = {}
        for kind in KINDS:
            if kind.group not in columns:
                columns[kind.group] = layout.column(heading=kind.group)
            columns[kind.group].prop(settings.transfer, kind.setting, text=_SHORT.get(kind.name, kind.label))
        columns["Object"].active = settings.result_mode == "NEW"


class VIEW3D_PT_hybrid_quad_limits(HybridQuadPanel, bpy.types.Panel):
    """When a run is ended."""

    bl_label = "Limits"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = settings_layout(self)
        column = layout.column()
        column.prop(context.object.hybrid_quad, "time_limit")
        column.prop(context.object.hybrid_quad, "memory_limit", text="Memory")
