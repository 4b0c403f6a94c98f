"""What the panels of the tab "Hybrid Quad" have in common."""

from __future__ import annotations

import textwrap
from typing import Any

import bpy

# Of Blender's own font, at a scale of 1: a usual letter, and what stands beside a text in the sidebar.
_LETTER, _BESIDE, _ICON = 6.2, 45, 20
_SIDEBAR = 220  # as wide as Blender makes it
_FEWEST = 14  # letters a line, however narrow it is


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


def draw_text(layout: Any, text: str, icon: str = "NONE", share: float = 1.0) -> None:
    """A text in as many lines as it needs: labels are cut off.

    Parameters
    ----------
    share : float
        Of the sidebar's width, that the layout has.
    """
    column = layout.column(align=True)
    for index, line in enumerate(lines_of(text, icon, share)):
        column.label(text=line, icon=icon if index == 0 or icon == "NONE" else "BLANK1")


def lines_of(text: str, icon: str = "NONE", share: float = 1.0) -> list[str]:
    """A text as :func:`draw_text` breaks it."""
    region = bpy.context.region
    is_sidebar = region is not None and region.type == "UI"
    width = region.width / bpy.context.preferences.system.ui_scale if is_sidebar else _SIDEBAR
    letters = (share * (width - _BESIDE) - (0 if icon == "NONE" else _ICON)) / _LETTER
    return textwrap.wrap(text, max(_FEWEST, int(letters)))
