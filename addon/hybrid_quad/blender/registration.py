"""Adds the add-on's classes and properties to Blender, and takes every one of them away again."""

from __future__ import annotations

import contextlib

import bpy

try:
    import numpy  # noqa: F401
except ImportError as error:
    raise ImportError("Hybrid Quad needs numpy in Blender's Python (Debian: apt install python3-numpy)") from error

from . import background_run, check_operators, command, operators, panels, properties, run_display
from .painting import registration as painting

CLASSES = (
    *properties.CLASSES,
    *operators.CLASSES,
    *check_operators.CLASSES,
    *panels.CLASSES,
    *painting.CLASSES,
)


def register() -> None:
    """Safe to call again: what a former call left is taken away first."""
    unregister()
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.hybrid_quad = bpy.props.PointerProperty(
        type=properties.HybridQuadSettings, name="Hybrid Quad", description="How this object is remeshed"
    )
    run_display.register()
    painting.register()
    bpy.types.VIEW3D_MT_object.append(operators.draw_menu_entry)
    command.register()


def unregister() -> None:
    """Safe to call where nothing is registered."""
    background_run.forget()
    command.unregister()
    # Blender cannot say whether a menu has an entry; removing one that is not there does no harm.
    bpy.types.VIEW3D_MT_object.remove(operators.draw_menu_entry)
    if hasattr(bpy.types.Object, "hybrid_quad"):
        del bpy.types.Object.hybrid_quad
    painting.unregister()
    run_display.unregister()
    for cls in reversed(CLASSES):
        with contextlib.suppress(RuntimeError):  # not registered
            bpy.utils.unregister_class(cls)
