"""All that the quads of a part carry, copied to the new elements of the whole mesh; nothing else of it is touched."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from . import edge_marks
from .transfer import buffers, mask, uv_maps
from .transfer.attributes import STORAGES, TOPOLOGY

if TYPE_CHECKING:
    from .part_mesh import NewElements

# What older Blenders keep outside attributes: collection, property, type.
_PROPERTIES = (
    ("vertices", "bevel_weight", np.float32),
    ("edges", "use_seam", np.bool_),
    ("edges", "use_edge_sharp", np.bool_),
    ("edges", "crease", np.float32),
    ("edges", "bevel_weight", np.float32),
    ("edges", "use_freestyle_mark", np.bool_),
    ("polygons", "material_index", np.int32),
    ("polygons", "use_smooth", np.bool_),
    ("polygons", "use_freestyle_mark", np.bool_),
)
_DOMAINS = {"POINT": "vertices", "EDGE": "edges", "FACE": "faces", "CORNER": "corners"}
_OWNED = frozenset(("position", "custom_normal"))  # set elsewhere


def copy_layers(holder: bpy.types.Object, part_mesh: bpy.types.Mesh, new: NewElements) -> None:
    """Gives the new elements of an object's mesh what the elements of a part's mesh carry."""
    mesh = holder.data
    _add_missing_marks(mesh, part_mesh)
    for name, property_name, dtype in _PROPERTIES:
        collection, own = getattr(mesh, name), getattr(part_mesh, name)
        if property_name in _rna_of(name).properties:
            domain = "faces" if name == "polygons" else name
            _overlay(collection, own, property_name, dtype, 1, *_places(new, domain))
    maps = set()
    for layer in part_mesh.uv_layers:
        if layer.name in mesh.uv_layers:
            maps.add(layer.name)
            items, value = uv_maps.items_of(mesh.uv_layers[layer.name])
            own, _ = uv_maps.items_of(layer)
            _overlay(items, own, value, np.float32, 2, *_places(new, "corners"))
    for attribute in part_mesh.attributes:
        if attribute.name not in maps:
            _copy_attribute(mesh, attribute, new)
    if hasattr(mesh, "vertex_paint_masks"):  # before Blender 4.1
        values = mask.read(part_mesh)
        if values is not None and mesh.vertex_paint_masks:
            layers = mesh.vertex_paint_masks[0].data, part_mesh.vertex_paint_masks[0].data
            _overlay(*layers, "value", np.float32, 1, *_places(new, "vertices"))
    if bpy.app.version < (4, 0) and mesh.vertex_creases and part_mesh.vertex_creases:
        layers = mesh.vertex_creases[0].data, part_mesh.vertex_creases[0].data
        _overlay(*layers, "value", np.float32, 1, *_places(new, "vertices"))
    _copy_groups(holder, part_mesh, new)
    _copy_keys(mesh, part_mesh, new)


def _places(new: NewElements, domain: str) -> tuple[Any, Any]:
    return getattr(new, domain), getattr(new, f"own_{domain}")


def _rna_of(name: str) -> Any:
    types = {"vertices": bpy.types.MeshVertex, "edges": bpy.types.MeshEdge, "polygons": bpy.types.MeshPolygon}
    return types[name].bl_rna


def _overlay(target: Any, source: Any, name: str, dtype: Any, width: int, places: Any, own: Any) -> None:
    """Sets one property of the items at `places` to that of the items `own` of another collection."""
    values = buffers.read(target, name, dtype, width)
    wanted = buffers.read(source, name, dtype, width)[own]
    if not np.array_equal(values[places], wanted):
        values[places] = wanted
        buffers.write(target, name, values)


def _add_missing_marks(mesh: bpy.types.Mesh, part_mesh: bpy.types.Mesh) -> None:
    """Layers of marks that the mesh has not got because nothing of it was marked."""
    for attribute in part_mesh.attributes:
        if attribute.name in edge_marks.MARK_ATTRIBUTES and attribute.name not in mesh.attributes:
            mesh.attributes.new(attribute.name, attribute.data_type, attribute.domain)


def _copy_attribute(mesh: bpy.types.Mesh, source: Any, new: NewElements) -> None:
    target = mesh.attributes.get(source.name)
    if target is None or source.name in _OWNED or source.name in TOPOLOGY or source.data_type not in STORAGES:
        return
    if (target.domain, target.data_type) != (source.domain, source.data_type):
        return
    storage = STORAGES[source.data_type]
    places, own = _places(new, _DOMAINS[source.domain])
    # Colors of bytes pass through another color space on their way to Python, and texts are no arrays: one by one.
    if storage.dtype is object or source.data_type == "BYTE_COLOR":
        for place, index in zip(places.tolist(), own.tolist(), strict=True):
            setattr(target.data[place], storage.value, getattr(source.data[index], storage.value))
    else:
        _overlay(target.data, source.data, storage.value, storage.dtype, storage.width, places, own)


def _copy_groups(holder: bpy.types.Object, part_mesh: bpy.types.Mesh, new: NewElements) -> None:
    groups = holder.vertex_groups
    members: dict[tuple[int, float], list[int]] = {}
    for place, index in zip(new.vertices.tolist(), new.own_vertices.tolist(), strict=True):
        for item in part_mesh.vertices[index].groups:
            members.setdefault((item.group, item.weight), []).append(place)
    for (group, weight), places in members.items():
        if group < len(groups):
            groups[group].add(places, weight, "REPLACE")


def _copy_keys(mesh: bpy.types.Mesh, part_mesh: bpy.types.Mesh, new: NewElements) -> None:
    if mesh.shape_keys is None:
        return
    own_keys = part_mesh.shape_keys.key_blocks if part_mesh.shape_keys else {}
    for key in mesh.shape_keys.key_blocks:
        own = own_keys[key.name].data if key.name in own_keys else part_mesh.vertices
        _overlay(key.data, own, "co", np.float32, 3, new.vertices, new.own_vertices)
