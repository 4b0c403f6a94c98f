"""Is a quad mesh sound? Answered from its arrays alone, by code that shares nothing with what builds it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .graph_components import component_labels
from .mesh_arrays import FacesLike, FloatArray, as_polygons, as_vertices

IndexArray = npt.NDArray[np.int64]
_SHOWN = 8  # offending elements named in a message


def violations(vertices: npt.ArrayLike, quads: npt.ArrayLike) -> list[str]:
    """What keeps a mesh from being a valid pure-quad mesh; empty for a valid one.

    Checked are: finite coordinates, four different corners a face, no unused vertex, edges in one or two faces that run
    through them in opposite directions, one fan of faces a vertex, three or more faces at an interior vertex, at most
    one common edge of two faces, and quads with an area.

    Parameters
    ----------
    vertices : (n, 3) float
    quads : (m, 4) int

    Returns
    -------
    list of str
        One sentence for each kind of violation, with the first offending elements.
    """
    points = as_vertices(vertices)
    faces = np.asarray(quads)
    if faces.ndim != 2 or faces.shape[1] != 4 or not len(faces):
        return [f"not a list of quads: shape {faces.shape}"]
    faces = faces.astype(np.int64)
    found: list[str] = []
    _note(found, "vertices with a coordinate that is not finite", ~np.isfinite(points).all(axis=1))
    outside = ((faces < 0) | (faces >= len(points))).any(axis=1)
    if outside.any():
        _note(found, "faces with a vertex that does not exist", outside)
        return found
    ordered = np.sort(faces, axis=1)
    repeated = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
    _note(found, "faces that use a vertex twice", repeated)
    unused = np.ones(len(points), bool)
    unused[faces] = False
    _note(found, "vertices without a face", unused)
    if not repeated.any():
        _check_connectivity(found, _Darts.of(faces, len(points)))
    _note(found, "quads without area", _without_area(points, faces))
    return found


@dataclass(frozen=True)
class Topology:
    """What remeshing must keep.

    Attributes
    ----------
    euler : tuple of int
        V - E + F of each connected component, sorted.
    boundary_loops : int
        Closed chains of edges with one face.
    """

    euler: tuple[int, ...]
    boundary_loops: int

    @property
    def components(self) -> int:
        """Number of connected components."""
        return len(self.euler)


def topology(faces: FacesLike) -> Topology:
    """Topology of a polygon mesh; vertices without a face do not count."""
    polygons = as_polygons(faces)
    starts = np.cumsum(polygons.sizes) - polygons.sizes
    used, origin = np.unique(polygons.vertices, return_inverse=True)
    origin = origin.reshape(-1).astype(np.int64)
    following = np.arange(len(origin)) + 1
    last = starts + polygons.sizes - 1
    following[last] = starts
    target = origin[following]
    pairs = np.sort(np.stack([origin, target], axis=1), axis=1)
    edges, count = np.unique(pairs, axis=0, return_counts=True)
    label = component_labels(len(used), edges[:, 0], edges[:, 1])
    roots = np.unique(label)
    euler = (
        np.bincount(np.searchsorted(roots, label), minlength=len(roots))
        - np.bincount(np.searchsorted(roots, label[edges[:, 0]]), minlength=len(roots))
        + np.bincount(np.searchsorted(roots, label[origin[starts]]), minlength=len(roots))
    )
    rim = edges[count == 1]
    rim_label = component_labels(len(used), rim[:, 0], rim[:, 1])
    return Topology(tuple(sorted(int(value) for value in euler)), len(np.unique(rim_label[np.unique(rim)])))


def scaled_jacobian(vertices: npt.ArrayLike, quads: npt.ArrayLike) -> FloatArray:
    """Smallest sine of each quad's corner angles, signed by its normal (Knupp 2000): (m,) in -1..1, 1 for a square."""
    corners = as_vertices(vertices)[np.asarray(quads)]
    edge = np.roll(corners, -1, axis=1) - corners
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(float).tiny)
    length = np.linalg.norm(edge, axis=2)
    sine = np.einsum("qij,qj->qi", np.cross(np.roll(edge, 1, axis=1), edge), normal)
    result: FloatArray = (sine / np.maximum(length * np.roll(length, 1, axis=1), np.finfo(float).tiny)).min(axis=1)
    return result


@dataclass(frozen=True)
class _Darts:
    """Sides of quads: dart 4 q + i runs from corner i to corner i + 1 of quad q."""

    origin: IndexArray
    target: IndexArray
    edge: IndexArray  # undirected edge of each dart
    edge_size: IndexArray  # darts of each edge
    vertex_count: int

    @classmethod
    def of(cls, faces: IndexArray, vertex_count: int) -> _Darts:
        origin = faces.reshape(-1)
        target = np.roll(faces, -1, axis=1).reshape(-1)
        key = np.minimum(origin, target) * vertex_count + np.maximum(origin, target)
        _, edge, size = np.unique(key, return_inverse=True, return_counts=True)
        return cls(origin, target, edge.reshape(-1), size, vertex_count)


def _check_connectivity(found: list[str], darts: _Darts) -> None:
    faces_of_dart = np.arange(len(darts.origin)) // 4
    crowded = darts.edge_size[darts.edge] > 2
    _note_edges(found, "edges with more than two faces", darts, crowded)
    directed = darts.origin * darts.vertex_count + darts.target
    _, inverse, times = np.unique(directed, return_inverse=True, return_counts=True)
    against = (times[inverse.reshape(-1)] > 1) & ~crowded
    _note_edges(found, "edges that two faces run through in the same direction", darts, against)
    if crowded.any() or against.any():
        return  # fans and pairs of faces have no meaning here
    order = np.argsort(darts.edge, kind="stable")
    paired = darts.edge_size[darts.edge[order]] == 2
    first, second = order[paired].reshape(-1, 2).T
    valence = np.bincount(darts.origin, minlength=darts.vertex_count)
    rim = darts.edge_size[darts.edge] == 1
    on_boundary = np.zeros(darts.vertex_count, bool)
    on_boundary[darts.origin[rim]] = True
    on_boundary[darts.target[rim]] = True
    # Corner c sits at the origin of dart c. Across an edge, the corner at each end meets that of the other face.
    label = component_labels(
        len(darts.origin),
        np.concatenate([first, _next(first)]),
        np.concatenate([_next(second), second]),
    )
    is_first_of_fan = label == np.arange(len(label))
    fans = np.bincount(darts.origin[is_first_of_fan], minlength=darts.vertex_count)
    _note(found, "vertices whose faces form more than one fan", fans > 1)
    _note(found, "interior vertices with fewer than three faces", (valence > 0) & (valence < 3) & ~on_boundary)
    here, there = faces_of_dart[first], faces_of_dart[second]
    pairs, times = np.unique(np.minimum(here, there) * len(darts.origin) + np.maximum(here, there), return_counts=True)
    doubled = np.stack(np.divmod(pairs[times > 1], len(darts.origin)), axis=1)
    if len(doubled):
        found.append(f"{len(doubled)} pairs of faces with more than one common edge: {doubled[:_SHOWN].tolist()}")


def _next(darts: IndexArray) -> IndexArray:
    following: IndexArray = (darts & ~np.int64(3)) | ((darts + 1) & 3)
    return following


def _without_area(points: FloatArray, faces: IndexArray) -> npt.NDArray[np.bool_]:
    with np.errstate(invalid="ignore", over="ignore"):
        # To about unit size, by a power of two, so that squares of any size are in range and no digit is lost.
        largest = np.abs(points).max(where=np.isfinite(points), initial=0.0)
        corners = np.ldexp(points, -np.frexp(largest)[1])[faces]
        area = 0.5 * np.linalg.norm(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]), axis=1)
        mean_edge = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).mean()
        flat: npt.NDArray[np.bool_] = area <= 1e-12 * mean_edge**2
    return flat


def _note(found: list[str], what: str, mask: Any) -> None:
    ids = np.flatnonzero(mask)
    if len(ids):
        found.append(f"{len(ids)} {what}: {ids[:_SHOWN].tolist()}{' ...' if len(ids) > _SHOWN else ''}")


def _note_edges(found: list[str], what: str, darts: _Darts, mask: Any) -> None:
    ids = np.flatnonzero(mask)
    if len(ids):
        ends = np.sort(np.stack([darts.origin[ids], darts.target[ids]], axis=1), axis=1)
        edges = np.unique(ends, axis=0)
        found.append(f"{len(edges)} {what}: {edges[:_SHOWN].tolist()}")
