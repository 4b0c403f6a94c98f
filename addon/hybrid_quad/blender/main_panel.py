"""The panel that all others are in: size of the quads, the button, and the run that goes on."""

from __future__ import annotations

from typing import Any

import bpy

from ..core import native
from . import background_run
from .copy_settings import OBJECT_OT_hybrid_quad_copy_settings
from .operators import OBJECT_OT_hybrid_quad_cancel, OBJECT_OT_hybrid_quad_remesh
from .panel_base import HybridQuadPanel, draw_text, settings_layout
from .presets import VIEW3D_PT_hybrid_quad_presets
from .properties import SIZE_SETTINGS
from .selected_objects import OBJECT_OT_hybrid_quad_remesh_selected

# What fits left of a value in a sidebar that is as wide as Blender makes it.
_SHORT = {"edge_length": "Length", "chord_error": "Error"}


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
        layout = settings_layout(self)
        run = background_run.current()
        if run is not None:
            _draw_run(layout, context, run)
        if not super().poll(context):
            layout.label(text="Select a mesh object", icon="INFO")
            return
        if not native.is_there():
            draw_text(layout, "The compiled part is missing: install the zip for this Blender and system", "ERROR")
        settings = context.object.hybrid_quad
        column = layout.column()
        column.active = settings.part.region == "WHOLE" or not settings.part.use_border_length
        column.prop(settings, "target_mode")
        size = SIZE_SETTINGS[settings.target_mode]
        column.prop(settings, size, text=_SHORT.get(size, settings.bl_rna.properties[size].name))
        layout.prop(settings, "result_mode")
        button = layout.row()
        button.scale_y = 1.5
        button.operator(OBJECT_OT_hybrid_quad_remesh.bl_idname, icon="MOD_REMESH")
        if sum(obj.type == "MESH" for obj in context.selected_objects) > 1:
            column = layout.column(align=True)
            column.operator(OBJECT_OT_hybrid_quad_remesh_selected.bl_idname)
            column.operator(OBJECT_OT_hybrid_quad_copy_settings.bl_idname)


def _draw_run(layout: Any, context: bpy.types.Context, run: background_run.BackgroundRun) -> None:
    """What the background run is about, how far it is, and the button that ends it."""
    box = layout.box().column()
    box.use_property_split = False
    box.label(text=run.source.name, icon="MOD_REMESH")
    box.label(text=run.status)
    if run.silence:
        box.label(text=run.silence, icon="TIME")
    if run.is_finished:
        box.operator(OBJECT_OT_hybrid_quad_cancel.bl_idname, text="Drop the Result", icon="X")
        return
    if hasattr(layout, "progress"):  # from Blender 4.0 on
        box.progress(factor=run.fraction, text=f"{100 * run.fraction:.0f} %")
    else:
        box.prop(context.window_manager, "hybrid_quad_progress", text="", slider=True)
    box.operator(OBJECT_OT_hybrid_quad_cancel.bl_idname, icon="X")
