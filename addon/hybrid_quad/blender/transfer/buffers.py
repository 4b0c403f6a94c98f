"""Blender's collections as arrays."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ...core.mesh_arrays import FloatArray
from ...core.surface_places import TriangleMesh


def read(collection: Any, name: str, dtype: Any, width: int = 1) -> Any:
    """(k,) or (k, width) values of one property of all items."""
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(name, values)
    return values if width == 1 else values.reshape(-1, width)


def write(collection: Any, name: str, values: Any) -> None:
    """Sets one property of all items."""
    collection.foreach_set(name, np.ascontiguousarray(values).ravel())


def triangles_of(mesh: bpy.types.Mesh, linear: FloatArray) -> TriangleMesh:
    """A mesh's triangles as Blender makes them, its points taken to another space by `linear` (3, 3)."""
    mesh.calc_loop_triangles()
    return TriangleMesh(
        points=read(mesh.vertices, "co", np.float32, 3).astype(np.float64) @ linear.T,
        vertices=read(mesh.loop_triangles, "vertices", np.int32, 3).astype(np.int64),
        corners=read(mesh.loop_triangles, "loops", np.int32, 3).astype(np.int64),
        polygons=read(mesh.loop_triangles, "polygon_index", np.int32).astype(np.int64),
    )
