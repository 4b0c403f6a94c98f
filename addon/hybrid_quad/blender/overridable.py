"""Settings that a library override of an object can have of its own."""

from __future__ import annotations

import bpy

# For the pointer to such settings.
OVERRIDE = {"LIBRARY_OVERRIDABLE"}


def overridable(cls: type[bpy.types.PropertyGroup]) -> type[bpy.types.PropertyGroup]:
    """Of a class of settings, before it is registered: without it, Blender drops what is set on an override when the file is saved."""
    for setting in cls.__annotations__.values():
        setting.keywords["override"] = OVERRIDE
    return cls
