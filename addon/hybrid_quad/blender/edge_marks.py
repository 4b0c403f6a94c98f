"""Marks and borders on edges: which ones a mesh has, which of them make features, and how they get onto the result.

Blender keeps most marks in attributes whose names came with different versions; where there is no attribute yet, the
edge itself has a property.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import bmesh
import bpy
import numpy as np
import numpy.typing as npt

from ..core.edge_borders import EdgeSides, edge_keys
from ..core.edge_mark_values import BEVEL, CREASE, FACE_SET, FEATURE, FREESTYLE, MATERIAL, SEAM, SHARP, UV_ISLAND
from ..core.mesh_arrays import IntArray, Polygons
from ..core.transfer.edges import EdgeValues
from .steps import Steps

BORDERS = MATERIAL | FACE_SET | UV_ISLAND

FEATURE_ATTRIBUTE = "hybrid_quad_feature"
FACE_SET_ATTRIBUTE = ".sculpt_face_set"  # from Blender 3.5 on; before, Python cannot see face sets


class EdgeSource(NamedTuple):
    """Something that can make an edge a feature.

    Attributes
    ----------
    mark : int
    setting : str
        The object's setting that asks for it.
    identifier : str
        In the setting that makes it a guide.
    label : str
        In the panel.
    argument : str
        Of the batch command, without the dashes.
    """

    mark: int
    setting: str
    identifier: str
    label: str
    argument: str


SOURCES = (
    EdgeSource(SHARP, "use_marked_sharp", "SHARP", "Sharp", "marked-sharp"),
    EdgeSource(SEAM, "use_seams", "SEAM", "Seam", "seams"),
    EdgeSource(CREASE, "use_creases", "CREASE", "Crease", "creases"),
    EdgeSource(BEVEL, "use_bevel_weights", "BEVEL", "Bevel Weight", "bevel-weights"),
    EdgeSource(FREESTYLE, "use_freestyle_marks", "FREESTYLE", "Freestyle", "freestyle-marks"),
    EdgeSource(FEATURE, "use_feature_attribute", "FEATURE", "Attribute", "feature-attribute"),
    EdgeSource(MATERIAL, "use_material_borders", "MATERIAL", "Materials", "material-borders"),
    EdgeSource(FACE_SET, "use_face_set_borders", "FACE_SET", "Face Sets", "face-set-borders"),
    EdgeSource(UV_ISLAND, "use_uv_borders", "UV_ISLAND", "UV Islands", "uv-borders"),
)


class _Store(NamedTuple):
    """Where Blender keeps a mark: in an attribute or, where the edge has it, in a property."""

    mark: int
    property_name: str
    attribute: str
    data_type: str


_STORES = (
    _Store(SHARP, "use_edge_sharp", "", "BOOLEAN"),
    _Store(SEAM, "use_seam", "", "BOOLEAN"),
    _Store(CREASE, "crease", "crease_edge", "FLOAT"),  # a property before Blender 4.0
    _Store(BEVEL, "bevel_weight", "bevel_weight_edge", "FLOAT"),  # a property before Blender 4.0
    _Store(FREESTYLE, "use_freestyle_mark", "freestyle_edge", "BOOLEAN"),  # a property before Blender 5.0
    _Store(FEATURE, "", FEATURE_ATTRIBUTE, "BOOLEAN"),
)


class VertexStore(NamedTuple):
    """Where Blender keeps a weight of vertices.

    Attributes
    ----------
    attribute : str
        From Blender 4.0 on.
    former : str
        Before: the mesh's or the vertices' own.
    layer : str
        In a bmesh.
    """

    attribute: str
    former: str
    layer: str

    def read(self, mesh: bpy.types.Mesh) -> Any:
        """(n,) float32, or None where a mesh has none."""
        items = self._items(mesh)
        return None if items is None else _read(items, self._value, np.float32)

    def write(self, mesh: bpy.types.Mesh, values: Any) -> None:
        """Gives a mesh these weights (n,)."""
        if self._items(mesh) is None:
            if self._is_attribute:
                mesh.attributes.new(self.attribute, "FLOAT", "POINT")
            else:  # which Python cannot make before Blender 3.6 but by a bmesh
                edited = bmesh.new()
                edited.from_mesh(mesh)
                getattr(edited.verts.layers, self.layer).verify()
                edited.to_mesh(mesh)
                edited.free()
        self._items(mesh).foreach_set(self._value, np.ascontiguousarray(values, np.float32))

    @property
    def _is_attribute(self) -> bool:
        return bpy.app.version >= (4, 0)

    @property
    def _value(self) -> str:
        return self.former if self._is_of_vertices else "value"

    @property
    def _is_of_vertices(self) -> bool:
        return self.former in bpy.types.MeshVertex.bl_rna.properties

    def _items(self, mesh: bpy.types.Mesh) -> Any:
        if self._is_of_vertices:
            return mesh.vertices
        if self._is_attribute:
            attribute = mesh.attributes.get(self.attribute)
            return None if attribute is None else attribute.data
        layers = getattr(mesh, self.former)
        return layers[0].data if layers else None


# Attributes of marks that a mesh has only where something is marked.
MARK_ATTRIBUTES = frozenset(
    [
        "sharp_edge",
        "uv_seam",
        "crease_vert",
        "bevel_weight_vert",
        "freestyle_face",
        *(store.attribute for store in _STORES if store.attribute),
    ]
)

VERTEX_CREASE = VertexStore("crease_vert", "vertex_creases", "crease")
VERTEX_BEVEL = VertexStore("bevel_weight_vert", "bevel_weight", "bevel_weight")


def marks_asked(settings: Any) -> int:
    """Sum of the marks that an object's settings make features."""
    return sum(source.mark for source in SOURCES if getattr(settings, source.setting))


def marks_guiding(settings: Any) -> int:
    """Sum of the marks that an object's settings make guides."""
    return sum(source.mark for source in SOURCES if source.identifier in settings.guide_marks)


def no_values(count: int) -> EdgeValues:
    """Of edges that carry nothing."""
    return EdgeValues(np.zeros(count, np.uint16), np.zeros(count, np.float32), np.zeros(count, np.float32))


def read(
    mesh_of: Callable[[], bpy.types.Mesh], polygons: Polygons, edges: IntArray, corner_order: Any
) -> Steps[EdgeValues]:
    """All marks and borders of a mesh's edges.

    Parameters
    ----------
    polygons, edges
        The mesh's, as arrays.
    corner_order : (C,) int
        The mesh's loop at each corner of `polygons`.
    """
    marks = np.zeros(len(edges), np.uint16)
    mesh = mesh_of()
    values = {store.mark: _read_store(mesh, store) for store in _STORES}
    for mark, of_edge in values.items():
        marks[of_edge > 0] |= mark
    face_values = {MATERIAL: _read(mesh.polygons, "material_index", np.int32), FACE_SET: _read_face_sets(mesh)}
    face_values = {mark: of_face for mark, of_face in face_values.items() if _varies(of_face)}
    uv = _read_uv(mesh)
    vertex_count = len(mesh.vertices)
    if face_values or uv is not None:
        yield
        sides = EdgeSides(polygons, edges, vertex_count)
        yield
        for mark, of_face in face_values.items():
            marks[sides.where_faces_differ(of_face)] |= mark
        if uv is not None:
            yield
            marks[sides.where_corners_differ(uv[corner_order])] |= UV_ISLAND
    return EdgeValues(marks, values[CREASE].astype(np.float32), values[BEVEL].astype(np.float32))


def write(mesh: bpy.types.Mesh, edges: IntArray, values: EdgeValues) -> None:
    """Gives those edges of a mesh that are given as vertex pairs the marks and weights that Blender can keep."""
    if not len(edges):
        return
    place = indices_of(mesh, edges)
    weights = {CREASE: values.crease, BEVEL: values.bevel}
    for store in _STORES:
        has = (values.marks & store.mark) != 0
        if has.any():
            of_edge = np.zeros(len(mesh.edges), np.float32 if store.data_type == "FLOAT" else np.bool_)
            of_edge[place] = np.where(has, weights.get(store.mark, 1), 0)
            _write_store(mesh, store, of_edge)


def crease(mesh: bpy.types.Mesh, edges: IntArray, vertices: npt.NDArray[np.int64]) -> None:
    """Makes edges, given as vertex pairs, and vertices as sharp under a subdivision surface as can be."""
    if len(edges):
        store = next(store for store in _STORES if store.mark == CREASE)
        of_edge = _read_store(mesh, store).astype(np.float32)
        of_edge[indices_of(mesh, edges)] = 1.0
        _write_store(mesh, store, of_edge)
    if len(vertices):
        of_vertex = np.zeros(len(mesh.vertices), np.float32)
        of_vertex[vertices] = 1.0
        VERTEX_CREASE.write(mesh, of_vertex)


def hard_edges(mesh: bpy.types.Mesh) -> npt.NDArray[np.bool_]:
    """(k,) which edges of a mesh are marked as sharp or have a crease."""
    found = [_read_store(mesh, store) > 0 for store in _STORES if store.mark in (SHARP, CREASE)]
    hard: npt.NDArray[np.bool_] = np.logical_or.reduce(found)
    return hard


def _read_store(mesh: bpy.types.Mesh, store: _Store) -> Any:
    attribute = mesh.attributes.get(store.attribute) if store.attribute else None
    dtype = np.float32 if store.data_type == "FLOAT" else np.bool_
    if attribute is not None and (attribute.domain, attribute.data_type) == ("EDGE", store.data_type):
        return _read(attribute.data, "value", dtype)
    if store.property_name in bpy.types.MeshEdge.bl_rna.properties:
        return _read(mesh.edges, store.property_name, dtype)
    return np.zeros(len(mesh.edges), dtype)


def _write_store(mesh: bpy.types.Mesh, store: _Store, values: Any) -> None:
    if store.property_name in bpy.types.MeshEdge.bl_rna.properties:
        mesh.edges.foreach_set(store.property_name, values)
        return
    attribute = mesh.attributes.get(store.attribute)
    if attribute is None:
        attribute = mesh.attributes.new(store.attribute, store.data_type, "EDGE")
    attribute.data.foreach_set("value", values)


def _read_face_sets(mesh: bpy.types.Mesh) -> Any:
    attribute = mesh.attributes.get(FACE_SET_ATTRIBUTE)
    if attribute is None or (attribute.domain, attribute.data_type) != ("FACE", "INT"):
        return None
    return _read(attribute.data, "value", np.int32)


def _varies(of_face: Any) -> bool:
    """Whether faces have values, and not all the same."""
    return of_face is not None and bool((of_face != of_face[:1]).any())


def _read_uv(mesh: bpy.types.Mesh) -> Any:
    layer = mesh.uv_layers.active
    if layer is None or not len(mesh.loops):
        return None
    if hasattr(layer, "uv"):  # from Blender 3.5 on
        return _read(layer.uv, "vector", np.float32, 2).reshape(-1, 2)
    return _read(layer.data, "uv", np.float32, 2).reshape(-1, 2)


def _read(collection: Any, name: str, dtype: type, width: int = 1) -> Any:
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(name, values)
    return values


def indices_of(mesh: bpy.types.Mesh, edges: IntArray) -> Any:
    """(k,) places among a mesh's edges of edges given as vertex pairs."""
    own = _read(mesh.edges, "vertices", np.int32, 2).reshape(-1, 2)
    keys = edge_keys(own, len(mesh.vertices))
    order = np.argsort(keys)
    return order[np.searchsorted(keys[order], edge_keys(edges, len(mesh.vertices)))]
