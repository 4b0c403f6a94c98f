"""Where the panels of the tab "Hybrid Quad" are, and when they are there."""

from __future__ import annotations

import bpy


class HybridQuadPanel:
    """Where the add-on's panels are, and when they are there."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Hybrid Quad"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.object is not None and context.object.type == "MESH"
