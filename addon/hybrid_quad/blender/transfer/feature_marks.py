"""Edges of the result along features of the source get the marks that those have."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.mesh_arrays import IntArray
from ...core.transfer.edges import SourceEdges
from .. import edge_marks
from . import buffers

if TYPE_CHECKING:
    from ..remesh_task import RemeshTask

_KINDS = {
    "sharp_edges": edge_marks.SHARP,
    "seams": edge_marks.SEAM,
    "creases": edge_marks.CREASE,
    "bevel_weights": edge_marks.BEVEL,
    "freestyle_marks": edge_marks.FREESTYLE,
}


def carried(task: RemeshTask, kinds: frozenset[str]) -> SourceEdges:
    """What is computed for a result."""
    return SourceEdges(
        task.source.polygons,
        task.source.edges,
        task.source.edge_values,
        task.feature_marks,
        edge_marks.FEATURE | sum(mark for kind, mark in _KINDS.items() if kind in kinds),
        task.options.sharp_angle,
    )


def add_seams(mesh: bpy.types.Mesh, edges: IntArray) -> None:
    """Marks edges of a mesh, given as vertex pairs, as seams besides those that are."""
    if len(edges):
        values = buffers.read(mesh.edges, "use_seam", np.bool_)
        values[edge_marks.indices_of(mesh, edges)] = True
        buffers.write(mesh.edges, "use_seam", values)
