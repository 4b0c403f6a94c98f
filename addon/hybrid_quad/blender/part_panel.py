"""The panel that says which part of a mesh is remeshed."""

from __future__ import annotations

import bpy

from .panel_base import HybridQuadPanel, draw_text, settings_layout
from .part_pick import OBJECT_OT_hybrid_quad_pick_face_set
from .part_source import knows_face_sets


class VIEW3D_PT_hybrid_quad_part(HybridQuadPanel, bpy.types.Panel):
    """Which faces are remeshed."""

    bl_label = "Region"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = settings_layout(self)
        settings = context.object.hybrid_quad.part
        column = layout.column()
        column.prop(settings, "region", text="Faces")
        if settings.region == "WHOLE":
            return
        if settings.region == "FACE_SET":
            row = column.row(align=True)
            row.prop(settings, "face_set", text="Number")
            row.operator(OBJECT_OT_hybrid_quad_pick_face_set.bl_idname, text="", icon="EYEDROPPER")
            if not knows_face_sets():
                draw_text(column, "Add-ons see face sets from Blender 3.5 on", "ERROR")
        elif settings.region == "ATTRIBUTE":
            column.prop_search(settings, "attribute", context.object.data, "attributes", text="Name")
        column.prop(settings, "use_inverted")
        column = layout.column()
        column.prop(settings, "use_border_length")
        column.prop(settings, "odd_border", text="If Odd")
