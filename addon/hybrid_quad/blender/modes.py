"""What happens to meshes whose owners are in Edit Mode or Sculpt Mode, where these can't be exchanged or read in full."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

import bpy


@contextlib.contextmanager
def out_of(obj: bpy.types.Object, *modes: str) -> Iterator[None]:
    """Leaves a mode for a while if an object is active and in one of these; what is active then is in it afterwards.

    An object that is in a mode without being active stays in it: operators change the active one's.
    """
    mode = obj.mode
    if mode not in modes or not _is_active(obj):
        yield
        return
    bpy.ops.object.mode_set(mode="OBJECT")
    try:
        yield
    finally:
        bpy.ops.object.mode_set(mode=mode)


@contextlib.contextmanager
def out_of_for_change(obj: bpy.types.Object) -> Iterator[None]:
    """:func:`out_of` Edit Mode and Sculpt Mode, to change what the active object is or has.

    Undo steps of Sculpt Mode are differences, which Blender applies to whatever mesh it finds. So that it does not find the changed
    one, a step of the whole file comes before the change: one undo leads there, in Object Mode.
    """
    is_sculpted = obj.mode == "SCULPT" and _is_active(obj)
    with out_of(obj, "EDIT", "SCULPT"):
        if is_sculpted:
            bpy.ops.ed.undo_push(message="Leave Sculpt Mode")
        yield


def _is_active(obj: bpy.types.Object) -> bool:
    return bool(bpy.context.view_layer.objects.active == obj)


@contextlib.contextmanager
def readable_mesh(obj: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
    """An object's mesh as it is, with all attributes: in Edit Mode, for a while, a copy of it."""
    if obj.mode != "EDIT":
        yield obj.data
        return
    obj.update_from_editmode()
    mesh = obj.data.copy()
    try:
        yield mesh
    finally:
        bpy.data.meshes.remove(mesh)
