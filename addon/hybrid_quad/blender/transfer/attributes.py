"""Attributes that users, sculpting, painting and Geometry Nodes put on a mesh."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np

from . import buffers
from .correspondence import Correspondence


class _Storage(NamedTuple):
    """How the items of an attribute of one type are read and written."""

    value: str
    dtype: Any
    width: int
    is_continuous: bool


STORAGES = {
    "FLOAT": _Storage("value", np.float32, 1, True),
    "FLOAT_VECTOR": _Storage("vector", np.float32, 3, True),
    "FLOAT2": _Storage("vector", np.float32, 2, True),
    "FLOAT_COLOR": _Storage("color", np.float32, 4, True),
    "BYTE_COLOR": _Storage("color", np.float32, 4, True),
    "QUATERNION": _Storage("value", np.float32, 4, False),
    "FLOAT4X4": _Storage("value", np.float32, 16, False),
    "INT": _Storage("value", np.int32, 1, False),
    "INT8": _Storage("value", np.int8, 1, False),
    "INT16_2D": _Storage("value", np.int16, 2, False),
    "INT32_2D": _Storage("value", np.int32, 2, False),
    "BOOLEAN": _Storage("value", np.bool_, 1, False),
    "STRING": _Storage("value", object, 1, False),
}
# What faces and edges consist of.
TOPOLOGY = frozenset((".edge_verts", ".corner_vert", ".corner_edge"))
_COLORS = ("FLOAT_COLOR", "BYTE_COLOR")
# What Blender itself keeps in attributes, and what other files take along.
_NOT_OURS = frozenset(
    [
        "position",
        "material_index",
        "sharp_face",
        "sharp_edge",
        "uv_seam",
        "crease_edge",
        "crease_vert",
        "bevel_weight_edge",
        "bevel_weight_vert",
        "freestyle_edge",
        "freestyle_face",
        "custom_normal",
        "hybrid_quad_feature",
    ]
)
_SAME = 1e-6  # difference of values below which an attribute is not cut at an edge


class MeshAttribute(NamedTuple):
    """An attribute.

    Attributes
    ----------
    name, data_type, domain : str
        As Blender names them.
    values : (k,) or (k, d)
    """

    name: str
    data_type: str
    domain: str
    values: Any


class MeshAttributes(NamedTuple):
    """Attributes of a mesh.

    Attributes
    ----------
    each : tuple of MeshAttribute
    edges : (k, 2) int32
        The mesh's, if any attribute is of edges.
    active_color, rendered_color : str
        Names of color attributes; empty without.
    unknown : tuple of str
        Names of attributes of types that are not known here.
    """

    each: tuple[MeshAttribute, ...]
    edges: Any
    active_color: str
    rendered_color: str
    unknown: tuple[str, ...]


def read(mesh: bpy.types.Mesh, *, colors: bool, others: bool) -> MeshAttributes:
    """The color attributes of a mesh, or its others, or both."""
    maps = {layer.name for layer in mesh.uv_layers}
    asked = [
        attribute
        for attribute in mesh.attributes
        if not attribute.name.startswith(".")
        and attribute.name not in _NOT_OURS
        and not (attribute.name in maps and attribute.domain == "CORNER")
        and (colors if _is_color(attribute) else others)
    ]
    known = [attribute for attribute in asked if attribute.data_type in STORAGES]
    active, rendered = _color_names(mesh) if colors else ("", "")
    return MeshAttributes(
        tuple(MeshAttribute(each.name, each.data_type, each.domain, _values(each)) for each in known),
        buffers.read(mesh.edges, "vertices", np.int32, 2),
        active,
        rendered,
        tuple(attribute.name for attribute in asked if attribute.data_type not in STORAGES),
    )


def write(mesh: bpy.types.Mesh, attributes: MeshAttributes, correspondence: Correspondence) -> None:
    """Gives a mesh these attributes.

    Numbers, vectors and colors of vertices and corners are linear in the source's triangles; what cannot be mixed is that of the
    nearest vertex or corner. Of faces it is the value at the face's middle. Edges have the value of the source
    edge along which they run; zero where there is none.
    """
    followed = None
    for source in attributes.each:
        if source.domain == "EDGE":
            if followed is None:
                edges = buffers.read(mesh.edges, "vertices", np.int32, 2)
                followed = correspondence.followed(edges, correspondence.source.points, attributes.edges)
            values = source.values[followed]
            values[followed < 0] = type(values.flat[0])()
        else:
            values = _values_on_result(source, correspondence)
        target = mesh.attributes.new(source.name, source.data_type, source.domain)
        _set_values(target, values)
    names = [layer.name for layer in mesh.color_attributes]
    if attributes.active_color in names:
        mesh.color_attributes.active_color_index = names.index(attributes.active_color)
    if attributes.rendered_color in names:
        mesh.color_attributes.render_color_index = names.index(attributes.rendered_color)


def _values_on_result(source: MeshAttribute, correspondence: Correspondence) -> Any:
    surface, storage = correspondence.source, STORAGES[source.data_type]
    if source.domain == "FACE":
        return source.values[correspondence.polygons]
    if source.domain == "POINT":
        places, indices = correspondence.vertices, surface.vertices
    else:
        cut_by = _as_numbers(source.values)
        places = correspondence.corners(correspondence.walk.walls(cut_by, _SAME)).places
        indices = surface.corners
    if storage.is_continuous:
        return places.values(indices, source.values.astype(np.float64)).astype(storage.dtype)
    return source.values[places.nearest(indices)]


def _as_numbers(values: Any) -> Any:
    """(k, d) numbers that are the same where the values are."""
    if values.dtype == object:
        values = np.unique(values.astype(bytes), return_inverse=True)[1]
    return values.reshape(len(values), -1).astype(np.float64)


def _is_color(attribute: Any) -> bool:
    return attribute.data_type in _COLORS and attribute.domain in ("POINT", "CORNER")


def _values(attribute: Any) -> Any:
    storage = STORAGES[attribute.data_type]
    if storage.dtype is object:
        values = np.empty(len(attribute.data), object)
        values[:] = [item.value for item in attribute.data]
        return values
    return buffers.read(attribute.data, storage.value, storage.dtype, storage.width)


def _set_values(attribute: Any, values: Any) -> None:
    storage = STORAGES[attribute.data_type]
    if storage.dtype is object:
        for item, value in zip(attribute.data, values, strict=True):
            item.value = value
    else:
        buffers.write(attribute.data, storage.value, values)


def _color_names(mesh: bpy.types.Mesh) -> tuple[str, str]:
    layers = mesh.color_attributes
    rendered = layers.render_color_index
    return (
        layers.active_color.name if layers.active_color else "",
        layers[rendered].name if 0 <= rendered < len(layers) else "",
    )
