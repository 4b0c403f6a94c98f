"""Vertex groups: weights that stay normalized and of as few groups a vertex as they were."""

from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np
import numpy.typing as npt

from ...core.influences import with_fewer_influences
from ...core.surface_places import Indices
from .correspondence import Correspondence


class VertexGroups(NamedTuple):
    """The vertex groups of an object.

    Attributes
    ----------
    names : tuple of str
    active : int
        Which is active, or -1.
    locked : (g,) bool
        Whose weights are locked.
    deforming : (g,) bool
        Which are named like a bone that deforms.
    vertices, groups : (k,) int64
        Who is in which.
    weights : (k,) float64
    vertex_count : int
    """

    names: tuple[str, ...]
    active: int
    locked: npt.NDArray[np.bool_]
    deforming: npt.NDArray[np.bool_]
    vertices: Indices
    groups: Indices
    weights: npt.NDArray[np.float64]
    vertex_count: int


def read(obj: bpy.types.Object, mesh: bpy.types.Mesh) -> VertexGroups:
    """The groups of an object with the weights of its evaluated mesh."""
    names = tuple(group.name for group in obj.vertex_groups)
    bones = _deforming_bones(obj)
    vertices = mesh.vertices
    counts = np.fromiter((len(vertex.groups) for vertex in vertices), np.int64, len(vertices))
    members = [(item.group, item.weight) for vertex in vertices for item in vertex.groups] if counts.any() else []
    table = np.array(members, np.float64).reshape(-1, 2)
    owner, group = np.repeat(np.arange(len(vertices)), counts), table[:, 0].astype(np.int64)
    known = (group >= 0) & (group < len(names))
    return VertexGroups(
        names,
        obj.vertex_groups.active_index if names else -1,
        np.array([group.lock_weight for group in obj.vertex_groups], np.bool_),
        np.array([name in bones for name in names], np.bool_),
        owner[known],
        group[known],
        table[known, 1],
        len(vertices),
    )


def write(obj: bpy.types.Object, source: VertexGroups, correspondence: Correspondence) -> None:
    """Gives an object these groups, with weights linear in the source's triangles.

    A vertex is in a group where a vertex of the triangle it lies in is, as far as that has a share in it.
    """
    weights, is_member = weights_on_result(source, correspondence)
    obj.vertex_groups.clear()
    for group, name in enumerate(source.names):
        target = obj.vertex_groups.new(name=name)
        target.lock_weight = bool(source.locked[group])
        members = np.flatnonzero(is_member[:, group])
        values, inverse = np.unique(weights[members, group].astype(np.float32), return_inverse=True)
        order = np.argsort(inverse.reshape(-1), kind="stable")
        ends = np.cumsum(np.bincount(inverse.reshape(-1), minlength=len(values)))
        for value, some in zip(values.tolist(), np.split(members[order], ends[:-1]), strict=False):
            target.add(some.tolist(), value, "REPLACE")
    if source.active >= 0:
        obj.vertex_groups.active_index = source.active


def weights_on_result(
    source: VertexGroups, correspondence: Correspondence
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.bool_]]:
    """(n, g) weights of a result's vertices, and who is a member."""
    places, indices = correspondence.vertices, correspondence.source.vertices
    count = len(source.names)
    weights = np.zeros((len(places.triangles), count))
    is_member = np.zeros((len(places.triangles), count), np.bool_)
    order = np.argsort(source.groups, kind="stable")
    ends = np.searchsorted(source.groups[order], np.arange(count + 1))
    for group in range(count):
        own = order[ends[group] : ends[group + 1]]
        column = np.zeros((source.vertex_count, 2))
        column[source.vertices[own], 0] = source.weights[own]
        column[source.vertices[own], 1] = 1
        mixed = places.values(indices, column)
        weights[:, group], is_member[:, group] = mixed[:, 0], mixed[:, 1] > 0
    deforming = np.flatnonzero(source.deforming)
    if len(deforming):
        most = np.bincount(source.vertices[source.deforming[source.groups]], minlength=1).max()
        kept = with_fewer_influences(weights[:, deforming], int(most))
        is_member[:, deforming] &= (kept > 0) | (weights[:, deforming] == 0)
        weights[:, deforming] = kept
    return np.clip(weights, 0, 1), is_member


def _deforming_bones(obj: bpy.types.Object) -> set[str]:
    rigs = [modifier.object for modifier in obj.modifiers if modifier.type == "ARMATURE"]
    if obj.parent_type == "ARMATURE":
        rigs.append(obj.parent)
    return {bone.name for rig in rigs if rig and rig.type == "ARMATURE" for bone in rig.data.bones if bone.use_deform}
