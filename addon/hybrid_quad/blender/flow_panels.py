"""The panels that say how quads run: guides, adaptation to the surface, symmetry."""

from __future__ import annotations

import bpy

from .guide_lines import LINE_TYPES
from .panel_base import HybridQuadPanel, settings_layout


class VIEW3D_PT_hybrid_quad_guides(HybridQuadPanel, bpy.types.Panel):
    """What gives the quads their direction and density."""

    bl_label = "Guides"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = settings_layout(self)
        settings = context.object.hybrid_quad
        column = layout.column(heading="Painted")
        column.prop(settings, "use_guide_attribute", text="Direction")
        column.prop(settings, "use_density_attribute", text="Density")
        column.prop(settings, "use_painted_lines", text="Lines")
        column = layout.column()
        column.prop(settings, "guide_object", text="Object")
        if settings.guide_object and settings.guide_object.type not in LINE_TYPES:
            column.label(text="This object has no lines", icon="ERROR")
        column.prop(settings, "guide_collection", text="Collection")
        strength = column.column()
        strength.active = bool(settings.guide_object or settings.guide_collection)
        strength.prop(settings, "guide_objects_kind", text="Kind")
        strength.prop(settings, "guide_objects_strength", text="Strength")
        column = layout.column()
        column.prop(settings, "use_guide_annotations")
        strength = column.column()
        strength.active = settings.use_guide_annotations
        strength.prop(settings, "guide_annotations_kind", text="Kind")
        strength.prop(settings, "guide_annotations_strength", text="Strength")
        column = layout.column()
        column.prop(settings, "guide_marks", text="Edges")
        strength = column.column()
        strength.active = bool(settings.guide_marks)
        strength.prop(settings, "guide_marks_strength", text="Strength")
        layout.prop(settings, "guide_radius")


class VIEW3D_PT_hybrid_quad_flow(HybridQuadPanel, bpy.types.Panel):
    """How quads adapt to the surface."""

    bl_label = "Flow"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"

    def draw(self, context: bpy.types.Context) -> None:
        layout = settings_layout(self)
        settings = context.object.hybrid_quad
        column = layout.column()
        adaptivity = column.column()
        adaptivity.active = settings.target_mode != "CHORD"
        adaptivity.prop(settings, "adaptivity")
        column.prop(settings, "field_smoothness", text="Smooth")


class VIEW3D_PT_hybrid_quad_flow_advanced(HybridQuadPanel, bpy.types.Panel):
    """What few models need."""

    bl_label = "Advanced"
    bl_parent_id = "VIEW3D_PT_hybrid_quad_flow"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = settings_layout(self)
        settings = context.object.hybrid_quad
        column = layout.column()
        column.prop(settings, "anisotropy")
        column.prop(settings, "narrow_quads", text="Narrow")
        column.prop(settings, "fit_limit_surface", text="Fit Limit")


class VIEW3D_PT_hybrid_quad_symmetry(HybridQuadPanel, bpy.types.Panel):
    """Mirror planes."""

    bl_label = "Symmetry"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"

    def draw(self, context: bpy.types.Context) -> None:
        layout = settings_layout(self)
        settings = context.object.hybrid_quad
        axes = layout.row(heading="Mirror", align=True)
        axes.active = not settings.use_auto_symmetry
        for index, letter in enumerate("XYZ"):
            axes.prop(settings, "symmetry_axes", index=index, text=letter, toggle=True)
        layout.prop(settings, "use_auto_symmetry")
