"""Custom normals of face corners, and free ones."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np

from ...core.corner_fans import fans_of_corners
from ...core.mesh_arrays import FloatArray, Polygons, unit_vectors
from ...core.transfer.layers import Layer
from . import buffers

_ATTRIBUTE = "custom_normal"
_SPLIT = 1e-4  # difference of normals above which an edge is sharp


class CustomNormals(NamedTuple):
    """Normals in object space.

    Attributes
    ----------
    domain : str
        CORNER; or, of free normals, another.
    is_free : bool
        Whether they are kept as vectors that do not turn with the surface (from Blender 4.5 on).
    values : (k, 3) float64
    """

    domain: str
    is_free: bool
    values: FloatArray


def read(mesh: bpy.types.Mesh) -> CustomNormals | None:
    """The custom normals of a mesh, if it has any."""
    attribute = mesh.attributes.get(_ATTRIBUTE)
    if attribute is not None and attribute.data_type == "FLOAT_VECTOR":
        return CustomNormals(attribute.domain, True, _vectors(attribute.data, "vector"))
    if not mesh.has_custom_normals:
        return None
    if hasattr(mesh, "calc_normals_split"):  # before Blender 4.1
        mesh.calc_normals_split()
        return CustomNormals("CORNER", False, _vectors(mesh.loops, "normal"))
    return CustomNormals("CORNER", False, _vectors(mesh.corner_normals, "vector"))


def carried(source: CustomNormals) -> Layer:
    """What is computed for a result."""
    return Layer(source.domain, source.values, True, _SPLIT)


def write(mesh: bpy.types.Mesh, source: CustomNormals, carried_values: FloatArray) -> None:
    """Gives a mesh normals, of which :func:`carried` has become `carried_values`; split only where edges are marked sharp."""
    values = carried_values
    if source.domain == "CORNER":
        values = _even_in_fans(mesh, unit_vectors(values))
    values = unit_vectors(values)
    if source.is_free:
        attribute = mesh.attributes.new(_ATTRIBUTE, "FLOAT_VECTOR", source.domain)
        buffers.write(attribute.data, "vector", values.astype(np.float32))
    else:
        mesh.normals_split_custom_set(values.tolist())


def _even_in_fans(mesh: bpy.types.Mesh, normals: FloatArray) -> FloatArray:
    """One normal for the corners around a vertex from one sharp edge to the next: more would mark more edges sharp."""
    polygons = Polygons(
        buffers.read(mesh.polygons, "loop_total", np.int32), buffers.read(mesh.loops, "vertex_index", np.int32)
    )
    is_sharp = buffers.read(mesh.edges, "use_edge_sharp", np.bool_)
    fans = fans_of_corners(polygons, is_sharp[buffers.read(mesh.loops, "edge_index", np.int32)])
    total = np.zeros((fans.max() + 1, 3))
    np.add.at(total, fans, normals)
    return total[fans]


def _vectors(collection: Any, name: str) -> FloatArray:
    vectors: FloatArray = buffers.read(collection, name, np.float32, 3).astype(np.float64)
    return vectors
