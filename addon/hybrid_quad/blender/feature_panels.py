"""The panels that say which edges stay edges."""

from __future__ import annotations

import bpy

from .edge_marks import BORDERS, SHARP, SOURCES
from .panel_base import HybridQuadPanel, settings_layout


class VIEW3D_PT_hybrid_quad_features(HybridQuadPanel, bpy.types.Panel):
    """Which edges stay edges."""

    bl_label = "Edges to Keep"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"

    def draw(self, context: bpy.types.Context) -> None:
        layout = settings_layout(self)
        settings = context.object.hybrid_quad
        row = layout.row(heading="By Angle", align=True)
        row.prop(settings, "use_sharp_angle", text="")
        angle = row.row()
        angle.active = settings.use_sharp_angle
        angle.prop(settings, "sharp_angle", text="")
        layout.column(heading="Marked").prop(settings, "use_marked_sharp", text="Sharp")


class VIEW3D_PT_hybrid_quad_feature_sources(HybridQuadPanel, bpy.types.Panel):
    """Other marks, and borders, that make edges stay."""

    bl_label = "Features"
    bl_parent_id = "VIEW3D_PT_hybrid_quad_features"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = settings_layout(self)
        settings = context.object.hybrid_quad
        marks = layout.column(heading="Marked")
        borders = layout.column(heading="Borders of")
        for source in SOURCES:
            if source.mark != SHARP:
                column = borders if source.mark & BORDERS else marks
                column.prop(settings, source.setting, text=source.label)
