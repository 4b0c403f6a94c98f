"""Meshes of other packages to and from arrays: trimesh and meshio, neither of which is needed here."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .mesh_arrays import FloatArray, Polygons, as_polygons, as_vertices


def mesh_arrays(mesh: Any) -> tuple[FloatArray, Polygons]:
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
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return as_vertices(mesh.vertices), as_polygons(np.asarray(mesh.faces))
    if hasattr(mesh, "points") and hasattr(mesh, "cells"):
        return as_vertices(_in_space(np.asarray(mesh.points, np.float64))), _polygons_of_cells(mesh.cells)
    raise TypeError(f"{type(mesh).__name__} has neither vertices and faces nor points and cells")


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
