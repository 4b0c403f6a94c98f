"""The two previews of this Blender, and what keeps them up to date: a timer, and what Blender tells of changes and files."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

import bpy
from bpy.app.handlers import persistent

from ..run_display import redraw_sidebars
from . import drawing
from .drawing import Drawing
from .field import FieldPreview
from .limit import LimitPreview

_SECONDS = 0.04  # between two looks at what may have changed
_SECONDS_BUSY = 0.02  # and at a worker, as its answer is waited for

# Data whose lines may guide quads, whatever object shows it.
_LINES = (bpy.types.Curve, bpy.types.Annotation if hasattr(bpy.types, "Annotation") else bpy.types.GreasePencil)

field = FieldPreview()
limit = LimitPreview()


def settings() -> Any:
    """What is shown, for all windows."""
    return bpy.context.window_manager.hybrid_quad_preview


def follow_settings() -> None:
    """Starts and stops the previews as the settings say."""
    asked = settings()
    for preview, is_shown in ((field, asked.show_field), (limit, asked.show_limit)):
        if not is_shown:
            preview.session.clear()
    if not (asked.show_field or asked.show_limit):
        stop()
        return
    if not drawing.is_on():
        drawing.start(_drawings)
    if _on_change not in bpy.app.handlers.depsgraph_update_post:
        bpy.app.handlers.depsgraph_update_post.append(_on_change)
    if not bpy.app.timers.is_registered(_tick):
        bpy.app.timers.register(_tick)
    redraw()


def stop() -> None:
    """Ends all work and draws nothing any more; safe to call at any time."""
    field.session.clear()
    limit.session.clear()
    drawing.stop()
    with contextlib.suppress(ValueError):
        bpy.app.handlers.depsgraph_update_post.remove(_on_change)
    if bpy.app.timers.is_registered(_tick):
        bpy.app.timers.unregister(_tick)
    redraw()


def step(*, at_once: bool = False) -> None:
    """Looks once at what is shown, and has drawn anew what has changed.

    Views are drawn for other shapes only: a view of a large mesh takes the time that the worker needs.
    """
    asked = settings()
    for preview, is_shown in ((field, asked.show_field), (limit, asked.show_limit)):
        if not is_shown:
            continue
        session = preview.session
        result, told = session.result, (session.status, session.error)
        session.step(at_once=at_once)
        if session.result is not result:
            redraw()
        elif (session.status, session.error) != told:
            redraw_sidebars()


def redraw() -> None:
    """Has the 3D views drawn again, with the panels in them."""
    drawing.redraw()


def register() -> None:
    """Adds what Blender tells of files."""
    bpy.app.handlers.load_pre.append(_on_load)
    bpy.app.handlers.load_post.append(_after_load)


def unregister() -> None:
    """Ends everything and takes away every handler."""
    stop()
    for handlers, handler in (
        (bpy.app.handlers.load_pre, _on_load),
        (bpy.app.handlers.load_post, _after_load),
    ):
        with contextlib.suppress(ValueError):
            handlers.remove(handler)


def _tick() -> float | None:
    step()
    return _SECONDS_BUSY if field.session.is_busy or limit.session.is_busy else _SECONDS


def _drawings() -> Iterator[Drawing]:
    asked = settings()
    for preview, is_shown in ((limit, asked.show_limit), (field, asked.show_field)):
        obj = preview.session.target() if is_shown else None
        if obj is not None:
            yield obj, preview.shapes(asked)


@persistent
def _on_change(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Geometry that changed is the active object's, or may guide it, or is what it is compared with."""
    active = bpy.context.view_layer.objects.active
    if active is None:
        return
    asked = settings()
    for update in depsgraph.updates:
        changed = update.id.original
        if changed in (active, active.data):
            touches_field = touches_limit = update.is_updated_geometry or update.is_updated_transform
        else:
            touches_field = isinstance(changed, _LINES) or _is_guide(active, changed)
            touches_limit = update.is_updated_geometry and changed.name == active.hybrid_quad.source_name
        if touches_field and asked.show_field:
            field.session.mark_changed()
        if touches_limit and asked.show_limit:
            limit.session.mark_changed()


def _is_guide(active: bpy.types.Object, changed: bpy.types.ID) -> bool:
    named = active.hybrid_quad
    collection = named.guide_collection
    if changed in (named.guide_object, collection):
        return True
    return collection is not None and isinstance(changed, bpy.types.Object) and changed.name in collection.all_objects


@persistent
def _on_load(*_arguments: Any) -> None:
    stop()


@persistent
def _after_load(*_arguments: Any) -> None:
    """A file brings the settings of the window that saved it along; nothing is shown that nobody asked for now."""
    asked = settings()
    asked.show_field = asked.show_limit = False
