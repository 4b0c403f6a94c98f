"""Checked conversion between what callers pass as a mesh and the flat arrays that the compiled module takes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .errors import InputError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int32]


class Polygons(NamedTuple):
    """Polygons of any size, one after the other.

    Attributes
    ----------
    sizes : (#F,) int32
        Corners of each polygon.
    vertices : (sum of sizes,) int32
        0-based vertices of their corners.
    """

    sizes: IntArray
    vertices: IntArray


FacesLike = Polygons | npt.ArrayLike | Sequence[Sequence[int]]


def as_vertices(vertices: npt.ArrayLike) -> FloatArray:
    """`vertices` as a contiguous (n, 3) float64 array."""
    array = as_reals(vertices, "vertices")
    if array.size == 0:
        return array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"vertices must be an (n, 3) array, not one of shape {array.shape}")
    return array


def as_reals(values: npt.ArrayLike, name: str) -> FloatArray:
    """`values` as a contiguous float64 array of any shape; TypeError for complex numbers, which would lose a part."""
    array = np.asarray(values)
    if array.dtype.kind == "c":
        raise TypeError(f"{name} must be real numbers, not {array.dtype}")
    return np.asarray(array, dtype=np.float64, order="C")


def as_polygons(faces: FacesLike) -> Polygons:
    """`faces` in flat form.

    Parameters
    ----------
    faces : Polygons, (m, k) integers, or a sequence of sequences of integers
        0-based vertices of each face.
    """
    if isinstance(faces, Polygons):
        return Polygons(_as_indices(faces.sizes, "face sizes"), _as_indices(faces.vertices, "faces"))
    if not isinstance(faces, np.ndarray):
        rows = _rows(faces, "faces must be an (m, k) array or a list of lists of vertices")
        sizes = np.fromiter((len(row) for row in rows), dtype=np.int32, count=len(rows))
        return Polygons(sizes, _as_indices(list(chain.from_iterable(rows)), "faces"))
    if faces.size == 0:
        return Polygons(np.zeros(0, np.int32), np.zeros(0, np.int32))
    if faces.ndim != 2:
        raise ValueError(f"faces must be an (m, k) array or a list of lists, not an array of shape {faces.shape}")
    sizes = np.full(faces.shape[0], faces.shape[1], dtype=np.int32)
    return Polygons(sizes, _as_indices(faces.reshape(-1), "faces"))


def as_edges(edges: npt.ArrayLike | Iterable[Sequence[int]] | None) -> IntArray:
    """Vertex pairs as a (k, 2) int32 array; none for ``None``."""
    if edges is None:
        return np.zeros((0, 2), np.int32)
    if not isinstance(edges, np.ndarray):
        edges = [tuple(edge) for edge in _rows(edges, "sharp_edges must be a (k, 2) array or a list of vertex pairs")]
    array = np.asarray(edges)
    if array.size == 0:
        return np.zeros((0, 2), np.int32)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ValueError(f"sharp_edges must be a (k, 2) array of vertex pairs, not one of shape {array.shape}")
    return _as_indices(array, "sharp_edges")


def require_indices(polygons: Polygons, vertex_count: int) -> None:
    """Raises InputError ``"index_out_of_range"`` where a polygon has a vertex that does not exist; names all."""
    outside = (polygons.vertices < 0) | (polygons.vertices >= vertex_count)
    if outside.any():
        faces = np.unique(np.repeat(np.arange(len(polygons.sizes)), polygons.sizes)[outside])
        raise InputError("index_out_of_range", "Faces use vertices that do not exist.", "face", faces.tolist())


def require_edges(edges: IntArray, polygons: Polygons, vertex_count: int) -> None:
    """Raises InputError ``"unknown_edge"`` where a vertex pair is not an edge of a polygon; names all such pairs."""
    unknown = edges_without_face(edges, polygons, vertex_count)
    if len(unknown):
        raise InputError(
            "unknown_edge",
            f"{len(unknown)} of the marked vertex pairs are no edge of any face.",
            "edge",
            unknown.reshape(-1).tolist(),
        )


def edges_without_face(edges: IntArray, polygons: Polygons, vertex_count: int) -> IntArray:
    """Those of some vertex pairs that are no edge of any polygon."""
    if not len(edges):
        return edges
    following = np.arange(1, len(polygons.vertices) + 1)
    filled = polygons.sizes > 0
    ends = np.cumsum(polygons.sizes)[filled]
    following[ends - 1] = ends - polygons.sizes[filled]
    sides = np.stack([polygons.vertices, polygons.vertices[following]], axis=1)
    known = np.isin(_edge_keys(edges, vertex_count), _edge_keys(sides, vertex_count))
    unknown: IntArray = edges[~known | ((edges < 0) | (edges >= vertex_count)).any(axis=1)]
    return unknown


def surface_area(vertices: FloatArray, polygons: Polygons) -> float:
    """Sum of the lengths of the polygons' area vectors; those with a vertex that does not exist count nothing."""
    filled = polygons.sizes > 0
    if not len(vertices) or not filled.any():
        return 0.0
    exists = (polygons.vertices >= 0) & (polygons.vertices < len(vertices))
    corners = vertices[np.where(exists, polygons.vertices, 0)]
    starts = (np.cumsum(polygons.sizes) - polygons.sizes)[filled]
    following = np.arange(1, len(corners) + 1)
    following[starts + polygons.sizes[filled] - 1] = starts
    # From each polygon's first corner, so that a place far from the origin costs no digits.
    first = np.repeat(corners[starts], polygons.sizes[filled], axis=0)
    with np.errstate(invalid="ignore", over="ignore"):
        vectors = np.add.reduceat(np.cross(corners - first, corners[following] - first), starts, axis=0)
        areas = 0.5 * np.linalg.norm(vectors, axis=1)
    sound = np.logical_and.reduceat(exists, starts) & np.isfinite(areas)
    return float(areas[sound].sum())


def unit_vectors(vectors: FloatArray) -> FloatArray:
    """(k, 3) vectors of length 1; zero where they are zero."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    units: FloatArray = np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)
    return units


def _rows(values: Any, message: str) -> list[Any]:
    rows = list(values)
    if not all(hasattr(row, "__len__") for row in rows):
        raise ValueError(f"{message}, not a flat list")
    return rows


def _edge_keys(edges: IntArray, vertex_count: int) -> npt.NDArray[np.int64]:
    ordered = np.sort(edges.astype(np.int64), axis=1)
    keys: npt.NDArray[np.int64] = ordered[:, 0] * vertex_count + ordered[:, 1]
    return keys


def _as_indices(values: npt.ArrayLike, name: str) -> IntArray:
    array = np.asarray(values)
    if array.size == 0:
        return np.zeros(array.shape, np.int32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} must be integers, not {array.dtype}")
    limits = np.iinfo(np.int32)
    if array.min() < limits.min or array.max() > limits.max:
        raise InputError("index_out_of_range", f"{name} hold an index that no mesh of this size has.")
    return np.ascontiguousarray(array, dtype=np.int32)


def clipped_to_int32(values: Sequence[int]) -> IntArray:
    """(n,) `values`, those beyond the range of int32, and so of any mesh, at its ends."""
    limits = np.iinfo(np.int32)
    low, high = int(limits.min), int(limits.max)
    try:
        return np.clip(np.array(values, dtype=np.int64), low, high).astype(np.int32)
    except OverflowError:
        return np.array([min(max(value, low), high) for value in values], np.int32)
