"""What belongs to the object and to the mesh as a whole: modifiers, parent, collections, animation and the like."""

from __future__ import annotations

from typing import Any

import bpy

from . import shape_keys
from .layers import SourceLayers


def empty_mesh_like(source: bpy.types.Object, layers: SourceLayers, vertex_count: int) -> bpy.types.Mesh:
    """A mesh without geometry that has all settings of a source's, and shape keys that fit so many vertices."""
    mesh = source.data.copy()
    holder = bpy.data.objects.new(mesh.name, mesh)
    try:
        if layers.keys is None or mesh.shape_keys is None:
            if mesh.shape_keys:
                holder.shape_key_clear()
            mesh.clear_geometry()
        else:
            shape_keys.resize(mesh, vertex_count)
        if layers.groups is None:
            holder.vertex_groups.clear()
    except BaseException:
        bpy.data.objects.remove(holder)
        bpy.data.meshes.remove(mesh)
        raise
    bpy.data.objects.remove(holder)
    if "custom_properties" not in layers.kinds:
        _clear_properties(mesh)
    return mesh


def take_along(context: bpy.types.Context, result: bpy.types.Object, layers: SourceLayers) -> None:
    """Leaves a copy of a source object, which has its result, only with what is asked for; it stays where it is seen.

    Except where an action moves it in the space of a parent that it leaves.
    """
    kinds = layers.kinds
    keep_modifiers(result, layers)
    if not {"parent", "constraints"} <= kinds:
        _set_free(context, result, kinds)
    if "animation" not in kinds:
        result.animation_data_clear()
    if "custom_properties" not in kinds:
        _clear_properties(result)


def keep_modifiers(obj: bpy.types.Object, layers: SourceLayers) -> None:
    """Removes the modifiers that are part of the result, or all where none are asked for, and the drivers of these."""
    for modifier in list(obj.modifiers):
        if modifier.name in layers.applied or "modifiers" not in layers.kinds:
            _remove_drivers(obj, f'modifiers["{bpy.utils.escape_identifier(modifier.name)}"]')
            obj.modifiers.remove(modifier)


def collections_for(
    context: bpy.types.Context, source: bpy.types.Object, layers: SourceLayers
) -> tuple[bpy.types.Collection, ...]:
    """The collections that a new object with the result goes to."""
    own = source.users_collection if "collections" in layers.kinds else (context.collection,)
    return tuple(own) or (context.scene.collection,)


def _set_free(context: bpy.types.Context, obj: bpy.types.Object, kinds: frozenset[str]) -> None:
    """Removes the parent or the constraints of an object, or both."""
    muted = []
    if "constraints" in kinds:  # they will act on what is set here
        muted = [constraint for constraint in obj.constraints if not constraint.mute]
    for constraint in muted:
        constraint.mute = True
    context.view_layer.update()
    place = obj.matrix_world.copy()
    if "parent" not in kinds:
        obj.parent = None
    if "constraints" not in kinds:
        obj.constraints.clear()
    obj.matrix_world = place
    for constraint in muted:
        constraint.mute = False


def _remove_drivers(obj: bpy.types.Object, path: str) -> None:
    if obj.animation_data:
        for driver in [each for each in obj.animation_data.drivers if each.data_path.startswith(path)]:
            obj.animation_data.drivers.remove(driver)


def _clear_properties(owner: Any) -> None:
    for name in [name for name in owner.keys() if name not in owner.bl_rna.properties]:  # noqa: SIM118
        del owner[name]
