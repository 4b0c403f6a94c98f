"""Weights of single vertices: each is a mark on one corner of the shape, and goes to the vertex nearest to it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..surface_places import Indices
from .correspondence import Correspondence
from .nearest import NearestVertices

# A vertex farther than this share of its quads' size is not the one that was marked.
_NEAR = 0.5


class MarkedVertices(NamedTuple):
    """Vertices with a weight above zero.

    Attributes
    ----------
    vertices : (k,) int64
    weights : (k,) float32
    """

    vertices: Indices
    weights: npt.NDArray[np.float32]


def marks_on_result(
    marks: tuple[MarkedVertices, ...], correspondence: Correspondence
) -> tuple[npt.NDArray[np.float32], ...]:
    """For each kind of mark (n,) weights: each mark is at the vertex nearest to it, the largest where that has several."""
    if not marks:
        return ()
    nearest = NearestVertices(correspondence.points)
    reach = _NEAR * correspondence.vertex_reach
    result = []
    for mark in marks:
        values = np.zeros(len(correspondence.points), np.float32)
        vertex, distance = nearest.find(correspondence.source.points[mark.vertices])
        near = distance <= reach[vertex]
        np.maximum.at(values, vertex[near], mark.weights[near])
        result.append(values)
    return tuple(result)
