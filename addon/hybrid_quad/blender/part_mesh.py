"""The quads of a part, put into a copy of the mesh that they are part of; the rest of it keeps every bit of its data."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any, NamedTuple

import bmesh
import bpy
import numpy as np

from ..core.edge_borders import edge_keys
from ..core.errors import InternalError
from ..core.part_weld import PartResult
from .part_layers import copy_layers
from .part_normals import CornerNormals, read_normals, write_normals
from .transfer import buffers


class NewElements(NamedTuple):
    """Which elements of a mesh are new, and which elements of the part's own mesh they are made of.

    Attributes
    ----------
    vertices, edges, faces, corners : (k,) int64
        Of the whole mesh.
    own_vertices, own_edges, own_faces, own_corners : (k,) int64
        Of the part's mesh.
    """

    vertices: Any
    edges: Any
    faces: Any
    corners: Any
    own_vertices: Any
    own_edges: Any
    own_faces: Any
    own_corners: Any


def joined_mesh(source: bpy.types.Object, part_mesh: bpy.types.Mesh, result: PartResult) -> bpy.types.Mesh:
    """A copy of an object's mesh with quads in the place of some of its faces.

    Parameters
    ----------
    part_mesh : Mesh
        The quads alone with all that they carry, in the order of `result`.

    Raises
    ------
    InternalError
        If the mesh is not the one that was read, or Blender refuses the new one.
    """
    mesh = source.data.copy()
    mesh.name = source.data.name
    holder = bpy.data.objects.new(mesh.name, mesh)  # vertex groups are reached through an object only
    try:
        if len(mesh.polygons) != len(result.part):
            raise InternalError("the mesh is not the one that was read", "validation")
        normals = read_normals(mesh, part_mesh)
        new = _exchange(mesh, part_mesh, result)
        copy_layers(holder, part_mesh, new)
        if normals is not None:
            write_normals(mesh, _normals_of_new_mesh(normals, mesh, result, new))
        if mesh.validate(clean_customdata=False):
            raise InternalError("Blender found the resulting mesh invalid", "validation")
        mesh.update()
    except BaseException:
        bpy.data.objects.remove(holder)
        bpy.data.meshes.remove(mesh)
        raise
    bpy.data.objects.remove(holder)
    return mesh


def _exchange(mesh: bpy.types.Mesh, part_mesh: bpy.types.Mesh, result: PartResult) -> NewElements:
    """Removes the part's faces, and puts the quads in; what is new comes last in every order."""
    quads = buffers.read(part_mesh.loops, "vertex_index", np.int32).reshape(-1, 4)
    places = buffers.read(part_mesh.vertices, "co", np.float32, 3)
    is_new = result.whole_vertices < 0
    kept = _kept_vertices(mesh, result.part)
    are_selected = bool(buffers.read(mesh.polygons, "select", np.bool_)[result.part].all())
    with _edited(mesh) as edited:
        edited.faces.ensure_lookup_table()
        faces = [edited.faces[index] for index in np.flatnonzero(result.part).tolist()]
        bmesh.ops.delete(edited, geom=faces, context="FACES")
    counts = len(mesh.vertices), len(mesh.edges), len(mesh.polygons)
    if counts[0] != int(kept.sum()) or not kept[result.whole_vertices[~is_new]].all():
        raise InternalError("other vertices went with the faces than should", "validation")
    number = np.where(is_new, counts[0] - 1 + np.cumsum(is_new), (np.cumsum(kept) - 1)[result.whole_vertices])
    # In a bmesh made anew, as in one with gaps new elements would come to lie between old ones.
    with _edited(mesh) as edited:
        for place in places[is_new].tolist():
            edited.verts.new(place)
        edited.verts.ensure_lookup_table()
        for quad in number[quads].tolist():
            edited.faces.new([edited.verts[vertex] for vertex in quad]).select_set(are_selected)
    found = buffers.read(mesh.loops, "vertex_index", np.int32)[-quads.size :]
    if not np.array_equal(found, number[quads].ravel()):
        raise InternalError("Blender put the quads elsewhere", "validation")
    return _new_elements(mesh, part_mesh, number, is_new, counts[1], counts[2])


@contextlib.contextmanager
def _edited(mesh: bpy.types.Mesh) -> Iterator[bmesh.types.BMesh]:
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        yield edited
        edited.to_mesh(mesh)
    finally:
        edited.free()


def _kept_vertices(mesh: bpy.types.Mesh, part: Any) -> Any:
    """(n,) bool: those that other faces or loose edges have, or nothing has."""
    vertices = buffers.read(mesh.loops, "vertex_index", np.int32)
    of_part = np.repeat(part, buffers.read(mesh.polygons, "loop_total", np.int32))
    edges = buffers.read(mesh.edges, "vertices", np.int32, 2)
    is_loose = np.ones(len(edges), np.bool_)
    is_loose[buffers.read(mesh.loops, "edge_index", np.int32)] = False
    kept = np.ones(len(mesh.vertices), np.bool_)
    kept[vertices[of_part]] = False
    kept[vertices[~of_part]] = True
    kept[edges[is_loose]] = True
    return kept


def _new_elements(
    mesh: bpy.types.Mesh, part_mesh: bpy.types.Mesh, number: Any, is_new: Any, kept_edges: int, kept_faces: int
) -> NewElements:
    own_edges = number[buffers.read(part_mesh.edges, "vertices", np.int32, 2)]
    edges = buffers.read(mesh.edges, "vertices", np.int32, 2)[kept_edges:]
    keys, own_keys = (edge_keys(pairs, len(mesh.vertices)) for pairs in (edges, own_edges))
    order = np.argsort(own_keys)
    starts = buffers.read(mesh.polygons, "loop_start", np.int32).astype(np.int64)[kept_faces:]
    count = len(starts)
    return NewElements(
        vertices=number[is_new],
        edges=kept_edges + np.arange(len(edges)),
        faces=kept_faces + np.arange(count),
        corners=(starts[:, None] + np.arange(4)).ravel(),
        own_vertices=np.flatnonzero(is_new),
        own_edges=order[np.searchsorted(own_keys[order], keys)],
        own_faces=np.arange(count),
        own_corners=np.arange(4 * count),
    )


def _normals_of_new_mesh(
    normals: CornerNormals, mesh: bpy.types.Mesh, result: PartResult, new: NewElements
) -> CornerNormals:
    """Those of the rest's corners as they were, and the part's; in the order of the new mesh."""
    values = np.zeros((len(mesh.loops), 3))
    is_new = np.zeros(len(mesh.loops), np.bool_)
    is_new[new.corners] = True
    values[~is_new] = normals.whole[np.repeat(~result.part, normals.sizes)]
    values[is_new] = normals.part
    return normals._replace(whole=values, is_new=is_new)
