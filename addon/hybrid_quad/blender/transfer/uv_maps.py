"""UV maps: every face of the result stays in one island."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np

from ...core.mesh_arrays import FloatArray
from ...core.surface_walk import BoolArray
from . import buffers
from .correspondence import Correspondence

_CUT = 1e-6  # distance in the map from which on it is cut


class UvMap(NamedTuple):
    """A UV map.

    Attributes
    ----------
    name : str
    places : (C, 2) float64
        Of every face corner.
    is_active, is_rendered : bool
    """

    name: str
    places: FloatArray
    is_active: bool
    is_rendered: bool


def read(mesh: bpy.types.Mesh) -> tuple[UvMap, ...]:
    """All UV maps of a mesh."""
    return tuple(
        UvMap(layer.name, places_of(layer), layer == mesh.uv_layers.active, layer.active_render)
        for layer in mesh.uv_layers
    )


def write(mesh: bpy.types.Mesh, maps: tuple[UvMap, ...], correspondence: Correspondence) -> None:
    """Gives a mesh these maps; where a face lies across a cut, its corners go on linearly beyond the island's border."""
    for source in maps:
        places = correspondence.corners(walls_of(source, correspondence))
        values = places.values(correspondence.source.corners, source.places, is_extended=True)
        layer = mesh.uv_layers.new(name=source.name, do_init=False)
        buffers.write(*items_of(layer), values.astype(np.float32))
    for source in maps:
        layer = mesh.uv_layers[source.name]
        layer.active_render = layer.active_render or source.is_rendered
        if source.is_active:
            mesh.uv_layers.active = layer


def walls_of(source: UvMap, correspondence: Correspondence) -> BoolArray:
    """(t, 3) sides of the source's triangles at which a map is cut."""
    return correspondence.walk.walls(source.places, _CUT)


def places_of(layer: Any) -> FloatArray:
    """(C, 2) places of the face corners in a UV layer of a mesh."""
    items, name = items_of(layer)
    places: FloatArray = buffers.read(items, name, np.float32, 2).astype(np.float64)
    return places


def items_of(layer: Any) -> tuple[Any, str]:
    """The items of a UV layer, and what their place is called."""
    return (layer.uv, "vector") if hasattr(layer, "uv") else (layer.data, "uv")  # before Blender 3.5
