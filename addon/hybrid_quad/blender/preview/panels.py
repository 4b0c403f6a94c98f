"""The panels "Preview" and "Subdivision Preview" of the sidebar."""

from __future__ import annotations

from typing import Any

import bpy

from ..panel_base import HybridQuadPanel, draw_figure, draw_text, settings_layout
from . import sessions
from .limit import OBJECT_OT_hybrid_quad_apply_subdivision
from .session import Session


class VIEW3D_PT_hybrid_quad_preview(HybridQuadPanel, bpy.types.Panel):
    """What remeshing would follow."""

    bl_label = "Preview"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, _context: bpy.types.Context) -> None:
        self.layout.prop(sessions.settings(), "show_field", text="")

    def draw(self, _context: bpy.types.Context) -> None:
        layout = settings_layout(self)
        asked = sessions.settings()
        layout.active = asked.show_field
        column = layout.column(heading="Show")
        column.prop(asked, "show_crosses")
        size = column.column()
        size.active = asked.show_crosses
        size.prop(asked, "show_sizes")
        for name in ("singularities", "features", "guides", "quads"):
            column.prop(asked, f"show_{name}")
        if not asked.show_field:
            return
        _draw_state(layout, sessions.field.session)
        found = sessions.field.session.result
        if found is None:
            return
        rows = layout.column(align=True)
        for quarters, count in sessions.field.counts():
            icon = "SPHERE" if quarters > 0 else "CUBE"
            rows.label(text=f"{count:,} where {4 - quarters} quads meet", icon=icon)
        if not len(found.singular_quarters):
            rows.label(text="No singularities", icon="CHECKMARK")
        rows.label(text=f"About {found.report['wanted_quads']:,.0f} quads")
        for warning in found.report["warnings"]:
            draw_text(rows, warning, "ERROR")


class VIEW3D_PT_hybrid_quad_limit(HybridQuadPanel, bpy.types.Panel):
    """The limit surface of a result."""

    bl_label = "Subdivision Preview"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, _context: bpy.types.Context) -> None:
        self.layout.prop(sessions.settings(), "show_limit", text="")

    def draw(self, context: bpy.types.Context) -> None:
        layout = settings_layout(self)
        asked = sessions.settings()
        column = layout.column()
        column.active = asked.show_limit
        column.prop_search(context.object.hybrid_quad, "source_name", bpy.data, "objects", text="Source")
        column.prop(asked, "limit_levels")
        if asked.show_limit:
            _draw_state(layout, sessions.limit.session)
            _draw_distance(layout)
        name = OBJECT_OT_hybrid_quad_apply_subdivision.bl_idname
        operator = layout.operator(name, text="Apply as Modifier", icon="MOD_SUBSURF")
        operator.levels = asked.limit_levels


def _draw_state(layout: Any, session: Session[Any]) -> None:
    if session.error:
        draw_text(layout, session.error, "ERROR")
    elif session.status == "Waiting" and bpy.context.mode.startswith("EDIT"):
        draw_text(layout, "Leave Edit Mode to see the change", "INFO")
    elif session.is_busy:
        layout.label(text=session.status, icon="SORTTIME")


def _draw_distance(layout: Any) -> None:
    distance = sessions.limit.distance
    if sessions.limit.session.result is None:
        return
    if distance is None:
        draw_text(layout, "Name the object that the quads were made of", "INFO")
        return
    rows = layout.column(align=True)
    for name, value in (
        ("Largest (red)", _length(distance.largest)),
        ("Of the diagonal", f"{distance.percent:.3f} %"),
        ("Mean", _length(distance.mean)),
    ):
        draw_figure(rows, name, value)


def _length(value: float) -> str:
    """A length of the scene in the units that it is shown in."""
    units = bpy.context.scene.unit_settings
    if units.system == "NONE":
        return f"{value:.4g}"
    return str(bpy.utils.units.to_string(units.system, "LENGTH", value * units.scale_length, precision=5))
