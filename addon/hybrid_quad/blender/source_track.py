"""Finds a run's source again, whatever was done in Blender meanwhile, and says whether it is still what was read."""

from __future__ import annotations

import hashlib
from typing import Any

import bpy
import numpy as np

from .modes import readable_mesh

# How many numbers of what kind an element of an attribute has, and what they are called.
_ATTRIBUTES = {
    "FLOAT": ("value", 1, np.float32),
    "INT": ("value", 1, np.int32),
    "INT8": ("value", 1, np.int32),
    "BOOLEAN": ("value", 1, np.bool_),
    "FLOAT2": ("vector", 2, np.float32),
    "FLOAT_VECTOR": ("vector", 3, np.float32),
    "FLOAT_COLOR": ("color", 4, np.float32),
    "BYTE_COLOR": ("color", 4, np.float32),
    "INT16_2D": ("value", 2, np.int32),
    "INT32_2D": ("value", 2, np.int32),
    "QUATERNION": ("value", 4, np.float32),
}
# What is selected or hidden is no change of a mesh.
_DISPLAY_ATTRIBUTES = (".select", ".uv_select", ".hide", ".vs.", ".es.", ".pn.")
# Older Blenders keep places, faces and marks outside attributes.
_ALL_IN_ATTRIBUTES = (4, 2)
_EDGE_MARKS = ("use_seam", "use_edge_sharp", "crease", "bevel_weight", "use_freestyle_mark")


class SourceTrack:
    """An object as it was when a run began.

    Holds nothing of Blender's own, as undo may put other objects in the place of those that were.

    Attributes
    ----------
    name : str
        Of the object, then.
    was_touched : bool
        Whether Blender told of a change of the mesh since then, be it of what no digest has, as the weights of vertex groups.
    """

    def __init__(self, obj: bpy.types.Object) -> None:
        self.name: str = obj.name
        self._identity = identity(obj)
        self._mesh_name: str = obj.data.name
        self._state = _state(obj)
        self.was_touched = False

    def find(self) -> bpy.types.Object | None:
        """The object, even if it was renamed; None where it is in no scene any more."""
        found = next((obj for obj in bpy.data.objects if identity(obj) == self._identity), None)
        if not hasattr(bpy.types.ID, "session_uid") and (found is None or not self._has_a_name_of(found)):
            # Before Blender 4.2 only the place in memory tells objects apart. Undo moves them, but keeps their names.
            found = bpy.data.objects.get(self.name)
        if found is None or found.type != "MESH" or not found.users_scene:
            return None
        return found

    def take_notice(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Of what Blender tells about changes."""
        if self.was_touched or not any(update.is_updated_geometry for update in depsgraph.updates):
            return
        obj = self.find()
        self.was_touched = obj is not None and any(
            update.is_updated_geometry and update.id.original in (obj, obj.data) for update in depsgraph.updates
        )

    def has_changed(self, obj: bpy.types.Object) -> bool:
        """Whether the object's mesh or modifiers are others than when the run began. Only in Object Mode."""
        return _state(obj) != self._state

    def has_changed_mesh(self, obj: bpy.types.Object) -> bool:
        """Whether the object's own mesh is another than when the run began, also in Edit Mode."""
        with readable_mesh(obj) as mesh:
            return _mesh_state(mesh) != self._state[0]

    def _has_a_name_of(self, obj: bpy.types.Object) -> bool:
        return obj.name == self.name or (obj.type == "MESH" and obj.data.name == self._mesh_name)


def identity(obj: bpy.types.Object) -> int:
    """What tells an object from all others while the file is open; before Blender 4.2 undo may change it."""
    return int(obj.session_uid) if hasattr(obj, "session_uid") else int(obj.as_pointer())


def _state(obj: bpy.types.Object) -> tuple[bytes, bytes]:
    """Digests of an object's mesh, and of its modifiers' settings and the names of what it has."""
    digest = hashlib.blake2b()
    digest.update(repr([slot.name for slot in obj.material_slots]).encode())
    digest.update(repr(obj.vertex_groups.keys()).encode())
    for modifier in obj.modifiers:
        digest.update(repr(_settings(modifier)).encode())
    with readable_mesh(obj) as mesh:
        return _mesh_state(mesh), digest.digest()


def _mesh_state(mesh: bpy.types.Mesh) -> bytes:
    """A digest of a mesh, without what is selected."""
    digest = hashlib.blake2b()
    _add(digest, mesh.polygons, "loop_start", 1, np.int32)
    if bpy.app.version < _ALL_IN_ATTRIBUTES:
        _add(digest, mesh.vertices, "co", 3, np.float32)
        _add(digest, mesh.edges, "vertices", 2, np.int32)
        _add(digest, mesh.loops, "vertex_index", 1, np.int32)
        _add(digest, mesh.polygons, "use_smooth", 1, np.bool_)
        _add(digest, mesh.polygons, "material_index", 1, np.int32)
        for name in _EDGE_MARKS:
            if name in bpy.types.MeshEdge.bl_rna.properties:
                _add(digest, mesh.edges, name, 1, np.bool_ if name.startswith("use_") else np.float32)
    for layer in mesh.uv_layers:
        if layer.name not in mesh.attributes:  # before Blender 3.5
            digest.update(layer.name.encode())
            _add(digest, layer.data, "uv", 2, np.float32)
    for key in mesh.shape_keys.key_blocks if mesh.shape_keys else ():
        digest.update(key.name.encode())
        _add(digest, key.data, "co", 3, np.float32)
    for attribute in mesh.attributes:
        if attribute.data_type in _ATTRIBUTES and not attribute.name.startswith(_DISPLAY_ATTRIBUTES):
            digest.update(f"{attribute.name} {attribute.domain} {attribute.data_type}".encode())
            _add(digest, attribute.data, *_ATTRIBUTES[attribute.data_type])
    return digest.digest()


def _add(digest: Any, collection: Any, name: str, width: int, dtype: type) -> None:
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(name, values)
    digest.update(values.view(np.uint8))


def _settings(modifier: bpy.types.Modifier) -> list[tuple[str, str]]:
    """What a user can set of a modifier, and what it names."""
    settings = []
    for prop in modifier.bl_rna.properties:
        if prop.is_readonly or prop.identifier in ("show_expanded", "is_active", "use_pin_to_last"):
            continue
        value = getattr(modifier, prop.identifier)
        if prop.type == "POINTER":
            value = value.name if isinstance(value, bpy.types.ID) else None
        elif getattr(prop, "is_array", False):
            value = [each[:] if hasattr(each, "__getitem__") else each for each in value]
        settings.append((prop.identifier, repr(value)))
    return settings
