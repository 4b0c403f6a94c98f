"""What faces carry of Blender's own: materials, shading, face sets and Freestyle's marks."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np

from . import buffers
from .correspondence import Correspondence

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


def write(mesh: bpy.types.Mesh, source: FaceMarks, correspondence: Correspondence) -> None:
    """Gives each face what the source has at its middle."""
    if all(values is None or (values == values[0]).all() for values in source):
        nearest = np.zeros(len(mesh.polygons), np.int64)
    else:
        nearest = correspondence.polygons
    buffers.write(mesh.polygons, "use_smooth", source.is_smooth[nearest])
    if source.materials is not None:
        buffers.write(mesh.polygons, "material_index", source.materials[nearest])
    if source.face_sets is not None:
        attribute = mesh.attributes.new(_FACE_SETS, "INT", "FACE")
        buffers.write(attribute.data, "value", source.face_sets[nearest])
    if source.freestyle is not None and source.freestyle.any():
        _write_freestyle(mesh, source.freestyle[nearest])


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
