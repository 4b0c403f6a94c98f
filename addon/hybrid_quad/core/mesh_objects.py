"""Meshes of other packages to and from arrays: trimesh and meshio, neither of which is needed here."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol, cast

import numpy as np
import numpy.typing as npt

from .mesh_arrays import FacesLike, FloatArray, IntArray, Polygons, as_polygons, as_vertices

if TYPE_CHECKING:
    import meshio
    import trimesh


class MeshOfFaces(Protocol):
    """Anything with vertices and faces, as ``trimesh.Trimesh``."""

    @property
    def vertices(self) -> Any: ...

    @property
    def faces(self) -> Any: ...


class MeshOfCells(Protocol):
    """Anything with points and blocks of cells, as ``meshio.Mesh``."""

    @property
    def points(self) -> Any: ...

    @property
    def cells(self) -> Any: ...


MeshLike = MeshOfFaces | MeshOfCells


def mesh_arrays(mesh: MeshLike) -> tuple[FloatArray, Polygons]:
    """Vertices and faces of a mesh of another package, as :func:`hybrid_quad.remesh` takes them.

    Parameters
    ----------
    mesh : trimesh.Trimesh, meshio.Mesh or alike
        Has ``vertices`` and ``faces``, or ``points`` and ``cells`` of triangles, quads and polygons (lines and points among
        them are left out).

    Returns
    -------
    vertices : (n, 3) float64
    faces : Polygons

    Raises
    ------
    TypeError
        If it has neither.
    ValueError
        If its cells are volumes or curved, which are no polygons of their vertices.
    """
    found: Any = mesh
    if hasattr(found, "vertices") and hasattr(found, "faces"):
        return as_vertices(found.vertices), as_polygons(np.asarray(found.faces))
    if hasattr(found, "points") and hasattr(found, "cells"):
        return as_vertices(_in_space(np.asarray(found.points, np.float64))), _polygons_of_cells(found.cells)
    raise TypeError(f"{type(mesh).__name__} has neither vertices and faces nor points and cells")


def vertices_and_faces(vertices: npt.ArrayLike | MeshLike, faces: FacesLike | None) -> tuple[npt.ArrayLike, FacesLike]:
    """The two as they are, or, without faces, those of the mesh that is given in the vertices' place.

    Raises
    ------
    TypeError, ValueError
        As :func:`mesh_arrays` does.
    """
    if faces is None:
        if isinstance(vertices, (np.ndarray, list, tuple)):
            raise TypeError("faces are missing: give vertices and faces, or a mesh of trimesh, meshio or alike alone")
        return mesh_arrays(cast(MeshLike, vertices))
    return cast(npt.ArrayLike, vertices), faces


def meshio_of_quads(vertices: FloatArray, quads: IntArray) -> meshio.Mesh:
    """A ``meshio.Mesh`` with one block of quads; needs meshio."""
    import meshio

    return meshio.Mesh(vertices, [("quad", quads)])


def trimesh_of_quads(vertices: FloatArray, quads: IntArray) -> trimesh.Trimesh:
    """A ``trimesh.Trimesh`` with the vertices in their order and each quad split in two; needs trimesh."""
    import trimesh

    return trimesh.Trimesh(vertices, quads, process=False)


def _in_space(points: FloatArray) -> FloatArray:
    """Points with a third coordinate, which plane meshes of meshio may lack."""
    if points.ndim == 2 and points.shape[1] == 2:
        return np.concatenate([points, np.zeros((len(points), 1))], axis=1)
    return points


def _polygons_of_cells(cells: Any) -> Polygons:
    parts = []
    for block in cells:
        if block.type in ("triangle", "quad") or block.type.startswith("polygon"):
            parts.append(as_polygons(_rows(block.data)))
        elif block.type not in ("line", "vertex"):
            raise ValueError(f"cells of type {block.type} are no polygons of a surface")
    if not parts:
        return as_polygons([])
    return Polygons(np.concatenate([part.sizes for part in parts]), np.concatenate([part.vertices for part in parts]))


def _rows(data: Any) -> npt.NDArray[Any] | list[Any]:
    """Rows of one length as an array, polygons of several as a list."""
    lengths = {len(row) for row in data}
    return np.asarray(data) if len(lengths) == 1 else list(data)
