"""Settings under a name, by Blender's own preset system: a few that the add-on brings, and the user's own."""

from __future__ import annotations

from pathlib import Path

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from .properties import HybridQuadSettings

SUBDIR = "hybrid_quad"
SHIPPED = Path(__file__).with_name("shipped_presets")

# What belongs to one object, not to a kind of objects.
_OF_OBJECT = {
    "rna_type",
    "name",
    "guide_object",
    "guide_collection",
    "last_report",
    "last_check",
    "source_name",
    "part",
}


class OBJECT_OT_hybrid_quad_preset_add(AddPresetBase, bpy.types.Operator):
    """Keep the active object's settings under a name, or forget them"""

    bl_idname = "object.hybrid_quad_preset_add"
    bl_label = "Add Hybrid Quad Preset"
    preset_menu = "VIEW3D_PT_hybrid_quad_presets"
    preset_subdir = SUBDIR
    preset_defines = ["settings = bpy.context.object.hybrid_quad"]

    @property
    def preset_values(self) -> list[str]:
        """What a preset says of."""
        return [f"settings.{name}" for name in setting_names()]

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.object is None:
            cls.poll_message_set("Select an object first")
            return False
        return True


class VIEW3D_PT_hybrid_quad_presets(PresetPanel, bpy.types.Panel):
    """Presets that the add-on brings, and the user's own."""

    bl_label = "Hybrid Quad Presets"
    bl_space_type = "VIEW_3D"
    preset_subdir = SUBDIR
    preset_operator = "script.execute_preset"
    preset_add_operator = OBJECT_OT_hybrid_quad_preset_add.bl_idname

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.emboss = "PULLDOWN_MENU"
        layout.operator_context = "EXEC_DEFAULT"
        # Blender looks for presets in folders of its own only.
        for path in sorted(SHIPPED.glob("*.py")):
            operator = layout.operator(self.preset_operator, text=bpy.path.display_name(path.name, title_case=False))
            operator.filepath, operator.menu_idname = str(path), self.bl_idname
        layout.separator()
        super().draw(context)


def setting_names() -> list[str]:
    """Settings of an object that a preset keeps."""
    return [prop.identifier for prop in HybridQuadSettings.bl_rna.properties if prop.identifier not in _OF_OBJECT]


CLASSES = (OBJECT_OT_hybrid_quad_preset_add, VIEW3D_PT_hybrid_quad_presets)
