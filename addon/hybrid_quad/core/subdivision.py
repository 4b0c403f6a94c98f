"""Subdivision surfaces by Catmull and Clark's rules, with OpenSubdiv."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from . import native
from .errors import InputError
from .mesh_arrays import FacesLike, FloatArray, IntArray, as_edges, as_polygons, as_reals, as_vertices
from .mesh_objects import MeshLike, vertices_and_faces
from .options import usable_threads

INFINITELY_SHARP = 10.0
MOST_LEVELS = 8


@dataclass(frozen=True, eq=False)
class Subdivided:
    """A subdivided mesh.

    Attributes
    ----------
    vertices : (n, 3) float64
        Positions; the first are those of the given vertices, in their order, where the mesh has no vertex without a face.
    normals : (n, 3) float64
        Unit normals of the limit surface; (0, 3) where limit positions were not asked for.
    quads : (m, 4) int32
        0-based vertices of each quad, oriented as the faces.
    faces : (m,) int32
        The given face that each quad is part of.
    """

    vertices: FloatArray
    normals: FloatArray
    quads: IntArray
    faces: IntArray


def subdivide(
    vertices: npt.ArrayLike | MeshLike,
    faces: FacesLike | None = None,
    *,
    levels: int = 2,
    limit: bool = True,
    crease_edges: npt.ArrayLike | Iterable[Sequence[int]] | None = None,
    crease_sharpness: npt.ArrayLike = INFINITELY_SHARP,
    sharp_vertices: npt.ArrayLike | None = None,
    vertex_sharpness: npt.ArrayLike = INFINITELY_SHARP,
    keep_corners: bool = False,
) -> Subdivided:
    """Subdivides a mesh by Catmull and Clark's rules.

    Parameters
    ----------
    vertices : (n, 3) float, or a mesh
        Positions; without `faces`, a mesh of trimesh, meshio or alike, see :func:`mesh_arrays`.
    faces : (m, k) int, or a sequence of sequences of int
        0-based vertices of each polygon.
    levels : int
        1 to 8; each makes four faces of a quad.
    limit : bool
        Put the vertices where endless subdivision would, on the limit surface, rather than where `levels` steps do. Creases
        that are neither infinitely sharp nor worn off after so many levels count as they are then.
    crease_edges : (k, 2) int, optional
        Pairs of vertices, each an edge of a face, that stay sharp.
    crease_sharpness : float or (k,) float
        For how many levels each does; 10 and more: for ever. Blender's crease c (0 to 1) is 10 c squared.
    sharp_vertices : (j,) int, optional
        Vertices that stay sharp.
    vertex_sharpness : float or (j,) float
        Likewise.
    keep_corners : bool
        Keep boundary vertices of a single face where they are; the boundary's curve rounds them off otherwise.

    Returns
    -------
    Subdivided

    Raises
    ------
    InputError
        If there are no faces (``empty_mesh``), a face has fewer than three corners or a vertex that is not there
        (``malformed_faces``, ``index_out_of_range``), or a crease is no edge of a face (``unknown_edge``).
    InternalError
        If OpenSubdiv refuses the mesh.
    ValueError, TypeError
        If `levels` is out of range, or an array has the wrong shape or type.
    """
    if not 1 <= levels <= MOST_LEVELS:
        raise ValueError(f"levels must be 1 to {MOST_LEVELS}")
    positions, corners = vertices_and_faces(vertices, faces)
    points, polygons, creases = as_vertices(positions), as_polygons(corners), as_edges(crease_edges)
    if not len(polygons.sizes):
        raise InputError("empty_mesh", "The mesh has no faces.")
    sharp = np.zeros(0, np.int32) if sharp_vertices is None else np.asarray(sharp_vertices, np.int32)
    if sharp.ndim != 1:
        raise ValueError("sharp_vertices must be one-dimensional")
    found = native.load().subdivide(
        points,
        polygons.sizes,
        polygons.vertices,
        levels=int(levels),
        limit=limit,
        keep_corners=keep_corners,
        crease_edges=creases,
        crease_sharpness=_one_each(crease_sharpness, len(creases), "crease_sharpness"),
        sharp_vertices=sharp,
        vertex_sharpness=_one_each(vertex_sharpness, len(sharp), "vertex_sharpness"),
    )
    return Subdivided(**found)


def surface_distances(
    points: npt.ArrayLike, vertices: npt.ArrayLike, faces: FacesLike, *, threads: int = 0
) -> FloatArray:
    """How far points are from a surface.

    Parameters
    ----------
    points : (k, 3) float
    vertices : (n, 3) float
    faces : (m, k) int, or a sequence of sequences of int
        0-based vertices of each polygon; repaired as for a run.
    threads : int
        0: all that this process may use.

    Returns
    -------
    (k,) float64
        Distances, in the units of the points.

    Raises
    ------
    InputError
        If the faces are no surface.
    ValueError, TypeError
        If a point is not finite, or an array has the wrong shape or type.
    """
    polygons, places = as_polygons(faces), as_vertices(points)
    if not (finite := np.isfinite(places).all(axis=1)).all():
        raise ValueError(f"points must be finite, and row {int(finite.argmin())} is not")
    found: FloatArray = native.load().distances(
        places,
        as_vertices(vertices),
        polygons.sizes,
        polygons.vertices,
        threads=threads or usable_threads(),
    )
    return found


def _one_each(value: npt.ArrayLike, count: int, name: str) -> FloatArray:
    values = as_reals(value, name)
    if values.ndim and values.shape != (count,):
        raise ValueError(f"{name} must be one number, or {count}")
    if not (values >= 0).all():
        raise ValueError(f"{name} must not be negative")
    each: FloatArray = np.ascontiguousarray(np.broadcast_to(values, (count,)))
    return each
