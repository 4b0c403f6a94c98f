"""From a run's arrays to a Blender mesh, and its place in the scene."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from typing import Any

import bpy
import numpy as np

from ..core import report
from ..core.errors import InternalError
from ..core.part_weld import PartResult
from ..core.remesh import CORNER, RemeshResult
from ..worker.transfer_request import TransferredData
from . import edge_marks, result_features
from .own_mesh import OwnMesh
from .part_mesh import joined_mesh
from .remesh_task import RemeshTask
from .steps import Steps, finish
from .transfer import layers as transfer_layers
from .transfer import object_data


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
    carried: TransferredData | None = None,
    built: OwnMesh | None = None,
) -> bpy.types.Object:
    """Puts a run's result where it is wanted, by default as the object's settings say; returns the object that has it.

    Nothing of the scene changes before the whole mesh exists.

    Parameters
    ----------
    carried : TransferredData, optional
        What the task's transfer request for this result gave, where that is known already.
    built : OwnMesh, optional
        What :func:`build_in_steps` gave, where that was done already.
    """
    if carried is None:
        carried = task.transfer_request(result).solve()
    placement = placement or Placement.of_settings(obj)
    mesh = (built or finish(build_in_steps(obj, task, result, carried))).release()
    if isinstance(result, PartResult):
        mesh = _joined(obj, mesh, result)
    target = _replace_mesh(obj, mesh, task) if placement.in_place else _add_object(context, obj, mesh, task, placement)
    told = result.report["warnings"]  # by a former placing of the same result too
    told += [each for each in task.ignored if each not in told]
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


def build_in_steps(
    source: bpy.types.Object, task: RemeshTask, result: RemeshResult, carried: TransferredData
) -> Steps[OwnMesh]:
    """A new mesh with the result's quads, in object space, and with what it takes along of the source.

    Only the first step looks at the source.

    Raises
    ------
    InternalError
        If Blender finds the mesh invalid.
    InputError
        ``mesh_gone``, where an undo came between the steps.
    """
    layers = task.source.layers
    assert layers is not None
    own = OwnMesh(object_data.empty_mesh_like(source, layers, len(result.vertices)), source.name)
    try:
        _add_quads(own.mesh(), task, result)
        yield
        yield from transfer_layers.write(own, task, result, carried)
        yield
        _mark_features(own.mesh(), task, result)
        yield
        mesh = own.mesh()
        if mesh.validate(clean_customdata=False):
            raise InternalError("Blender found the resulting mesh invalid", "validation")
        mesh.update()
    except BaseException:
        own.remove()
        raise
    return own


def _joined(obj: bpy.types.Object, part_mesh: bpy.types.Mesh, result: PartResult) -> bpy.types.Mesh:
    try:
        return joined_mesh(obj, part_mesh, result)
    finally:
        bpy.data.meshes.remove(part_mesh)


def _add_quads(mesh: bpy.types.Mesh, task: RemeshTask, result: RemeshResult) -> None:
    source = task.source
    assert source.layers is not None
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
    if hasattr(mesh, "use_auto_smooth"):
        # Before Blender 4.1 sharp edges show only with this; 180 degrees: only marked edges are sharp.
        mesh.use_auto_smooth = bool(source.layers.faces.is_smooth.any())
        mesh.auto_smooth_angle = math.pi


def _mark_features(mesh: bpy.types.Mesh, task: RemeshTask, result: RemeshResult) -> None:
    corners = np.flatnonzero(result.vertex_kinds == CORNER)
    result_features.write(mesh, result.feature_edges, corners)
    if task.options.fit_limit_surface:
        edge_marks.crease(mesh, result.feature_edges, corners)


def _add_object(
    context: bpy.types.Context, source: bpy.types.Object, mesh: bpy.types.Mesh, task: RemeshTask, placement: Placement
) -> bpy.types.Object:
    layers = task.source.layers
    result = source.copy()
    result.name = f"{source.name} Quads"
    result.data = mesh
    mesh.name = result.name
    result.hybrid_quad.source_name = source.name
    for collection in object_data.collections_for(context, source, layers):
        collection.objects.link(result)
    object_data.take_along(context, result, layers)
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


def _replace_mesh(obj: bpy.types.Object, mesh: bpy.types.Mesh, task: RemeshTask) -> bpy.types.Object:
    old = obj.data
    if task.part is None:
        object_data.keep_modifiers(obj, task.source.layers)
    obj.data = mesh
    if old.users == 0 and old.library is None:
        name = old.name
        bpy.data.meshes.remove(old)
        mesh.name = name
    return obj
