"""UV maps: every face of the result stays in one island."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np

from ...core.transfer.layers import Layer
from . import buffers

_CUT = 1e-6  # distance in the map from which on it is cut


class UvMap(NamedTuple):
    """A UV map.

    Attributes
    ----------
    name : str
    places : (C, 2) float32
        Of every face corner.
    is_active, is_rendered : bool
    """

    name: str
    places: Any
    is_active: bool
    is_rendered: bool


def read(mesh: bpy.types.Mesh) -> tuple[UvMap, ...]:
    """All UV maps of a mesh."""
    return tuple(
        UvMap(
            layer.name,
            buffers.read(*items_of(layer), np.float32, 2),
            layer == mesh.uv_layers.active,
            layer.active_render,
        )
        for layer in mesh.uv_layers
    )


def carried(maps: tuple[UvMap, ...]) -> tuple[Layer, ...]:
    """What is computed for a result: where a face lies across a cut, its corners go on linearly beyond the island's border."""
    return tuple(Layer("CORNER", source.places, True, _CUT, is_extended=True) for source in maps)


def write(mesh: bpy.types.Mesh, maps: tuple[UvMap, ...], carried_values: tuple[Any, ...]) -> None:
    """Gives a mesh these maps, with the places that :func:`carried` has become."""
    for source, values in zip(maps, carried_values, strict=True):
        layer = mesh.uv_layers.new(name=source.name, do_init=False)
        buffers.write(*items_of(layer), values)
    for source in maps:
        layer = mesh.uv_layers[source.name]
        layer.active_render = layer.active_render or source.is_rendered
        if source.is_active:
            mesh.uv_layers.active = layer


def items_of(layer: Any) -> tuple[Any, str]:
    """The items of a UV layer, and what their place is called."""
    return (layer.uv, "vector") if hasattr(layer, "uv") else (layer.data, "uv")  # before Blender 3.5
