"""Settings that a library override of an object can have of its own."""

from __future__ import annotations

from typing import Any

import bpy

# For the pointer to such settings.
OVERRIDE = {"LIBRARY_OVERRIDABLE"}


def overridable(cls: type[bpy.types.PropertyGroup]) -> type[bpy.types.PropertyGroup]:
    """Of a class of settings, before it is registered: without it, Blender drops what is set on an override when the file is saved."""
    for setting in cls.__annotations__.values():
        # From Blender 5.0 on, what is in a group within a group is not saved either way, and an error is logged at every loading.
        if not _is_group(setting) or bpy.app.version < (5, 0):
            setting.keywords["override"] = OVERRIDE
    return cls


def _is_group(setting: Any) -> bool:
    return setting.function is bpy.props.PointerProperty and issubclass(
        setting.keywords["type"], bpy.types.PropertyGroup
    )
