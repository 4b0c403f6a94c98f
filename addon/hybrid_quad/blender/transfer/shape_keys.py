"""Shape keys: how each moves the surface, on the result's vertices."""

from __future__ import annotations

from typing import NamedTuple

import bmesh
import bpy
import numpy as np

from ...core.mesh_arrays import FloatArray
from ...core.transfer.layers import Layer
from . import buffers
from .rest import Rest


class ShapeKeys(NamedTuple):
    """The shape keys of a mesh.

    Attributes
    ----------
    offsets : dict of str to (n, 3) float64
        How each key moves the vertices, from the reference key on, in object space.
    lost : tuple of str
        Names of keys under which the modifiers make other vertices.
    """

    offsets: dict[str, FloatArray]
    lost: tuple[str, ...]


def read(rest: Rest, depsgraph: bpy.types.Depsgraph, base: FloatArray) -> ShapeKeys:
    """The keys of an object in the shape of its reference key.

    Parameters
    ----------
    base : (n, 3) float
        Vertices of its evaluated mesh.
    """
    keys = rest.shown.data.shape_keys
    if any(modifier.show_viewport for modifier in rest.shown.modifiers):
        shapes = {key.name: _evaluated_shape(rest.shown, depsgraph, key.name) for key in keys.key_blocks}
    else:
        shapes = {key.name: buffers.read(key.data, "co", np.float32, 3) for key in keys.key_blocks}
    fitting = {name: shape - base for name, shape in shapes.items() if len(shape) == len(base)}
    return ShapeKeys(fitting, tuple(name for name in shapes if name not in fitting))


def carried(source: ShapeKeys) -> tuple[Layer, ...]:
    """What is computed for a result."""
    return tuple(Layer("POINT", offsets.astype(np.float64), True) for offsets in source.offsets.values())


def write(mesh: bpy.types.Mesh, source: ShapeKeys, carried_values: tuple[FloatArray, ...]) -> None:
    """Gives the keys of a mesh, which has as many as it should, the shapes of which :func:`carried` has become the offsets."""
    base = buffers.read(mesh.vertices, "co", np.float32, 3)
    offsets = dict(zip(source.offsets, carried_values, strict=True))
    for key in mesh.shape_keys.key_blocks:
        shape = base + offsets[key.name] if key.name in offsets else base
        buffers.write(key.data, "co", shape.astype(np.float32))


def resize(mesh: bpy.types.Mesh, vertex_count: int) -> None:
    """Empties a mesh, and makes its keys fit so many vertices; all else about them stays, drivers included.

    Only a bmesh changes the size of shape keys, on its way back into the mesh that has them.
    """
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        bmesh.ops.delete(edited, geom=edited.verts[:], context="VERTS")
        for _ in range(vertex_count):
            edited.verts.new()
        edited.to_mesh(mesh)
    finally:
        edited.free()
    mesh.clear_geometry()


def _evaluated_shape(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, name: str) -> FloatArray:
    obj.active_shape_key_index = obj.data.shape_keys.key_blocks.find(name)
    depsgraph.update()
    evaluated = obj.evaluated_get(depsgraph)
    try:
        shape: FloatArray = buffers.read(evaluated.to_mesh().vertices, "co", np.float32, 3).astype(np.float64)
        return shape
    finally:
        evaluated.to_mesh_clear()
