"""Marks on edges: which ones a mesh has, which of them are features, and how they get onto the result."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import numpy.typing as npt
from mathutils.kdtree import KDTree

from ..core.mesh_arrays import FloatArray, IntArray, Polygons

SHARP = 1
SEAM = 2
FEATURE = 4

FEATURE_ATTRIBUTE = "hybrid_quad_feature"

MarkArray = npt.NDArray[np.uint8]


def read(mesh: bpy.types.Mesh) -> MarkArray:
    """Sum of `SHARP`, `SEAM` and `FEATURE` for every edge."""
    marks = np.zeros(len(mesh.edges), np.uint8)
    for mark, property_name in ((SHARP, "use_edge_sharp"), (SEAM, "use_seam")):
        flags = np.empty(len(mesh.edges), np.bool_)
        mesh.edges.foreach_get(property_name, flags)
        marks[flags] |= mark
    attribute = mesh.attributes.get(FEATURE_ATTRIBUTE)
    if attribute is not None and attribute.domain == "EDGE" and attribute.data_type == "BOOLEAN":
        flags = np.empty(len(mesh.edges), np.bool_)
        attribute.data.foreach_get("value", flags)
        marks[flags] |= FEATURE
    return marks


def write(mesh: bpy.types.Mesh, edges: IntArray, marks: MarkArray) -> None:
    """Marks those edges of a mesh that are given as vertex pairs."""
    if not len(edges):
        return
    of_edge = np.zeros(len(mesh.edges), np.uint8)
    of_edge[_indices_of(mesh, edges)] = marks
    for mark, property_name in ((SHARP, "use_edge_sharp"), (SEAM, "use_seam")):
        if (of_edge & mark).any():
            mesh.edges.foreach_set(property_name, (of_edge & mark) != 0)
    if (of_edge & FEATURE).any():
        attribute = mesh.attributes.new(FEATURE_ATTRIBUTE, "BOOLEAN", "EDGE")
        attribute.data.foreach_set("value", (of_edge & FEATURE) != 0)


def add_sharp_by_angle(
    marks: MarkArray, vertices: FloatArray, polygons: Polygons, edges: IntArray, angle: float
) -> MarkArray:
    """`marks`, with `SHARP` added where the normals of an edge's two polygons differ by more than `angle` radians."""
    normals = _polygon_normals(vertices, polygons)
    following = np.arange(1, len(polygons.vertices) + 1)
    ends = np.cumsum(polygons.sizes)
    following[ends - 1] = ends - polygons.sizes
    side_keys = _edge_keys(np.stack([polygons.vertices, polygons.vertices[following]], axis=1), len(vertices))
    side_polygons = np.repeat(np.arange(len(polygons.sizes)), polygons.sizes)
    order = np.argsort(side_keys, kind="stable")
    side_keys, side_polygons = side_keys[order], side_polygons[order]
    first = np.searchsorted(side_keys, _edge_keys(edges, len(vertices)), "left")
    count = np.searchsorted(side_keys, _edge_keys(edges, len(vertices)), "right") - first
    inner = np.flatnonzero(count == 2)
    cosine = np.einsum("ij,ij->i", normals[side_polygons[first[inner]]], normals[side_polygons[first[inner] + 1]])
    result = marks.copy()
    result[inner[cosine < np.cos(angle)]] |= SHARP
    return result


def of_nearest(
    points: FloatArray, vertices: FloatArray, edges: IntArray, marks: MarkArray, spacing: float
) -> MarkArray:
    """For every point, the marks of the nearest of some marked edges.

    Parameters
    ----------
    points : (m, 3) float64
    vertices, edges, marks
        The edges' ends, and what each edge carries.
    spacing : float
        Edges are compared by samples at most this far apart.
    """
    if not len(edges) or not len(points):
        return np.zeros(len(points), np.uint8)
    begin, end = vertices[edges[:, 0]], vertices[edges[:, 1]]
    count = np.maximum(1, np.ceil(np.linalg.norm(end - begin, axis=1) / spacing)).astype(np.int64)
    owner = np.repeat(np.arange(len(edges)), count)
    within = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    share = ((within + 0.5) / count[owner])[:, None]
    samples = (1 - share) * begin[owner] + share * end[owner]
    tree = KDTree(len(samples))
    for index, sample in enumerate(samples):
        tree.insert(sample, index)
    tree.balance()
    return marks[owner[[tree.find(point)[1] for point in points]]]


def _polygon_normals(vertices: FloatArray, polygons: Polygons) -> FloatArray:
    """Unit normals by Newell's rule; zero for a polygon without area."""
    ends = np.cumsum(polygons.sizes)
    following = np.arange(1, len(polygons.vertices) + 1)
    following[ends - 1] = ends - polygons.sizes
    corner = vertices[polygons.vertices]
    first = np.repeat(corner[ends - polygons.sizes], polygons.sizes, axis=0)  # near origin: no cancellation far away
    cross = np.cross(corner - first, corner[following] - first)
    normals = np.add.reduceat(cross, ends - polygons.sizes, axis=0)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)


def _edge_keys(edges: IntArray, vertex_count: int) -> npt.NDArray[np.int64]:
    pairs = np.sort(edges.astype(np.int64), axis=1)
    return pairs[:, 0] * vertex_count + pairs[:, 1]


def _indices_of(mesh: bpy.types.Mesh, edges: IntArray) -> Any:
    own = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", own)
    keys = _edge_keys(own.reshape(-1, 2), len(mesh.vertices))
    order = np.argsort(keys)
    return order[np.searchsorted(keys[order], _edge_keys(edges, len(mesh.vertices)))]
