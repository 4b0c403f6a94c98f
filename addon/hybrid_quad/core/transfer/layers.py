"""Values of a surface's vertices, edges, faces or face corners, on a result."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..surface_walk import BoolArray
from .correspondence import Correspondence


class Layer(NamedTuple):
    """One value for each element of a kind.

    Attributes
    ----------
    domain : str
        POINT, EDGE, FACE or CORNER.
    values : (k,) or (k, d)
        Numbers or Booleans.
    is_continuous : bool
        Whether there is something between two values. What cannot be mixed is that of the nearest element.
    cut : float
        Of corners: difference of values above which they are cut at an edge.
    is_extended : bool
        Of corners: whether values go on linearly beyond a cut.
    """

    domain: str
    values: Any
    is_continuous: bool = False
    cut: float = 0.0
    is_extended: bool = False


def values_on_result(layer: Layer, correspondence: Correspondence, followed: Any = None) -> Any:
    """(k,) or (k, d) what the elements of a result get, of the layer's own type.

    Values of vertices and corners are linear in the source's triangles, of faces those at the face's middle. Edges have the value
    of the source edge along which they run; zero where there is none.

    Parameters
    ----------
    followed : (E,) int64
        For edges: those of the source that they follow, or -1.
    """
    surface, values = correspondence.source, layer.values
    if layer.domain == "EDGE":
        found = values[followed]
        found[followed < 0] = 0
        return found
    if layer.domain == "FACE":
        if (values == values[:1]).all():  # nobody needs to know where the faces lie
            return np.repeat(values[:1], len(correspondence.quads), axis=0)
        return values[correspondence.polygons]
    if layer.domain == "POINT":
        places, indices = correspondence.vertices, surface.vertices
    else:
        corner_places = correspondence.corners(walls_of(layer, correspondence))
        places, indices = corner_places.places, surface.corners
        if layer.is_extended:
            numbers = values.astype(np.float64)
            return corner_places.values(indices, numbers, is_extended=True).astype(values.dtype)
    if layer.is_continuous:
        return places.values(indices, values.astype(np.float64)).astype(values.dtype)
    return values[places.nearest(indices)]


def walls_of(layer: Layer, correspondence: Correspondence) -> BoolArray:
    """(t, 3) sides of the source's triangles at which a layer of corners is cut."""
    values = layer.values.reshape(len(layer.values), -1).astype(np.float64)
    return correspondence.walk.walls(values, layer.cut)
