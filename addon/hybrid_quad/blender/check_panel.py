"""The panel that lists what is wrong with a mesh."""

from __future__ import annotations

import bpy

from .check_operators import (
    OBJECT_OT_hybrid_quad_check,
    OBJECT_OT_hybrid_quad_select_defect,
    describe_row,
    read_check,
)
from .panel_base import HybridQuadPanel, draw_text
from .repair_operators import OBJECT_OT_hybrid_quad_repair

_TEXT = 0.7  # share of the width; the rest is for the button


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
            line = column.split(factor=_TEXT)
            draw_text(line, describe_row(row), "INFO" if row["repairable"] else "ERROR", share=_TEXT)
            if row["elements"]:
                line.operator(OBJECT_OT_hybrid_quad_select_defect.bl_idname, text="Select").code = row["code"]
        if rows:
            layout.operator(OBJECT_OT_hybrid_quad_repair.bl_idname, icon="MODIFIER")
