"""Corners of polygons around a vertex that one can pass between without crossing certain edges."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .edge_borders import BoolArray, edge_keys, following_corners
from .graph_components import component_labels
from .mesh_arrays import Polygons


def fans_of_corners(polygons: Polygons, is_cut: BoolArray) -> npt.NDArray[np.int64]:
    """(C,) the number of the fan that each corner is part of, from 0 on.

    Parameters
    ----------
    polygons : Polygons
    is_cut : (C,) bool
        Whether the edge from each corner to the next of its polygon separates fans. Edges of other than two polygons do.
    """
    following = following_corners(polygons)
    sides = np.stack([polygons.vertices, polygons.vertices[following]], axis=1)
    keys = edge_keys(sides, int(polygons.vertices.max(initial=0)) + 1)
    order = np.argsort(keys, kind="stable")
    _, first, count = np.unique(keys[order], return_index=True, return_counts=True)
    pairs = np.stack([order[first[count == 2]], order[first[count == 2] + 1]], axis=1)
    pairs = pairs[~is_cut[pairs].any(axis=1)]
    begin, end = pairs, following[pairs]
    # Two polygons of one orientation pass their edge in opposite directions.
    alike = polygons.vertices[begin[:, 0]] == polygons.vertices[begin[:, 1]]
    one = np.concatenate([begin[:, 0], end[:, 0]])
    other = np.concatenate([np.where(alike, begin[:, 1], end[:, 1]), np.where(alike, end[:, 1], begin[:, 1])])
    names = component_labels(len(polygons.vertices), one, other)
    fans: npt.NDArray[np.int64] = np.unique(names, return_inverse=True)[1].reshape(-1).astype(np.int64)
    return fans
