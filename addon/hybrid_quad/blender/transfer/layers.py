"""All that a mesh carries, copied before a run and put on its result after it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, is_dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import bpy
import numpy as np

from ...core.mesh_arrays import FloatArray
from ...core.part_weld import PartResult
from ...core.remesh import RemeshResult
from ...core.surface_places import TriangleMesh
from ...worker.transfer_request import TransferredData, TransferRequest
from .. import edge_marks
from ..own_mesh import OwnMesh
from ..steps import Steps
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


# What Blender may change without any change of the shape.
_CARRIED = ("materials", "faces", "uv_maps", "attributes", "mask", "normals", "vertex_marks", "groups")


def carry_the_same(one: SourceLayers, other: SourceLayers) -> bool:
    """Whether two readings of a source differ at most in their places."""
    return all(_are_same(getattr(one, name), getattr(other, name)) for name in _CARRIED)


def _are_same(one: Any, other: Any) -> bool:
    if is_dataclass(one):
        return type(one) is type(other) and _are_same(vars(one), vars(other))
    if isinstance(one, np.ndarray):
        if not isinstance(other, np.ndarray) or one.dtype != other.dtype:
            return False
        return np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
    if isinstance(one, dict):
        return isinstance(other, dict) and one.keys() == other.keys() and all(_are_same(one[k], other[k]) for k in one)
    if isinstance(one, (list, tuple)):
        return type(one) is type(other) and len(one) == len(other) and all(map(_are_same, one, other))
    return bool(one == other)


class LayerOrder(NamedTuple):
    """What of an object's mesh is to be read, and what its layers are called; nothing of Blender's own.

    Attributes
    ----------
    kinds : frozenset of str
        What is asked for.
    applied : tuple of str
        Names of the object's modifiers that are part of the mesh.
    groups : GroupList or None
    """

    kinds: frozenset[str]
    applied: tuple[str, ...]
    groups: vertex_groups.GroupList | None

    @classmethod
    def of(cls, rest: Rest, kinds: frozenset[str]) -> LayerOrder:
        """What is asked for of an object."""
        return cls(kinds, rest.applied, vertex_groups.list_of(rest.shown) if "vertex_groups" in kinds else None)


def read(order: LayerOrder, mesh_of: Callable[[], bpy.types.Mesh], linear: FloatArray) -> Steps[SourceLayers]:
    """What the evaluated mesh of an object carries, all but the shape keys.

    Parameters
    ----------
    linear : (3, 3) float64
        Object space to the run's space.
    """
    kinds, mesh = order.kinds, mesh_of()
    # First of all, as the other layers' arrays are then of the mesh as it stays.
    normals = custom_normals.read(mesh) if "custom_normals" in kinds else None
    if normals is not None:
        yield
    triangles = buffers.triangles_of(mesh_of(), linear)
    yield
    mesh = mesh_of()
    layers = SourceLayers(
        kinds=kinds,
        applied=order.applied,
        triangles=triangles,
        materials=materials.read(mesh) if "materials" in kinds else (),
        faces=face_marks.read(mesh, kinds),
        uv_maps=uv_maps.read(mesh) if "uv_maps" in kinds else (),
        attributes=attributes.read(mesh, colors="color_attributes" in kinds, others="attributes" in kinds),
        mask=mask.read(mesh) if "mask" in kinds else None,
        normals=normals,
        vertex_marks=vertex_weights.read(mesh, kinds),
        groups=None,
    )
    if order.groups is None:
        return layers
    yield
    return replace(layers, groups=(yield from vertex_groups.read(order.groups, mesh_of)))


def request_of(task: RemeshTask, result: RemeshResult) -> TransferRequest:
    """What is to be computed before :func:`write`, here or in another process: all that needs no Blender."""
    source, layers = task.source, task.source.layers
    assert layers is not None
    has_seams = "seams" in layers.kinds
    return TransferRequest(
        surface=layers.triangles,
        part=result.part if isinstance(result, PartResult) else None,
        points=result.vertices,
        quads=result.quads[:, ::-1] if source.is_mirrored else result.quads,
        feature_edges=result.feature_edges,
        source_edges=feature_marks.carried(task, layers.kinds),
        layers={
            "mask": () if layers.mask is None else (mask.carried(layers.mask),),
            "faces": face_marks.carried(layers.faces),
            "uv_maps": uv_maps.carried(layers.uv_maps),
            "attributes": attributes.carried(layers.attributes),
            "keys": () if layers.keys is None else shape_keys.carried(layers.keys),
            "normals": () if layers.normals is None else (custom_normals.carried(layers.normals),),
        },
        seam_map=next((number for number, each in enumerate(layers.uv_maps) if each.is_active and has_seams), None),
        vertex_marks=tuple(mark.marked for mark in layers.vertex_marks),
        groups=None if layers.groups is None else layers.groups.weights,
    )


def write(own: OwnMesh, task: RemeshTask, result: RemeshResult, carried: TransferredData) -> Steps[None]:
    """Puts what a task's source carries on a mesh that has the result's quads and nothing else.

    Parameters
    ----------
    carried : TransferredData
        What became of :func:`request_of`.
    """
    layers, mesh, values = task.source.layers, own.mesh(), carried.layers
    assert layers is not None
    if layers.mask is not None:
        mask.write(mesh, *values["mask"])
    vertex_weights.write(mesh, layers.vertex_marks, carried.vertex_marks)
    materials.write(mesh, layers.materials)
    face_marks.write(mesh, layers.faces, values["faces"])
    edge_marks.write(mesh, carried.marked_edges, carried.edge_values)
    uv_maps.write(mesh, layers.uv_maps, values["uv_maps"])
    if carried.seams is not None:
        feature_marks.add_seams(mesh, carried.seams)
    attributes.write(mesh, layers.attributes, values["attributes"], carried.edges)
    if layers.groups is not None:
        assert carried.groups is not None
        yield
        yield from vertex_groups.write(own, layers.groups, carried.groups)
    losses = layers.losses
    if layers.keys is not None:
        yield
        mesh = own.mesh()
        if mesh.shape_keys is not None:
            shape_keys.write(mesh, layers.keys, values["keys"])
        else:
            losses.append("Shape keys are left behind: the source lost its own during the run")
    if layers.normals is not None:
        yield
        custom_normals.write(own.mesh(), layers.normals, *values["normals"])
    told = result.report["warnings"]  # by a former placing of the same result too
    told += [each for each in losses if each not in told]
    result.report["transfer"] = {"vertices_against": carried.vertices_against}
