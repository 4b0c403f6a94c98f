"""Where a result's features are: kept in hidden attributes of its mesh, so that they survive edits."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
import numpy.typing as npt

from ..core.mesh_arrays import FloatArray, IntArray
from . import edge_marks

EDGES = ".hybrid_quad_features"
CORNERS = ".hybrid_quad_corners"
_INFINITE = 10.0  # OpenSubdiv's sharpness that never wears off

Flags = npt.NDArray[np.bool_]


def write(mesh: bpy.types.Mesh, edges: IntArray, corners: npt.NDArray[np.int64]) -> None:
    """Remembers feature edges, given as vertex pairs, and corners."""
    flags = np.zeros(len(mesh.edges), np.bool_)
    flags[edge_marks.indices_of(mesh, edges)] = True
    _store(mesh, EDGES, "EDGE", flags)
    flags = np.zeros(len(mesh.vertices), np.bool_)
    flags[corners] = True
    _store(mesh, CORNERS, "POINT", flags)


def features_of(mesh: bpy.types.Mesh) -> tuple[IntArray, npt.NDArray[np.int64]]:
    """Vertex pairs of a mesh's feature edges, and its corners.

    Of a mesh that is no result: edges marked as sharp or with a crease, and vertices with a crease.
    """
    edges = _edges_of(mesh)
    flags = _read(mesh, EDGES, "EDGE")
    if flags is None:
        flags = edge_marks.hard_edges(mesh)
    corners = _read(mesh, CORNERS, "POINT")
    if corners is None:
        weights = edge_marks.VERTEX_CREASE.read(mesh)
        corners = np.zeros(len(mesh.vertices), np.bool_) if weights is None else weights > 0
    return edges[flags], np.flatnonzero(corners)


def creases_of(mesh: bpy.types.Mesh) -> tuple[tuple[IntArray, FloatArray], tuple[IntArray, FloatArray]]:
    """Feature edges and corners, each with its sharpness for OpenSubdiv: all are sharp for ever."""
    edges, corners = features_of(mesh)
    return (edges, np.full(len(edges), _INFINITE)), (corners.astype(np.int32), np.full(len(corners), _INFINITE))


def _store(mesh: bpy.types.Mesh, name: str, domain: str, flags: Flags) -> None:
    attribute = mesh.attributes.get(name) or mesh.attributes.new(name, "BOOLEAN", domain)
    attribute.data.foreach_set("value", flags)


def _read(mesh: bpy.types.Mesh, name: str, domain: str) -> Flags | None:
    attribute: Any = mesh.attributes.get(name)
    if attribute is None or (attribute.domain, attribute.data_type) != (domain, "BOOLEAN"):
        return None
    flags = np.empty(len(attribute.data), np.bool_)
    attribute.data.foreach_get("value", flags)
    return flags


def _edges_of(mesh: bpy.types.Mesh) -> IntArray:
    edges = np.empty(2 * len(mesh.edges), np.int32)
    mesh.edges.foreach_get("vertices", edges)
    pairs: IntArray = edges.reshape(-1, 2)
    return pairs
