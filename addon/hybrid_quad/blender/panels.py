"""The tab "Hybrid Quad" of the 3D view's sidebar."""

from __future__ import annotations

from typing import Any

import bpy

from ..core import native
from . import background_run
from .check_operators import (
    OBJECT_OT_hybrid_quad_check,
    OBJECT_OT_hybrid_quad_select_defect,
    describe_row,
    read_check,
)
from .edge_marks import BORDERS, SHARP, SOURCES
from .guide_lines import LINE_TYPES
from .operators import OBJECT_OT_hybrid_quad_cancel, OBJECT_OT_hybrid_quad_remesh
from .presets import VIEW3D_PT_hybrid_quad_presets
from .properties import SIZE_SETTINGS
from .repair_operators import OBJECT_OT_hybrid_quad_repair
from .result_mesh import read_report
from .selected_objects import OBJECT_OT_hybrid_quad_remesh_selected
from .transfer.kinds import KINDS


class HybridQuadPanel:
    """Where the add-on's panels are, and when they are there."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Hybrid Quad"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.object is not None and context.object.type == "MESH"


class VIEW3D_PT_hybrid_quad(HybridQuadPanel, bpy.types.Panel):
    """Size of the quads, where they go, and the button."""

    bl_label = "Hybrid Quad"

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        return True  # with no mesh object, it says so

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        if super().poll(context):
            VIEW3D_PT_hybrid_quad_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        run = background_run.current()
        if run is not None:
            _draw_run(layout, context, run)
        if not super().poll(context):
            layout.label(text="Select a mesh object", icon="INFO")
            return
        if not native.is_there():
            layout.label(text="The compiled part is missing:", icon="ERROR")
            layout.label(text="install the zip for this Blender and system")
        settings = context.object.hybrid_quad
        column = layout.column()
        column.active = settings.part.region == "WHOLE" or not settings.part.use_border_length
        column.prop(settings, "target_mode")
        column.prop(settings, SIZE_SETTINGS[settings.target_mode])
        layout.prop(settings, "result_mode")
        button = layout.row()
        button.scale_y = 1.5
        button.operator(OBJECT_OT_hybrid_quad_remesh.bl_idname, icon="MOD_REMESH")
        if sum(obj.type == "MESH" for obj in context.selected_objects) > 1:
            layout.operator(OBJECT_OT_hybrid_quad_remesh_selected.bl_idname)


class VIEW3D_PT_hybrid_quad_features(HybridQuadPanel, bpy.types.Panel):
    """Which edges stay edges."""

    bl_label = "Edges to Keep"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
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
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.object.hybrid_quad
        marks = layout.column(heading="Marked")
        borders = layout.column(heading="Borders of")
        for source in SOURCES:
            if source.mark != SHARP:
                column = borders if source.mark & BORDERS else marks
                column.prop(settings, source.setting, text=source.label)


class VIEW3D_PT_hybrid_quad_guides(HybridQuadPanel, bpy.types.Panel):
    """What gives the quads their direction and density."""

    bl_label = "Guides"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
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
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.object.hybrid_quad
        column = layout.column()
        adaptivity = column.column()
        adaptivity.active = settings.target_mode != "CHORD"
        adaptivity.prop(settings, "adaptivity")
        column.prop(settings, "narrow_quads")
        column.prop(settings, "field_smoothness")
        column.prop(settings, "anisotropy")
        column.prop(settings, "fit_limit_surface")


class VIEW3D_PT_hybrid_quad_symmetry(HybridQuadPanel, bpy.types.Panel):
    """Mirror planes."""

    bl_label = "Symmetry"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.object.hybrid_quad
        row = layout.row(heading="Mirror", align=True)
        axes = row.row(align=True)
        axes.active = not settings.use_auto_symmetry
        for index, letter in enumerate("XYZ"):
            axes.prop(settings, "symmetry_axes", index=index, text=letter, toggle=True)
        row.prop(settings, "use_auto_symmetry", toggle=True)


class VIEW3D_PT_hybrid_quad_transfer(HybridQuadPanel, bpy.types.Panel):
    """What the result takes along."""

    bl_label = "Transfer"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.object.hybrid_quad
        columns: dict[str, Any] = {}
        for kind in KINDS:
            if kind.group not in columns:
                columns[kind.group] = layout.column(heading=kind.group)
            columns[kind.group].prop(settings.transfer, kind.setting)
        columns["Object"].active = settings.result_mode == "NEW"


class VIEW3D_PT_hybrid_quad_limits(HybridQuadPanel, bpy.types.Panel):
    """When a run is ended."""

    bl_label = "Limits"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column()
        column.prop(context.object.hybrid_quad, "time_limit")
        column.prop(context.object.hybrid_quad, "memory_limit")


class VIEW3D_PT_hybrid_quad_check(HybridQuadPanel, bpy.types.Panel):
    """What is wrong with the mesh."""

    bl_label = "Check"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator(OBJECT_OT_hybrid_quad_check.bl_idname, icon="VIEWZOOM")
        rows = read_check(context.object)
        if rows == []:
            layout.label(text="Nothing is wrong with it", icon="CHECKMARK")
        column = layout.column(align=True)
        for row in rows or ():
            line = column.split(factor=0.7)
            line.label(text=describe_row(row), icon="INFO" if row["repairable"] else "ERROR")
            if row["elements"]:
                name, icon = OBJECT_OT_hybrid_quad_select_defect.bl_idname, "RESTRICT_SELECT_OFF"
                line.operator(name, text="Select", icon=icon).code = row["code"]
        if rows:
            layout.operator(OBJECT_OT_hybrid_quad_repair.bl_idname, icon="MODIFIER")


class VIEW3D_PT_hybrid_quad_report(HybridQuadPanel, bpy.types.Panel):
    """What the latest run of the active object gave."""

    bl_label = "Last Result"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and bool(context.object.hybrid_quad.last_report)

    def draw(self, context: bpy.types.Context) -> None:
        report = read_report(context.object)
        if report is None:
            self.layout.label(text="No report that can be read", icon="ERROR")
            return
        rows = self.layout.column(align=True)
        for name, value in _rows_of(report):
            row = rows.row()
            row.label(text=name)
            right = row.row()
            right.alignment = "RIGHT"
            right.label(text=value)
        for defect in report.get("defects", ()):
            self.layout.label(
                text=f"Repaired: {defect['code'].replace('_', ' ')} ({len(defect['elements'])})", icon="INFO"
            )
        for warning in report.get("warnings", ()):
            self.layout.label(text=warning, icon="ERROR")


def _rows_of(report: dict[str, Any]) -> list[tuple[str, str]]:
    quality = report.get("scaled_jacobian", {})
    return [
        ("Quads", f"{report.get('quads', 0):,}"),
        ("Irregular vertices", f"{report.get('irregular_vertices', 0):,}"),
        ("Scaled Jacobian, mean", _number(quality.get("mean"))),
        ("Scaled Jacobian, worst", _number(quality.get("min"))),
        ("Largest distance", f"{_number(report.get('hausdorff_percent'))} %"),
        *_symmetry_rows(report.get("symmetry", {})),
        ("Time", f"{sum(stage.get('seconds', 0.0) for stage in report.get('stages', ())):.1f} s"),
    ]


def _symmetry_rows(symmetry: dict[str, Any]) -> list[tuple[str, str]]:
    """How far the object is from symmetric along each axis, and along which it was mirrored."""
    used = symmetry.get("planes", "")
    return [
        (f"Deviation {axis.upper()}{', mirrored' if axis in used else ''}", f"{_number(deviation.get('max'))} %")
        for axis, deviation in symmetry.get("deviation_percent", {}).items()
    ]


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def _draw_run(layout: Any, context: bpy.types.Context, run: background_run.BackgroundRun) -> None:
    """What the background run is about, how far it is, and the button that ends it."""
    box = layout.box().column()
    box.use_property_split = False
    box.label(text=run.source.name, icon="MOD_REMESH")
    box.label(text=run.status)
    if run.is_finished:
        box.operator(OBJECT_OT_hybrid_quad_cancel.bl_idname, text="Drop the Result", icon="X")
        return
    if hasattr(layout, "progress"):  # from Blender 4.0 on
        box.progress(factor=run.fraction, text=f"{100 * run.fraction:.0f} %")
    else:
        box.prop(context.window_manager, "hybrid_quad_progress", text="", slider=True)
    box.operator(OBJECT_OT_hybrid_quad_cancel.bl_idname, icon="X")


CLASSES = (
    VIEW3D_PT_hybrid_quad,
    VIEW3D_PT_hybrid_quad_features,
    VIEW3D_PT_hybrid_quad_feature_sources,
    VIEW3D_PT_hybrid_quad_guides,
    VIEW3D_PT_hybrid_quad_flow,
    VIEW3D_PT_hybrid_quad_symmetry,
    VIEW3D_PT_hybrid_quad_transfer,
    VIEW3D_PT_hybrid_quad_limits,
    VIEW3D_PT_hybrid_quad_check,
    VIEW3D_PT_hybrid_quad_report,
)
