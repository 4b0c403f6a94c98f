"""The mask of Sculpt Mode."""

from __future__ import annotations

from typing import Any

import bmesh
import bpy
import numpy as np

from ...core.transfer.layers import Layer
from . import buffers

_ATTRIBUTE = ".sculpt_mask"  # from Blender 4.1 on


def read(mesh: bpy.types.Mesh) -> Any:
    """(n,) float32, or None."""
    if hasattr(mesh, "vertex_paint_masks"):
        return buffers.read(mesh.vertex_paint_masks[0].data, "value", np.float32) if mesh.vertex_paint_masks else None
    attribute = mesh.attributes.get(_ATTRIBUTE)
    return None if attribute is None else buffers.read(attribute.data, "value", np.float32)


def carried(source: Any) -> Layer:
    """What is computed for a result."""
    return Layer("POINT", source, True)


def write(mesh: bpy.types.Mesh, values: Any) -> None:
    """Gives a mesh this mask (n,)."""
    buffers.write(_items(mesh), "value", values)


def _items(mesh: bpy.types.Mesh) -> Any:
    if not hasattr(mesh, "vertex_paint_masks"):
        return mesh.attributes.new(_ATTRIBUTE, "FLOAT", "POINT").data
    edited = bmesh.new()  # before Blender 4.1 Python cannot make a mask otherwise
    edited.from_mesh(mesh)
    edited.verts.layers.paint_mask.verify()
    edited.to_mesh(mesh)
    edited.free()
    return mesh.vertex_paint_masks[0].data
