"""The operator ``object.hybrid_quad_copy_settings``: one object's settings for all that are selected."""

from __future__ import annotations

from collections.abc import Iterable

import bpy

from .presets import setting_names
from .properties import HybridQuadSettings, HybridQuadTransferSettings


class OBJECT_OT_hybrid_quad_copy_settings(bpy.types.Operator):
    """Give the other selected mesh objects the active object's settings. Regions, guide objects and what is painted stay their own"""

    bl_idname = "object.hybrid_quad_copy_settings"
    bl_label = "Copy Settings to Selected"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = ""
        if context.object is None or context.object.type != "MESH":
            problem = "Select a mesh object first"
        elif not _others(context):
            problem = "Select other mesh objects too, this one last"
        if problem:
            cls.poll_message_set(problem)
        return not problem

    def execute(self, context: bpy.types.Context) -> set[str]:
        others = _others(context)
        for obj in others:
            copy_settings(context.object.hybrid_quad, obj.hybrid_quad)
        plural = "s" if len(others) > 1 else ""
        self.report({"INFO"}, f'{len(others)} object{plural} got the settings of "{context.object.name}"')
        return {"FINISHED"}


def copy_settings(source: HybridQuadSettings, target: HybridQuadSettings) -> None:
    """Copies all that a preset would keep."""
    _copy(source, target, (name for name in setting_names() if name != "transfer"))
    _copy(source.transfer, target.transfer, HybridQuadTransferSettings.__annotations__)


def _copy(source: bpy.types.PropertyGroup, target: bpy.types.PropertyGroup, names: Iterable[str]) -> None:
    for name in names:
        setattr(target, name, getattr(source, name))


def _others(context: bpy.types.Context) -> list[bpy.types.Object]:
    return [
        obj
        for obj in context.selected_objects
        if obj.type == "MESH" and obj != context.object and (obj.library is None or obj.override_library is not None)
    ]


CLASSES = (OBJECT_OT_hybrid_quad_copy_settings,)
