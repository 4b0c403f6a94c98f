"""Creases and bevel weights of vertices: each is a mark on one corner of the shape, and goes to the vertex nearest to it."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np
from mathutils.kdtree import KDTree

from .. import edge_marks
from ..edge_marks import VertexStore
from .correspondence import Correspondence

_STORES = (("creases", edge_marks.VERTEX_CREASE), ("bevel_weights", edge_marks.VERTEX_BEVEL))
# A vertex farther than this share of its quads' size is not the one that was marked.
_NEAR = 0.5


class VertexMark(NamedTuple):
    """Weights of vertices.

    Attributes
    ----------
    store : VertexStore
        Where Blender keeps them.
    vertices : (k,) int64
        Those of the source with a weight above zero.
    weights : (k,) float32
    """

    store: VertexStore
    vertices: Any
    weights: Any


def read(mesh: bpy.types.Mesh, kinds: frozenset[str]) -> tuple[VertexMark, ...]:
    """The vertex creases and bevel weights of a mesh that are asked for."""
    marks = []
    for kind, store in _STORES:
        values = store.read(mesh) if kind in kinds else None
        if values is not None and values.any():
            vertices = np.flatnonzero(values)
            marks.append(VertexMark(store, vertices, values[vertices]))
    return tuple(marks)


def write(mesh: bpy.types.Mesh, marks: tuple[VertexMark, ...], correspondence: Correspondence) -> None:
    """Gives each mark to the vertex of the result nearest to it, the largest where that has several."""
    tree = KDTree(len(correspondence.points))
    for index, point in enumerate(correspondence.points.tolist()):
        tree.insert(point, index)
    tree.balance()
    reach = _NEAR * correspondence.vertex_reach
    for mark in marks:
        values = np.zeros(len(mesh.vertices), np.float32)
        for point, weight in zip(correspondence.source.points[mark.vertices], mark.weights, strict=True):
            _, index, distance = tree.find(point)
            if distance <= reach[index]:
                values[index] = max(values[index], weight)
        mark.store.write(mesh, values)
