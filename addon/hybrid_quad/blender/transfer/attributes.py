"""Attributes that users, sculpting, painting and Geometry Nodes put on a mesh."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np

from ...core.transfer.layers import Layer
from .. import edge_marks
from . import buffers


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
    active_color, rendered_color : str
        Names of color attributes; empty without.
    unknown : tuple of str
        Names of attributes of types that are not known here.
    """

    each: tuple[MeshAttribute, ...]
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
        active,
        rendered,
        tuple(attribute.name for attribute in asked if attribute.data_type not in STORAGES),
    )


def carried(attributes: MeshAttributes) -> tuple[Layer, ...]:
    """What of some attributes is computed for a result.

    Numbers, vectors and colors of vertices and corners can lie between the source's; what cannot be mixed is that of the nearest one.
    """
    return tuple(
        Layer(each.domain, _numbers(each.values)[0], STORAGES[each.data_type].is_continuous, _SAME)
        for each in attributes.each
    )


def write(mesh: bpy.types.Mesh, attributes: MeshAttributes, carried_values: tuple[Any, ...], edges: Any) -> None:
    """Gives a mesh these attributes.

    Parameters
    ----------
    carried_values : tuple of arrays
        What became of :func:`carried` on the mesh.
    edges : (E, 2) int32, or None
        The vertex pairs that values of edges belong to, in order.
    """
    for source, numbers in zip(attributes.each, carried_values, strict=True):
        values = numbers
        if source.domain == "EDGE":
            values = np.empty_like(numbers)
            values[edge_marks.indices_of(mesh, edges)] = numbers
        texts = _numbers(source.values)[1]
        target = mesh.attributes.new(source.name, source.data_type, source.domain)
        _set_values(target, values if texts is None else texts[values])
    names = [layer.name for layer in mesh.color_attributes]
    if attributes.active_color in names:
        mesh.color_attributes.active_color_index = names.index(attributes.active_color)
    if attributes.rendered_color in names:
        mesh.color_attributes.render_color_index = names.index(attributes.rendered_color)


def _numbers(values: Any) -> tuple[Any, Any]:
    """Values as numbers; for texts with the texts that they stand for, the empty one for 0."""
    if values.dtype != object:
        return values, None
    first = values.tolist()
    texts = list(dict.fromkeys([type(first[0])(), *first]))
    place = {text: number for number, text in enumerate(texts)}
    table = np.empty(len(texts), object)
    table[:] = texts
    return np.array([place[text] for text in first], np.int64), table


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
