"""From a run's arrays to a Blender mesh, and its place in the scene."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from ..core import report
from ..core.errors import InternalError
from ..core.remesh import CORNER, RemeshResult
from . import edge_marks
from .mesh_source import MeshSource
from .remesh_task import RemeshTask, marks_of_result


@dataclass(frozen=True)
class Placement:
    """Where a result goes.

    Attributes
    ----------
    in_place : bool
        It replaces the object's mesh, rather than becoming an object of its own.
    hides_source, takes_selection : bool
        Whether the object that a new one is made of is hidden, and the new one selected and active instead.
    """

    in_place: bool
    hides_source: bool = True
    takes_selection: bool = True

    @classmethod
    def of_settings(cls, obj: bpy.types.Object) -> Placement:
        """As an object's settings say."""
        return cls(in_place=obj.hybrid_quad.result_mode == "REPLACE")


def place_result(
    context: bpy.types.Context,
    obj: bpy.types.Object,
    task: RemeshTask,
    result: RemeshResult,
    placement: Placement | None = None,
) -> bpy.types.Object:
    """Puts a run's result where it is wanted, by default as the object's settings say; returns the object that has it.

    Nothing of the scene changes before the whole mesh exists.
    """
    placement = placement or Placement.of_settings(obj)
    mesh = build_mesh(obj.data.name, task, result)
    target = _replace_mesh(obj, mesh) if placement.in_place else _add_object(context, obj, mesh, placement)
    for each in {obj, target}:
        each.hybrid_quad.last_report = report.as_text(result.report)
    return target


def read_report(obj: bpy.types.Object) -> dict[str, Any] | None:
    """The report of the latest run of an object, if it had one."""
    try:
        found = json.loads(obj.hybrid_quad.last_report)
    except ValueError:
        return None
    return found if isinstance(found, dict) else None


def build_mesh(name: str, task: RemeshTask, result: RemeshResult) -> bpy.types.Mesh:
    """A new mesh with the result's quads, in object space, with materials, shading and marks of the source.

    Raises
    ------
    InternalError
        If Blender finds the mesh invalid.
    """
    mesh = bpy.data.meshes.new(name)
    try:
        _fill(mesh, task, result)
    except BaseException:
        bpy.data.meshes.remove(mesh)
        raise
    return mesh


def _fill(mesh: bpy.types.Mesh, task: RemeshTask, result: RemeshResult) -> None:
    source = task.source
    quads = result.quads[:, ::-1] if source.is_mirrored else result.quads
    points = source.to_object_space(result.vertices)
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", points.astype(np.float32).ravel())
    mesh.loops.add(quads.size)
    mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(quads, np.int32).ravel())
    mesh.polygons.add(len(quads))
    mesh.polygons.foreach_set("loop_start", np.arange(0, quads.size, 4, dtype=np.int32))
    if not bpy.types.MeshPolygon.bl_rna.properties["loop_total"].is_readonly:  # before Blender 3.6
        mesh.polygons.foreach_set("loop_total", np.full(len(quads), 4, np.int32))
    mesh.update(calc_edges=True)
    for material in source.materials:
        mesh.materials.append(material)
    nearest = _nearest_source_faces(source, result)
    mesh.polygons.foreach_set("material_index", source.face_materials[nearest])
    mesh.polygons.foreach_set("use_smooth", source.face_smooth[nearest])
    edge_marks.write(mesh, *marks_of_result(task, result))
    if task.options.fit_limit_surface:
        edge_marks.crease(mesh, result.feature_edges, np.flatnonzero(result.vertex_kinds == CORNER))
    if hasattr(mesh, "use_auto_smooth") and source.face_smooth.any():
        # Before Blender 4.1 sharp edges show only with this; 180 degrees: only marked edges are sharp.
        mesh.use_auto_smooth = True
        mesh.auto_smooth_angle = math.pi
    if mesh.validate(clean_customdata=False):
        raise InternalError("Blender found the resulting mesh invalid", "validation")
    mesh.update()


def _nearest_source_faces(source: MeshSource, result: RemeshResult) -> np.ndarray:
    """For every quad the source polygon nearest to its middle; the first one where that makes no difference."""
    if len(np.unique(source.face_materials)) == 1 and len(np.unique(source.face_smooth)) == 1:
        return np.zeros(len(result.quads), np.int64)
    corners = source.polygons.vertices.tolist()
    ends = np.cumsum(source.polygons.sizes).tolist()
    polygons = [corners[end - size : end] for end, size in zip(ends, source.polygons.sizes.tolist(), strict=True)]
    tree = BVHTree.FromPolygons(source.vertices.tolist(), polygons)
    middles = result.vertices[result.quads].mean(axis=1)
    found = (tree.find_nearest(middle)[2] for middle in middles.tolist())
    return np.fromiter((0 if index is None else index for index in found), np.int64, len(middles))


def _add_object(
    context: bpy.types.Context, source: bpy.types.Object, mesh: bpy.types.Mesh, placement: Placement
) -> bpy.types.Object:
    # A copy keeps transform, parent, constraints, materials and settings; what belongs to the old mesh goes.
    result = source.copy()
    result.name = f"{source.name} Quads"
    result.data = mesh
    result.modifiers.clear()
    result.vertex_groups.clear()
    mesh.name = result.name
    for collection in source.users_collection or (context.scene.collection,):
        collection.objects.link(result)
    space = context.space_data
    if space is not None and space.type == "VIEW_3D" and space.local_view:
        result.local_view_set(space, True)
    context.view_layer.update()  # only then does the view layer know the new object
    if result.name in context.view_layer.objects:
        result.hide_set(False)
        result.select_set(placement.takes_selection)
        if placement.takes_selection:
            for other in context.selected_objects:
                other.select_set(other == result)
            context.view_layer.objects.active = result
    if placement.hides_source:
        if source.name in context.view_layer.objects:
            source.hide_set(True)
        source.hide_render = True
    return result


def _replace_mesh(obj: bpy.types.Object, mesh: bpy.types.Mesh) -> bpy.types.Object:
    old = obj.data
    for modifier in [modifier for modifier in obj.modifiers if modifier.show_viewport]:
        obj.modifiers.remove(modifier)  # it is part of the result
    obj.data = mesh
    if old.users == 0 and old.library is None:
        name = old.name
        bpy.data.meshes.remove(old)
        mesh.name = name
    return obj
