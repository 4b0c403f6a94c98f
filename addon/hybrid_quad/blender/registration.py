"""Adds the add-on's classes and properties to Blender, and takes every one of them away again."""

from __future__ import annotations

import atexit
import contextlib

import bpy

try:
    import numpy  # noqa: F401
except ImportError as error:
    raise ImportError("Hybrid Quad needs numpy in Blender's Python (Debian: apt install python3-numpy)") from error

from . import (
    background_run,
    check_operators,
    command,
    copy_settings,
    operators,
    own_mesh,
    panels,
    part_pick,
    presets,
    properties,
    repair_operators,
    run_display,
    selected_objects,
    task_solving,
)
from .overridable import OVERRIDE
from .painting import registration as painting
from .preview import limit, sessions
from .preview import settings as preview_settings

CLASSES = (
    *properties.CLASSES,
    *preview_settings.CLASSES,
    *operators.CLASSES,
    *selected_objects.CLASSES,
    *check_operators.CLASSES,
    *repair_operators.CLASSES,
    *presets.CLASSES,
    *copy_settings.CLASSES,
    *part_pick.CLASSES,
    *limit.CLASSES,
    *painting.CLASSES,
    # Panels stand in the order in which they come here.
    *panels.CLASSES,
)
# What is added to Blender's own menus and panels, in this order.
ENTRIES = (
    ("VIEW3D_MT_object", operators.draw_menu_entry),
    ("VIEW3D_MT_object", selected_objects.draw_menu_entry),
    ("DATA_PT_remesh", operators.draw_remesh_button),
)


def register() -> None:
    """Safe to call again: what a former call left is taken away first."""
    unregister()
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.hybrid_quad = bpy.props.PointerProperty(
        type=properties.HybridQuadSettings,
        name="Hybrid Quad",
        description="How this object is remeshed",
        override=OVERRIDE,
    )
    bpy.types.WindowManager.hybrid_quad_preview = bpy.props.PointerProperty(
        type=preview_settings.HybridQuadPreviewSettings, name="Hybrid Quad", description="What is drawn over objects"
    )
    sessions.register()
    own_mesh.register()
    run_display.register()
    painting.register()
    for owner, entry in ENTRIES:
        getattr(bpy.types, owner).append(entry)
    command.register()
    if not bpy.app.binary_path:
        # Blender as a module: 4.5 crashes as it ends with a class registered; 4.2 does so even after all is taken away.
        atexit.register(unregister)


def unregister() -> None:
    """Safe to call where nothing is registered."""
    atexit.unregister(unregister)
    background_run.forget()
    task_solving.forget_results()
    sessions.unregister()
    own_mesh.unregister()
    command.unregister()
    # Blender cannot say whether a menu has an entry; removing one that is not there does no harm.
    for owner, entry in ENTRIES:
        getattr(bpy.types, owner).remove(entry)
    if hasattr(bpy.types.Object, "hybrid_quad"):
        del bpy.types.Object.hybrid_quad
    if hasattr(bpy.types.WindowManager, "hybrid_quad_preview"):
        del bpy.types.WindowManager.hybrid_quad_preview
    painting.unregister()
    run_display.unregister()
    for cls in reversed(CLASSES):
        with contextlib.suppress(RuntimeError):  # not registered
            bpy.utils.unregister_class(cls)
