"""Adds what painting needs to Blender, and takes it away again."""

from __future__ import annotations

import contextlib

import bpy

from ..flow_panels import VIEW3D_PT_hybrid_quad_guides
from . import (
    brush_settings,
    density_operator,
    paint_operator,
    paint_panel,
    paint_surface,
    paint_tool,
    stroke_view,
)

CLASSES = (
    *brush_settings.CLASSES,
    *paint_operator.CLASSES,
    *density_operator.CLASSES,
)


def register() -> None:
    """After the classes, and the panel that the painting's is part of."""
    bpy.types.WorkSpace.hybrid_quad_brush = bpy.props.PointerProperty(
        type=brush_settings.HybridQuadBrushSettings,
        name="Hybrid Quad Brush",
        description="The brush that paints guides",
    )
    VIEW3D_PT_hybrid_quad_guides.prepend(paint_panel.draw_tool_button)
    paint_tool.register()
    stroke_view.register()


def unregister() -> None:
    """Before the classes; safe to call where nothing is registered."""
    stroke_view.unregister()
    paint_tool.unregister()
    VIEW3D_PT_hybrid_quad_guides.remove(paint_panel.draw_tool_button)
    paint_surface.forget()
    with contextlib.suppress(AttributeError):
        del bpy.types.WorkSpace.hybrid_quad_brush
