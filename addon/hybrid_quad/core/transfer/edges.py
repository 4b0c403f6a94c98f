"""Marks on edges: those of a result that follow features of the source get the marks that these have."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from ..edge_borders import EdgeSides, edge_keys, uses_of_edges
from ..edge_mark_values import SEAM, SHARP
from ..mesh_arrays import FloatArray, IntArray, Polygons
from ..surface_places import Indices
from .correspondence import Correspondence
from .layers import Layer, walls_of
from .nearest import NearestEdges

# An edge that is farther from all kept edges than this share of its length was made for something else.
_NEAR = 0.5
_CUT = 1e-5  # distance in a UV map from which on it is cut


MarkArray = npt.NDArray[np.uint16]


class EdgeValues(NamedTuple):
    """What the edges of a mesh carry.

    Attributes
    ----------
    marks : MarkArray
        (k,) sum of the marks of each edge.
    crease, bevel : (k,) float32
        Weights, 0..1.
    """

    marks: MarkArray
    crease: npt.NDArray[np.float32]
    bevel: npt.NDArray[np.float32]


class SourceEdges(NamedTuple):
    """The edges of a source, and what of them a result takes along.

    Attributes
    ----------
    polygons : Polygons
    edges : (k, 2) int32
    values : EdgeValues
    feature_marks : int
        Sum of the marks that make an edge a feature.
    taken_marks : int
        Sum of the marks that are taken along.
    sharp_angle : float or None
        Degrees from which on an edge is sharp without a mark.
    """

    polygons: Polygons
    edges: IntArray
    values: EdgeValues
    feature_marks: int
    taken_marks: int
    sharp_angle: float | None


def marks_on_result(
    source: SourceEdges, correspondence: Correspondence, feature_edges: IntArray
) -> tuple[IntArray, EdgeValues]:
    """Edges of the result along features and the boundary, and all that the edges that they follow carry.

    Parameters
    ----------
    feature_edges : (j, 2) int32
        Vertex pairs.

    Returns
    -------
    edges : (i, 2) int32
        Those that follow one.
    values : EdgeValues
    """
    own_marks, points = source.values.marks, correspondence.source.points
    marks = own_marks
    if source.sharp_angle is not None:
        angle = math.radians(source.sharp_angle)
        marks = add_sharp_by_angle(own_marks, points, source.polygons, source.edges, angle)
    is_feature = ((own_marks & source.feature_marks) != 0) | (marks != own_marks)
    is_border = uses_of_edges(source.edges, source.polygons, len(points)) == 1
    edges = feature_edges
    on_border = uses_of_edges(edges, _polygons_of(correspondence), len(correspondence.points)) == 1
    followed = np.full(len(edges), -1, np.int64)
    for own, candidates in ((on_border, is_border), (~on_border, is_feature & ~is_border)):
        kept = np.flatnonzero(candidates)
        if own.any() and len(kept):
            nearest = _nearest_within(correspondence, edges[own], points, source.edges[kept], _NEAR)
            followed[own] = np.where(nearest < 0, -1, kept[nearest])
    edges, followed = edges[followed >= 0], followed[followed >= 0]
    crease, bevel = source.values.crease[followed], source.values.bevel[followed]
    return edges, EdgeValues(marks[followed] & np.uint16(source.taken_marks), crease, bevel)


def seams_on_result(source: SourceEdges, source_map: Layer, values: Any, correspondence: Correspondence) -> IntArray:
    """(k, 2) edges of a result at which its UV map is cut because a seam cuts the source's.

    Parameters
    ----------
    source_map : Layer
    values : (4 m, 2) float
        The same map on the result.
    """
    points = correspondence.source.points
    walls = correspondence.walk.wall_edges(walls_of(source_map, correspondence)).astype(np.int32)
    seams = source.edges[(source.values.marks & SEAM) != 0]
    is_seam = np.isin(edge_keys(walls, len(points)), edge_keys(seams, len(points)))
    if not is_seam.any():
        return np.zeros((0, 2), np.int32)
    edges = edges_of(correspondence.quads)
    sides = EdgeSides(_polygons_of(correspondence), edges, len(correspondence.points))
    cut = edges[sides.where_corners_differ(values, _CUT)]
    nearest = _nearest_within(correspondence, cut, points, walls, 1.0)
    return cut[(nearest >= 0) & is_seam[nearest]]


def add_sharp_by_angle(
    marks: MarkArray, vertices: FloatArray, polygons: Polygons, edges: IntArray, angle: float
) -> MarkArray:
    """`marks`, with `SHARP` added where the normals of an edge's two polygons differ by more than `angle` radians."""
    result: MarkArray = marks.copy()
    result[EdgeSides(polygons, edges, len(vertices)).where_faces_bend(vertices, angle)] |= SHARP
    return result


def edges_of(quads: Indices) -> IntArray:
    """(k, 2) int32 the edges of some quads, as vertex pairs with the smaller first, in order."""
    pairs = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    return np.unique(pairs, axis=0).astype(np.int32)


def _polygons_of(correspondence: Correspondence) -> Polygons:
    quads = correspondence.quads
    return Polygons(np.full(len(quads), 4, np.int32), quads.ravel().astype(np.int32))


def _nearest_within(
    correspondence: Correspondence, edges: IntArray, points: FloatArray, candidates: IntArray, reach: float
) -> Indices:
    """(k,) for each of some edges of the result the candidate nearest to its middle, within a share of its length; or -1."""
    ends = correspondence.points[edges]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    return NearestEdges(points, candidates).find(ends.mean(axis=1), reach * length)
