"""The shape to remesh: without what the result keeps alive.

A shape key or an armature that the result takes along would act twice, had it acted on the shape that was remeshed.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any, NamedTuple

import bpy

# Modifiers that move the mesh as something outside of it does, and need nothing that was made for the old mesh.
_RIGGING = frozenset(("ARMATURE", "LATTICE"))
# Modifiers that leave the mesh as it is.
_PASSIVE = frozenset(("COLLISION", "PARTICLE_SYSTEM"))


class Rest(NamedTuple):
    """An object as it is to be remeshed.

    Attributes
    ----------
    shown : Object
        Its evaluated mesh is the shape: the object itself, or for a while a copy of it.
    applied : tuple of str
        Names of the object's modifiers that are part of the shape.
    has_keys : bool
        Whether `shown` is in the shape of its reference key, and can be set to others.
    """

    shown: bpy.types.Object
    applied: tuple[str, ...]
    has_keys: bool


@contextlib.contextmanager
def at_rest(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, kinds: frozenset[str]) -> Iterator[Rest]:
    """An object without the effect of what a result takes along alive, given the `kinds` that it does."""
    visible = [modifier for modifier in obj.modifiers if modifier.show_viewport]
    alive = [modifier.name for modifier in visible if _stays_alive(modifier, kinds)]
    applied = tuple(modifier.name for modifier in visible if modifier.name not in alive)
    acting = [name for name in alive if obj.modifiers[name].type not in _PASSIVE]
    has_keys = "shape_keys" in kinds and obj.data.shape_keys is not None
    needed = {"ARMATURE": {"parent", "vertex_groups"}, "LATTICE": {"parent"}}.get(obj.parent_type)
    is_rigged = needed is not None and needed <= kinds
    if not (acting or has_keys or is_rigged):
        yield Rest(obj, applied, False)
        return
    copy = obj.copy()
    try:
        copy.data = obj.data.copy()
        for name in alive:
            copy.modifiers.remove(copy.modifiers[name])
        if is_rigged:
            copy.parent = None
        if has_keys:
            _show_reference_key(copy)
        depsgraph.scene.collection.objects.link(copy)
        depsgraph.update()
        yield Rest(copy, applied, has_keys)
    finally:
        data = copy.data
        bpy.data.objects.remove(copy)
        if data is not obj.data:
            bpy.data.meshes.remove(data)


def _stays_alive(modifier: Any, kinds: frozenset[str]) -> bool:
    if "modifiers" not in kinds or modifier.type not in _RIGGING | _PASSIVE:
        return False
    # Without its groups a rig would move nothing, or all of the mesh.
    if modifier.type == "ARMATURE":
        return "vertex_groups" in kinds or not modifier.use_vertex_groups
    return "vertex_groups" in kinds or not getattr(modifier, "vertex_group", "")


def _show_reference_key(obj: bpy.types.Object) -> None:
    keys = obj.data.shape_keys
    keys.animation_data_clear()
    for key in keys.key_blocks:
        key.mute = False
        key.vertex_group = ""
    obj.show_only_shape_key = True
    obj.active_shape_key_index = keys.key_blocks.find(keys.reference_key.name)
