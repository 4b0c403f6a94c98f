"""Vertex groups and who is in them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import bpy
import numpy as np
import numpy.typing as npt

from ...core.transfer.groups import GroupMembers, GroupWeights
from ..own_mesh import OwnMesh
from ..steps import Steps

# In one step.
_VERTICES = 40_000  # asked
_WEIGHTS = 60_000  # set


class VertexGroups(NamedTuple):
    """The vertex groups of an object.

    Attributes
    ----------
    names : tuple of str
    active : int
        Which is active, or -1.
    locked : (g,) bool
        Whose weights are locked.
    weights : GroupWeights
    """

    names: tuple[str, ...]
    active: int
    locked: npt.NDArray[np.bool_]
    weights: GroupWeights


class GroupList(NamedTuple):
    """The vertex groups of an object, without weights.

    Attributes
    ----------
    names, active, locked
        As of :class:`VertexGroups`.
    deforming : (g,) bool
        Which are named like a bone that deforms.
    """

    names: tuple[str, ...]
    active: int
    locked: npt.NDArray[np.bool_]
    deforming: npt.NDArray[np.bool_]


def list_of(obj: bpy.types.Object) -> GroupList:
    """The groups of an object."""
    names = tuple(group.name for group in obj.vertex_groups)
    bones = _deforming_bones(obj)
    return GroupList(
        names,
        obj.vertex_groups.active_index if names else -1,
        np.array([group.lock_weight for group in obj.vertex_groups], np.bool_),
        np.array([name in bones for name in names], np.bool_),
    )


def read(groups: GroupList, mesh_of: Callable[[], bpy.types.Mesh]) -> Steps[VertexGroups]:
    """Groups with the weights of an evaluated mesh, some vertices a step, as Python can only ask them one by one."""
    total = len(mesh_of().vertices)
    counts, numbers, weights = [], [], []
    for begin in range(0, total if groups.names else 0, _VERTICES):
        if begin:
            yield
        end = min(begin + _VERTICES, total)
        own, table = _members(mesh_of().vertices[begin:end])
        counts.append(own)
        numbers.append(table[0::2].astype(np.int64))
        weights.append(table[1::2])
    owner = np.repeat(np.arange(total), np.concatenate(counts)) if counts else np.zeros(0, np.int64)
    group = np.concatenate(numbers) if numbers else np.zeros(0, np.int64)
    weight = np.concatenate(weights) if weights else np.zeros(0)
    known = (group >= 0) & (group < len(groups.names))
    return VertexGroups(
        groups.names,
        groups.active,
        groups.locked,
        GroupWeights(groups.deforming, owner[known], group[known], weight[known], total),
    )


def _members(vertices: Any) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.float64]]:
    """(k,) in how many groups each of some vertices is, and which group and with what weight, one after the other."""
    counts = np.zeros(len(vertices), np.int64)
    table: list[float] = []
    for index, vertex in enumerate(vertices):
        before = len(table)
        for item in vertex.groups:
            table += (item.group, item.weight)
        counts[index] = (len(table) - before) // 2
    return counts, np.array(table, np.float64)


def write(own: OwnMesh, source: VertexGroups, members: tuple[GroupMembers, ...]) -> Steps[None]:
    """Gives a mesh these groups, each with its members, some weights a step, as Python can only set one at a time."""
    with own.held() as holder:
        holder.vertex_groups.clear()
        for name, is_locked in zip(source.names, source.locked.tolist(), strict=True):
            holder.vertex_groups.new(name=name).lock_weight = is_locked
        if source.active >= 0:
            holder.vertex_groups.active_index = source.active
    left = _WEIGHTS
    for index, group in enumerate(members):
        begin = 0
        while begin < len(group.weights):
            if left == 0:
                yield
                left = _WEIGHTS
            end = min(begin + left, len(group.weights))
            with own.held() as holder:
                _add_members(holder.vertex_groups[index], group, begin, end)
            left -= end - begin
            begin = end


def _add_members(target: bpy.types.VertexGroup, group: GroupMembers, begin: int, end: int) -> None:
    """Adds the vertices of some of a group's weights."""
    first = int(group.ends[begin - 1]) if begin else 0
    vertices, at = group.vertices[first : group.ends[end - 1]].tolist(), 0
    for weight, last in zip(group.weights[begin:end].tolist(), (group.ends[begin:end] - first).tolist(), strict=True):
        target.add(vertices[at:last], weight, "REPLACE")
        at = last


def _deforming_bones(obj: bpy.types.Object) -> set[str]:
    rigs = [modifier.object for modifier in obj.modifiers if modifier.type == "ARMATURE"]
    if obj.parent_type == "ARMATURE":
        rigs.append(obj.parent)
    return {bone.name for rig in rigs if rig and rig.type == "ARMATURE" for bone in rig.data.bones if bone.use_deform}
