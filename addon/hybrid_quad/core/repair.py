"""The mesh that a run works with: a surface, whatever was given."""

from __future__ import annotations

from dataclasses import dataclass

import numpy.typing as npt

from . import native
from .check import Defect
from .mesh_arrays import FacesLike, FloatArray, IntArray, as_polygons, as_vertices
from .mesh_objects import MeshLike, vertices_and_faces


@dataclass(frozen=True, eq=False)
class Repaired:
    """A triangle mesh that is a surface.

    Attributes
    ----------
    vertices : (n, 3) float64
    triangles : (m, 3) int32
    vertex_origins : (n,) int32
        The given vertex that each was; -1 for one in the middle of an edge, where sheets that were cut apart had the whole
        edge in common and each needs one of its own.
    face_origins : (m,) int32
        The given face that each is part of.
    defects : list of Defect
        What was found on the way, and repaired unless `kept`.
    """

    vertices: FloatArray
    triangles: IntArray
    vertex_origins: IntArray
    face_origins: IntArray
    defects: list[Defect]


def repair(vertices: npt.ArrayLike | MeshLike, faces: FacesLike | None = None) -> Repaired:
    """Repairs a mesh as :func:`hybrid_quad.remesh` does before anything else.

    Parameters
    ----------
    vertices : (n, 3) float, or a mesh
        Positions; without `faces`, a mesh of trimesh, meshio or alike, see :func:`mesh_arrays`.
    faces : (m, k) int, or a sequence of sequences of int
        0-based vertices of each polygon.

    Returns
    -------
    Repaired
        A manifold, oriented mesh of triangles with area, but for those that `defects` has as kept. Vertices without a face
        are not in it.

    Raises
    ------
    InputError
        If the faces are no surface that can be repaired; names the elements.
    """
    positions, corners = vertices_and_faces(vertices, faces)
    polygons = as_polygons(corners)
    found = native.load().repair(as_vertices(positions), polygons.sizes, polygons.vertices)
    found["defects"] = [Defect.from_native(row) for row in found["defects"]]
    return Repaired(**found)
