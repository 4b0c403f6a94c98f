"""All that a mesh carries, copied before a run and put on its result after it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import bpy

from ...core.mesh_arrays import FloatArray
from ...core.part_weld import PartResult
from ...core.remesh import RemeshResult
from ...core.surface_places import TriangleMesh
from .. import edge_marks
from . import (
    attributes,
    buffers,
    custom_normals,
    face_marks,
    feature_marks,
    mask,
    materials,
    shape_keys,
    uv_maps,
    vertex_groups,
)
from . import vertex_marks as vertex_weights
from .correspondence import Correspondence
from .rest import Rest

if TYPE_CHECKING:
    from ..remesh_task import RemeshTask


@dataclass(frozen=True)
class SourceLayers:
    """What a source's mesh carries, in arrays; nothing of Blender's own except materials.

    Attributes
    ----------
    kinds : frozenset of str
        What is taken along: names of `kinds.KINDS`.
    applied : tuple of str
        Names of the object's modifiers that are part of the mesh.
    triangles : TriangleMesh
        In the run's space, but wound as in the object's.
    """

    kinds: frozenset[str]
    applied: tuple[str, ...]
    triangles: TriangleMesh
    materials: tuple[materials.MaterialSlot, ...]
    faces: face_marks.FaceMarks
    uv_maps: tuple[uv_maps.UvMap, ...]
    attributes: attributes.MeshAttributes
    mask: Any
    normals: custom_normals.CustomNormals | None
    vertex_marks: tuple[vertex_weights.VertexMark, ...]
    groups: vertex_groups.VertexGroups | None
    keys: shape_keys.ShapeKeys | None = None

    @property
    def losses(self) -> list[str]:
        """What cannot be taken along, in sentences."""
        lost = self.keys.lost if self.keys else ()
        said = [f'Shape key "{name}" is left behind: with it, the modifiers make other vertices' for name in lost]
        return said + [f'Attribute "{name}" is left behind: its type is not known' for name in self.attributes.unknown]


def read(rest: Rest, mesh: bpy.types.Mesh, linear: FloatArray, kinds: frozenset[str]) -> SourceLayers:
    """What the evaluated mesh of an object carries, all but the shape keys.

    Parameters
    ----------
    linear : (3, 3) float64
        Object space to the run's space.
    kinds : frozenset of str
        What is asked for.
    """
    # First of all, as the other layers' arrays are then of the mesh as it stays.
    normals = custom_normals.read(mesh) if "custom_normals" in kinds else None
    return SourceLayers(
        kinds=kinds,
        applied=rest.applied,
        triangles=buffers.triangles_of(mesh, linear),
        materials=materials.read(mesh) if "materials" in kinds else (),
        faces=face_marks.read(mesh, kinds),
        uv_maps=uv_maps.read(mesh) if "uv_maps" in kinds else (),
        attributes=attributes.read(mesh, colors="color_attributes" in kinds, others="attributes" in kinds),
        mask=mask.read(mesh) if "mask" in kinds else None,
        normals=normals,
        vertex_marks=vertex_weights.read(mesh, kinds),
        groups=vertex_groups.read(rest.shown, mesh) if "vertex_groups" in kinds else None,
    )


def with_keys(layers: SourceLayers, rest: Rest, depsgraph: bpy.types.Depsgraph, base: FloatArray) -> SourceLayers:
    """`layers` with the shape keys; evaluates the object anew, so that its former evaluated mesh is gone.

    Parameters
    ----------
    base : (n, 3) float
        Vertices of the mesh in object space.
    """
    return replace(layers, keys=shape_keys.read(rest, depsgraph, base)) if rest.has_keys else layers


def write(obj: bpy.types.Object, task: RemeshTask, result: RemeshResult) -> None:
    """Puts what a task's source carries on an object whose mesh has the result's quads and nothing else."""
    layers, mesh = task.source.layers, obj.data
    assert layers is not None
    quads = result.quads[:, ::-1] if task.source.is_mirrored else result.quads
    triangles = layers.triangles
    if isinstance(result, PartResult):  # new faces have what those had that they replace, and nothing of the rest
        triangles = triangles.of_polygons(result.part)
    correspondence = Correspondence(triangles, result.vertices, quads)
    if layers.mask is not None:
        mask.write(mesh, layers.mask, correspondence)
    vertex_weights.write(mesh, layers.vertex_marks, correspondence)
    materials.write(mesh, layers.materials)
    face_marks.write(mesh, layers.faces, correspondence)
    edge_marks.write(mesh, *feature_marks.on_result(task, result, layers.kinds))
    uv_maps.write(mesh, layers.uv_maps, correspondence)
    for source_map in layers.uv_maps:
        if source_map.is_active and "seams" in layers.kinds:
            feature_marks.mark_cuts(mesh, task, source_map, correspondence)
    attributes.write(mesh, layers.attributes, correspondence)
    if layers.groups is not None:
        vertex_groups.write(obj, layers.groups, correspondence)
    losses = layers.losses
    if layers.keys is not None and mesh.shape_keys is not None:
        shape_keys.write(mesh, layers.keys, correspondence)
    elif layers.keys is not None:
        losses.append("Shape keys are left behind: the source lost its own during the run")
    if layers.normals is not None:
        custom_normals.write(mesh, layers.normals, correspondence)
    result.report["warnings"].extend(losses)
    result.report["transfer"] = {"vertices_against": correspondence.vertices_against}
