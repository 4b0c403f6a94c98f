"""The quads of a part, put into a copy of the mesh that they are part of; the rest of it keeps every bit of its data."""

from __future__ import annotations

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

_NEW = 1 << 30  # indices of new elements begin here until they are sorted in behind the old ones


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
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        for sequence in (edited.verts, edited.edges, edited.faces):
            sequence.index_update()
            sequence.ensure_lookup_table()
        on_border = {index: edited.verts[index] for index in np.unique(result.whole_vertices[~is_new]).tolist()}
        faces = [edited.faces[index] for index in np.flatnonzero(result.part).tolist()]
        bmesh.ops.delete(edited, geom=faces, context="FACES")
        if not all(vertex.is_valid for vertex in on_border.values()):
            raise InternalError("the border went with the faces", "validation")
        vertices = []
        for own, whole in enumerate(result.whole_vertices.tolist()):
            if whole >= 0:
                vertices.append(on_border[whole])
                continue
            vertex = edited.verts.new(places[own])
            vertex.index = _NEW + own
            vertices.append(vertex)
        old_edges = set(edited.edges)
        for index, quad in enumerate(quads.tolist()):
            face = edited.faces.new([vertices[corner] for corner in quad])
            face.index = _NEW + index
        for edge in edited.edges:
            if edge not in old_edges:
                edge.index = _NEW
        # Sorting leaves references to elements at places, not at what they stood for: their numbers are asked for before.
        order = np.sort([vertex.index for vertex in edited.verts])
        number = np.searchsorted(order, [vertex.index for vertex in vertices])
        kept_edges, kept_faces = len(old_edges), len(edited.faces) - len(quads)
        for sequence in (edited.verts, edited.edges, edited.faces):
            sequence.sort(key=_index_of)  # what was removed has left gaps that new elements came to lie in
            sequence.index_update()
        edited.to_mesh(mesh)
    finally:
        edited.free()
    return _new_elements(mesh, part_mesh, number, is_new, kept_edges, kept_faces)


def _index_of(element: Any) -> int:
    index: int = element.index
    return index


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
