"""What faces carry of Blender's own: materials, shading, face sets and Freestyle's marks."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np

from ...core.transfer.layers import Layer
from . import buffers

_FACE_SETS = ".sculpt_face_set"  # from Blender 3.5 on; before, Python cannot see face sets
_FREESTYLE = "freestyle_face"


class FaceMarks(NamedTuple):
    """Values of faces.

    Attributes
    ----------
    is_smooth : (f,) bool
    materials : (f,) int32, or None
        Slots.
    face_sets : (f,) int32, or None
    freestyle : (f,) bool, or None
    """

    is_smooth: Any
    materials: Any
    face_sets: Any
    freestyle: Any


def read(mesh: bpy.types.Mesh, kinds: frozenset[str]) -> FaceMarks:
    """Those of a mesh that are asked for, where it has any."""
    return FaceMarks(
        is_smooth=buffers.read(mesh.polygons, "use_smooth", np.bool_),
        materials=buffers.read(mesh.polygons, "material_index", np.int32) if "materials" in kinds else None,
        face_sets=_attribute(mesh, _FACE_SETS, "INT", np.int32) if "face_sets" in kinds else None,
        freestyle=_read_freestyle(mesh) if "freestyle_marks" in kinds else None,
    )


def carried(source: FaceMarks) -> tuple[Layer, ...]:
    """What is computed for a result."""
    return tuple(Layer("FACE", values) for values in source if values is not None)


def write(mesh: bpy.types.Mesh, source: FaceMarks, carried_values: tuple[Any, ...]) -> None:
    """Gives each face what :func:`carried` has become there."""
    left = iter(carried_values)
    marks = FaceMarks(*(None if values is None else next(left) for values in source))
    buffers.write(mesh.polygons, "use_smooth", marks.is_smooth)
    if marks.materials is not None:
        buffers.write(mesh.polygons, "material_index", marks.materials)
    if marks.face_sets is not None:
        attribute = mesh.attributes.new(_FACE_SETS, "INT", "FACE")
        buffers.write(attribute.data, "value", marks.face_sets)
    if source.freestyle is not None and source.freestyle.any():
        _write_freestyle(mesh, marks.freestyle)


def _attribute(mesh: bpy.types.Mesh, name: str, data_type: str, dtype: Any) -> Any:
    attribute = mesh.attributes.get(name)
    if attribute is None or (attribute.domain, attribute.data_type) != ("FACE", data_type):
        return None
    return buffers.read(attribute.data, "value", dtype)


def _read_freestyle(mesh: bpy.types.Mesh) -> Any:
    if "use_freestyle_mark" in bpy.types.MeshPolygon.bl_rna.properties:  # before Blender 5.0
        return buffers.read(mesh.polygons, "use_freestyle_mark", np.bool_)
    return _attribute(mesh, _FREESTYLE, "BOOLEAN", np.bool_)


def _write_freestyle(mesh: bpy.types.Mesh, values: Any) -> None:
    if "use_freestyle_mark" in bpy.types.MeshPolygon.bl_rna.properties:
        buffers.write(mesh.polygons, "use_freestyle_mark", values)
    else:
        buffers.write(mesh.attributes.new(_FREESTYLE, "BOOLEAN", "FACE").data, "value", values)
