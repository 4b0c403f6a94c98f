"""Weights of vertex groups: they stay normalized and of as few groups a vertex as they were."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..influences import with_fewer_influences
from ..mesh_arrays import FloatArray
from ..surface_places import Indices
from ..surface_walk import BoolArray
from .correspondence import Correspondence


class GroupWeights(NamedTuple):
    """Who is in which of some groups.

    Attributes
    ----------
    deforming : (g,) bool
        Which are named like a bone that deforms.
    vertices, groups : (k,) int64
        Who is in which.
    weights : (k,) float64
    vertex_count : int
    """

    deforming: BoolArray
    vertices: Indices
    groups: Indices
    weights: FloatArray
    vertex_count: int


class GroupMembers(NamedTuple):
    """The members of one group, those of one weight together.

    Attributes
    ----------
    vertices : (k,) int64
    weights : (w,) float32
        All different.
    ends : (w,) int64
        Where in `vertices` those of each weight end.
    """

    vertices: Indices
    weights: npt.NDArray[np.float32]
    ends: Indices


def members_on_result(source: GroupWeights, correspondence: Correspondence) -> tuple[GroupMembers, ...]:
    """Of each group the members among a result's vertices, with weights linear in the source's triangles.

    A vertex is in a group where a vertex of the triangle it lies in is, as far as that has a share in it.
    """
    weights, is_member = _weights_on_result(source, correspondence)
    groups = []
    for group in range(len(source.deforming)):
        members = np.flatnonzero(is_member[:, group])
        values, inverse = np.unique(weights[members, group].astype(np.float32), return_inverse=True)
        order = np.argsort(inverse.reshape(-1), kind="stable")
        ends = np.cumsum(np.bincount(inverse.reshape(-1), minlength=len(values)))
        groups.append(GroupMembers(members[order], values, ends))
    return tuple(groups)


def _weights_on_result(source: GroupWeights, correspondence: Correspondence) -> tuple[FloatArray, BoolArray]:
    """(n, g) weights of a result's vertices, and who is a member."""
    places, indices = correspondence.vertices, correspondence.source.vertices
    count = len(source.deforming)
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
