"""Creases and bevel weights of vertices."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np

from ...core.transfer.vertex_marks import MarkedVertices
from .. import edge_marks
from ..edge_marks import VertexStore

_STORES = (("creases", edge_marks.VERTEX_CREASE), ("bevel_weights", edge_marks.VERTEX_BEVEL))


class VertexMark(NamedTuple):
    """Weights of vertices.

    Attributes
    ----------
    store : VertexStore
        Where Blender keeps them.
    marked : MarkedVertices
    """

    store: VertexStore
    marked: MarkedVertices


def read(mesh: bpy.types.Mesh, kinds: frozenset[str]) -> tuple[VertexMark, ...]:
    """The vertex creases and bevel weights of a mesh that are asked for."""
    marks = []
    for kind, store in _STORES:
        values = store.read(mesh) if kind in kinds else None
        if values is not None and values.any():
            vertices = np.flatnonzero(values)
            marks.append(VertexMark(store, MarkedVertices(vertices, values[vertices])))
    return tuple(marks)


def write(mesh: bpy.types.Mesh, marks: tuple[VertexMark, ...], carried_values: tuple[Any, ...]) -> None:
    """Gives a mesh these marks with weights (n,) of its own."""
    for mark, values in zip(marks, carried_values, strict=True):
        mark.store.write(mesh, values)
