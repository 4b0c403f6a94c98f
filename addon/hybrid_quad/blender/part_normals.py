"""Custom normals that Blender keeps relative to the faces around: where these change, they are set anew to stay as they are."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np

from ..core.corner_fans import fans_of_corners
from ..core.mesh_arrays import Polygons, unit_vectors
from .transfer import buffers, custom_normals


class CornerNormals(NamedTuple):
    """Normals of face corners.

    Attributes
    ----------
    whole : (C, 3) float64
        Of the whole mesh.
    part : (4 m, 3) float64
        Of the quads.
    sizes : (#F,) int32
        Corners of the whole mesh's faces, before.
    is_new : (C,) bool, or None
        Which of the whole mesh's corners are the quads'.
    """

    whole: Any
    part: Any
    sizes: Any
    is_new: Any = None


def read_normals(mesh: bpy.types.Mesh, part_mesh: bpy.types.Mesh) -> CornerNormals | None:
    """The normals of a mesh and of the quads for it; None where it has none, or such as stay by themselves."""
    whole = custom_normals.read(mesh)
    if whole is None or whole.is_free:
        return None
    own = custom_normals.read(part_mesh)
    sizes = buffers.read(mesh.polygons, "loop_total", np.int32)
    if own is None:  # they are left behind: the quads have those of their faces
        own = whole._replace(values=_smooth_normals(part_mesh))
    return CornerNormals(whole.values, own.values, sizes)


def write_normals(mesh: bpy.types.Mesh, normals: CornerNormals) -> None:
    """Sets the normals of a mesh. Between sharp edges the quads have that of the rest, so that no edge of it gets sharp."""
    polygons = Polygons(
        buffers.read(mesh.polygons, "loop_total", np.int32), buffers.read(mesh.loops, "vertex_index", np.int32)
    )
    is_sharp = buffers.read(mesh.edges, "use_edge_sharp", np.bool_)
    fans = fans_of_corners(polygons, is_sharp[buffers.read(mesh.loops, "edge_index", np.int32)])
    total, count = np.zeros((int(fans.max()) + 1, 3)), np.zeros(int(fans.max()) + 1)
    old = ~normals.is_new
    np.add.at(total, fans[old], normals.whole[old])
    np.add.at(count, fans[old], 1)
    values = normals.whole.copy()
    follows = normals.is_new & (count[fans] > 0)
    values[follows] = total[fans[follows]]
    mesh.normals_split_custom_set(unit_vectors(values).tolist())


def _smooth_normals(mesh: bpy.types.Mesh) -> Any:
    vertex_normals = buffers.read(mesh.vertices, "normal", np.float32, 3).astype(np.float64)
    return vertex_normals[buffers.read(mesh.loops, "vertex_index", np.int32)]
