"""Which faces of an object are to be remeshed, and its own mesh, without modifiers, as the source of a run."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import bpy
import numpy as np

from ..core.edge_borders import BoolArray
from ..core.errors import InputError
from ..core.remesh_part import PartChoice
from .edge_marks import FACE_SET_ATTRIBUTE
from .mesh_source import MeshSource, linear_of, source_of
from .modes import readable_mesh
from .steps import finish
from .transfer import buffers, layers, mask, shape_keys
from .transfer.rest import Rest

_HALF = 0.5


def knows_face_sets() -> bool:
    """Whether this Blender lets Python see face sets."""
    return bpy.app.version >= (3, 5)


def choice_of(obj: bpy.types.Object) -> PartChoice | None:
    """What an object's settings say about the faces to remesh; None where these are all.

    Raises
    ------
    InputError
        ``no_part``, ``no_face_set``, ``no_mask``, ``no_attribute``, ``needs_whole_surface``.
    """
    settings: Any = obj.hybrid_quad.part
    if settings.region == "WHOLE":
        return None
    whole = obj.hybrid_quad
    if whole.symmetry or whole.fit_limit_surface:
        raise InputError(
            "needs_whole_surface",
            "Mirror and Fit Limit Surface need the whole surface: switch them off to remesh a part of it",
        )
    with readable_mesh(obj) as mesh:
        faces = _REGIONS[settings.region](mesh, settings)
    if settings.use_inverted:
        faces = ~faces
    if not faces.any():
        raise InputError("no_part", f'No face of "{obj.name}" is {_EMPTY[settings.region]}: there is nothing to remesh')
    return PartChoice(faces, settings.odd_border.lower(), settings.use_border_length)


def read_part_source(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, kinds: frozenset[str]) -> MeshSource:
    """Copies an object's own mesh: modifiers and shape keys stay alive on what has the result.

    Raises
    ------
    InputError
        As :func:`.mesh_source.read_source`.
    """
    linear = linear_of(obj, depsgraph)
    with readable_mesh(obj) as mesh:
        if not mesh.polygons:
            raise InputError("no_faces", f'"{obj.name}" has no faces')
        keys = mesh.shape_keys if "shape_keys" in kinds else None
        rest = Rest(obj, (), keys is not None)
        source = finish(source_of(lambda: mesh, linear, layers.LayerOrder.of(rest, kinds | {"modifiers"})))
        assert source.layers is not None
        own = source.layers
        if keys is not None:
            base = buffers.read(mesh.vertices, "co", np.float32, 3)
            shapes = {key.name: buffers.read(key.data, "co", np.float32, 3) - base for key in keys.key_blocks}
            own = replace(own, keys=shape_keys.ShapeKeys(shapes, ()))
        return replace(source, layers=own)


def _selected(mesh: bpy.types.Mesh, _settings: Any) -> BoolArray:
    faces: BoolArray = buffers.read(mesh.polygons, "select", np.bool_)
    return faces


def _visible(mesh: bpy.types.Mesh, _settings: Any) -> BoolArray:
    hidden: BoolArray = buffers.read(mesh.polygons, "hide", np.bool_)
    return ~hidden


def _of_face_set(mesh: bpy.types.Mesh, settings: Any) -> BoolArray:
    if not knows_face_sets():
        raise InputError("no_face_set", "Python cannot see face sets before Blender 3.5: select the faces in Edit Mode")
    attribute = mesh.attributes.get(FACE_SET_ATTRIBUTE)
    if attribute is None:
        raise InputError("no_face_set", f'"{mesh.name}" has no face sets')
    faces: BoolArray = buffers.read(attribute.data, "value", np.int32) == settings.face_set
    return faces


def _masked(mesh: bpy.types.Mesh, _settings: Any) -> BoolArray:
    values = mask.read(mesh)
    if values is None:
        raise InputError("no_mask", f'"{mesh.name}" has no mask: paint one in Sculpt Mode')
    sizes = buffers.read(mesh.polygons, "loop_total", np.int32)
    starts = buffers.read(mesh.polygons, "loop_start", np.int32)
    vertices = buffers.read(mesh.loops, "vertex_index", np.int32)
    faces = np.ones(len(sizes), np.bool_)
    for corner in range(int(sizes.max(initial=0))):
        has = corner < sizes
        faces[has] &= values[vertices[starts[has] + corner]] >= _HALF
    return faces


def _of_attribute(mesh: bpy.types.Mesh, settings: Any) -> BoolArray:
    attribute = mesh.attributes.get(settings.attribute)
    if attribute is None or (attribute.domain, attribute.data_type) != ("FACE", "BOOLEAN"):
        raise InputError(
            "no_attribute", f'"{mesh.name}" has no Boolean attribute of faces named "{settings.attribute}"'
        )
    faces: BoolArray = buffers.read(attribute.data, "value", np.bool_)
    return faces


_REGIONS = {
    "SELECTED": _selected,
    "VISIBLE": _visible,
    "FACE_SET": _of_face_set,
    "MASK": _masked,
    "ATTRIBUTE": _of_attribute,
}
_EMPTY = {
    "SELECTED": "selected",
    "VISIBLE": "visible",
    "FACE_SET": "in this face set",
    "MASK": "masked",
    "ATTRIBUTE": "chosen by this attribute",
}
