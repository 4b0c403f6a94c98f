"""Edges of a result that run along kept edges of the source get the marks that those have."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ...core.edge_borders import EdgeSides, edge_keys, uses_of_edges
from ...core.mesh_arrays import IntArray, Polygons
from ...core.remesh import RemeshResult
from .. import edge_marks
from ..edge_marks import EdgeValues
from . import buffers, uv_maps
from .correspondence import Correspondence
from .nearest import NearestEdges

if TYPE_CHECKING:
    from ..remesh_task import RemeshTask

_KINDS = {
    "sharp_edges": edge_marks.SHARP,
    "seams": edge_marks.SEAM,
    "creases": edge_marks.CREASE,
    "bevel_weights": edge_marks.BEVEL,
    "freestyle_marks": edge_marks.FREESTYLE,
}
# An edge that is farther from all kept edges than this share of its length was made for something else.
_NEAR = 0.5
_CUT = 1e-5  # distance in a UV map from which on it is cut


def on_result(task: RemeshTask, result: RemeshResult, kinds: frozenset[str]) -> tuple[IntArray, EdgeValues]:
    """Edges of the result along features and the boundary, and all that the edges that they follow carry.

    Returns
    -------
    edges : (k, 2) int32
        Vertex pairs.
    values : EdgeValues
    """
    source = task.source
    marks = source.marks
    if task.options.sharp_angle is not None:
        angle = math.radians(task.options.sharp_angle)
        marks = edge_marks.add_sharp_by_angle(marks, source.vertices, source.polygons, source.edges, angle)
    is_feature = ((source.marks & task.feature_marks) != 0) | (marks != source.marks)
    is_border = uses_of_edges(source.edges, source.polygons, len(source.vertices)) == 1
    quads = Polygons(np.full(len(result.quads), 4, np.int32), result.quads.ravel())
    edges = result.feature_edges
    on_border = uses_of_edges(edges, quads, len(result.vertices)) == 1
    followed = np.full(len(edges), -1, np.int64)
    for own, candidates in ((on_border, is_border), (~on_border, is_feature & ~is_border)):
        kept = np.flatnonzero(candidates)
        if own.any() and len(kept):
            ends = result.vertices[edges[own]]
            reach = _NEAR * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
            nearest = NearestEdges(source.vertices, source.edges[kept]).find(ends.mean(axis=1), reach)
            followed[own] = np.where(nearest < 0, -1, kept[nearest])
    edges, followed = edges[followed >= 0], followed[followed >= 0]
    asked = edge_marks.FEATURE | sum(mark for kind, mark in _KINDS.items() if kind in kinds)
    values = source.edge_values
    return edges, EdgeValues(marks[followed] & np.uint16(asked), values.crease[followed], values.bevel[followed])


def mark_cuts(
    mesh: bpy.types.Mesh, task: RemeshTask, source_map: uv_maps.UvMap, correspondence: Correspondence
) -> None:
    """Marks as seams those edges of a result at which its UV map is cut because a seam cuts the source's."""
    source = task.source
    walls = correspondence.walk.wall_edges(uv_maps.walls_of(source_map, correspondence))
    seams = source.edges[(source.marks & edge_marks.SEAM) != 0]
    count = len(source.vertices)
    is_seam = np.isin(edge_keys(walls, count), edge_keys(seams, count))
    if not is_seam.any():
        return
    edges = buffers.read(mesh.edges, "vertices", np.int32, 2)
    quads = Polygons(np.full(len(correspondence.quads), 4, np.int32), correspondence.quads.ravel().astype(np.int32))
    is_cut = EdgeSides(quads, edges, len(mesh.vertices)).where_corners_differ(
        uv_maps.places_of(mesh.uv_layers[source_map.name]), _CUT
    )
    cut = np.flatnonzero(is_cut)
    ends = correspondence.points[edges[cut]]
    reach = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    nearest = NearestEdges(source.vertices, walls).find(ends.mean(axis=1), reach)
    values = buffers.read(mesh.edges, "use_seam", np.bool_)
    values[cut[(nearest >= 0) & is_seam[nearest]]] = True
    buffers.write(mesh.edges, "use_seam", values)
