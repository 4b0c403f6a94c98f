"""The operators ``hybrid_quad.density_from_layer`` and ``hybrid_quad.clear_painted``."""

# No "from __future__ import annotations" here: Blender reads the properties from the annotations' values.

from typing import Any

import bpy
import numpy as np

from ...core.mesh_arrays import FloatArray
from ...core.painting.density_values import brightness, density_between, means_of_vertices
from ...core.wishes import DENSITY_BOUNDS
from ..transfer import buffers
from . import stored_values
from .brush_settings import KINDS
from .paint_operator import PaintingOperator
from .painted_lines import PaintedLines

SOURCES = (
    ("VERTEX_GROUP", "Vertex Group", "Weights of a vertex group; 0 where a vertex is not in it"),
    ("COLOR", "Color Attribute", "How bright a color attribute is: black 0, white 1"),
)
_COLORS = ("FLOAT_COLOR", "BYTE_COLOR")
_LIMITS = {"min": DENSITY_BOUNDS[0], "max": DENSITY_BOUNDS[1], "precision": 2}


class HYBRID_QUAD_OT_density_from_layer(PaintingOperator):
    """Take the density of quads from the active vertex group or color attribute"""

    bl_idname = "hybrid_quad.density_from_layer"
    bl_label = "Density from Layer"
    bl_options = {"REGISTER", "UNDO"}

    source: bpy.props.EnumProperty(
        name="Source", description="What says the density", items=SOURCES, default="VERTEX_GROUP"
    )
    layer: bpy.props.StringProperty(
        name="Layer", description="Name of the vertex group or color attribute; empty: the active one", default=""
    )
    low: bpy.props.FloatProperty(
        name="At 0",
        description="Density where the layer is 0; 1: as usual, 2: edges half as long",
        default=1.0,
        **_LIMITS,
    )
    high: bpy.props.FloatProperty(
        name="At 1",
        description="Density where the layer is 1; 1: as usual, 2: edges half as long",
        default=3.0,
        **_LIMITS,
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.object
        try:
            shares = _weights(obj, self.layer) if self.source == "VERTEX_GROUP" else _bright(obj.data, self.layer)
            values = np.log(density_between(self.low, self.high, shares))
            stored_values.write(obj.data, "DENSITY", np.arange(len(values)), values, np.eye(3))
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class HYBRID_QUAD_OT_clear_painted(PaintingOperator):
    """Remove everything of one kind that is painted on the active mesh"""

    bl_idname = "hybrid_quad.clear_painted"
    bl_label = "Clear Painted Guides"
    bl_options = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(name="Kind", description="What is removed", items=KINDS, default="DIRECTION")

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.object
        try:
            if self.kind in ("DIRECTION", "DENSITY"):
                is_gone = stored_values.remove(obj.data, self.kind)
            else:
                is_gone = PaintedLines(obj, self.kind).clear() > 0
        except ValueError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if not is_gone:
            self.report({"INFO"}, "Nothing of this kind is painted here")
        return {"FINISHED"} if is_gone else {"CANCELLED"}


def _weights(obj: bpy.types.Object, name: str) -> FloatArray:
    """(n,) weights of a vertex group."""
    group = obj.vertex_groups.get(name) if name else obj.vertex_groups.active
    if group is None:
        raise ValueError(f'There is no vertex group "{name}"' if name else "The object has no vertex group")
    weights = np.zeros(len(obj.data.vertices))
    for index, vertex in enumerate(obj.data.vertices):
        for item in vertex.groups:
            if item.group == group.index:
                weights[index] = item.weight
    return weights


def _bright(mesh: bpy.types.Mesh, name: str) -> FloatArray:
    """(n,) brightness of a color attribute at the vertices."""
    layer: Any = mesh.color_attributes.get(name) if name else mesh.color_attributes.active_color
    if layer is None or layer.data_type not in _COLORS:
        raise ValueError(f'There is no color attribute "{name}"' if name else "The mesh has no color attribute")
    bright = brightness(buffers.read(layer.data, "color", np.float32, 4)[:, :3].astype(np.float64))
    if layer.domain == "POINT":
        return bright
    corners = buffers.read(mesh.loops, "vertex_index", np.int32)
    return means_of_vertices(bright, corners, len(mesh.vertices))


CLASSES = (HYBRID_QUAD_OT_density_from_layer, HYBRID_QUAD_OT_clear_painted)
