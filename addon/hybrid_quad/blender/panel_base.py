"""What the panels of the tab "Hybrid Quad" have in common."""

from __future__ import annotations

from typing import Any

import bpy


class HybridQuadPanel:
    """Where the add-on's panels are, and when they are there."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Hybrid Quad"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.object is not None and context.object.type == "MESH"


def settings_layout(panel: bpy.types.Panel) -> Any:
    """The panel's layout as Blender's own panels of settings have it: names left of the values, no dots for keyframes."""
    layout = panel.layout
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


def draw_figure(rows: Any, name: str, value: str) -> None:
    """A row with a name at the left and a value at the right."""
    row = rows.row()
    row.label(text=name)
    right = row.row()
    right.alignment = "RIGHT"
    right.label(text=value)
