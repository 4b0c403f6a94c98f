"""Every mark and border of Blender's that can make edges stay, on a flat grid that gives no other reason to."""

from __future__ import annotations

import bpy
import numpy as np
import pytest

from hybrid_quad.blender import edge_marks
from hybrid_quad.blender.remesh_task import prepare_task
from scenes import add_grid, points_of, remesh

LINE = -1 + 2 * 5 / 12  # of the grid's, not in its middle
WEIGHT = 0.6


def _on_line(obj: bpy.types.Object) -> np.ndarray:
    """(k,) Whether each edge lies on the line x = LINE."""
    x = points_of(obj)[:, 0]
    return np.array([all(abs(x[v] - LINE) < 1e-4 for v in edge.vertices) for edge in obj.data.edges])


def _left(obj: bpy.types.Object) -> np.ndarray:
    return np.array([polygon.center.x < LINE for polygon in obj.data.polygons])


def _set_edges(obj: bpy.types.Object, name: str, property_name: str, data_type: str) -> None:
    values = np.where(_on_line(obj), WEIGHT if data_type == "FLOAT" else 1, 0)
    if property_name in bpy.types.MeshEdge.bl_rna.properties:
        obj.data.edges.foreach_set(property_name, values.astype(np.float32 if data_type == "FLOAT" else np.bool_))
        obj.data.update()
    else:
        obj.data.attributes.new(name, data_type, "EDGE").data.foreach_set("value", values.tolist())


def _edge_values(obj: bpy.types.Object, name: str, property_name: str) -> np.ndarray:
    if property_name in bpy.types.MeshEdge.bl_rna.properties:
        return np.array([getattr(edge, property_name) for edge in obj.data.edges], float)
    attribute = obj.data.attributes.get(name)
    if attribute is None:
        return np.zeros(len(obj.data.edges))
    return np.array([item.value for item in attribute.data], float)


# What Blender's own attribute is called where the edge has no such property.
STORES = {
    "SHARP": ("sharp_edge", "use_edge_sharp", "BOOLEAN"),
    "SEAM": ("uv_seam", "use_seam", "BOOLEAN"),
    "CREASE": ("crease_edge", "crease", "FLOAT"),
    "BEVEL": ("bevel_weight_edge", "bevel_weight", "FLOAT"),
    "FREESTYLE": ("freestyle_edge", "use_freestyle_mark", "BOOLEAN"),
    "FEATURE": ("hybrid_quad_feature", "", "BOOLEAN"),
}


def _mark(obj: bpy.types.Object, identifier: str) -> None:
    mesh = obj.data
    if identifier in STORES:
        _set_edges(obj, *STORES[identifier])
    elif identifier == "MATERIAL":
        for name in ("One", "Two"):
            mesh.materials.append(bpy.data.materials.new(name))
        mesh.polygons.foreach_set("material_index", _left(obj).astype(np.int32))
    elif identifier == "FACE_SET":
        sets = mesh.attributes.new(edge_marks.FACE_SET_ATTRIBUTE, "INT", "FACE")
        sets.data.foreach_set("value", (1 + _left(obj)).tolist())
    else:
        layer = mesh.uv_layers.new(name="Map")
        points, left = points_of(obj), _left(obj)
        for polygon in mesh.polygons:
            for loop in polygon.loop_indices:
                x, y, _ = points[mesh.loops[loop].vertex_index]
                layer.data[loop].uv = (x + 3 * left[polygon.index], y)
    mesh.update()


def _sources() -> list:
    return [pytest.param(source, id=source.identifier) for source in edge_marks.SOURCES]


def _only(settings, *names: str) -> None:
    settings.use_sharp_angle = False
    for source in edge_marks.SOURCES:
        setattr(settings, source.setting, source.setting in names)


@pytest.mark.parametrize("source", _sources())
def test_its_edges_become_edges_of_the_result(source):
    obj = add_grid()
    _mark(obj, source.identifier)
    _only(obj.hybrid_quad, source.setting)
    task = prepare_task(obj, bpy.context.evaluated_depsgraph_get())
    assert len(task.marked_edges) == 12
    assert np.abs(task.source.vertices[task.marked_edges][..., 0] - LINE).max() < 1e-6
    result = remesh()
    points = points_of(result)
    ends = np.array([tuple(edge.vertices) for edge in result.data.edges])[_on_line(result)]
    assert np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1).sum() == pytest.approx(2, rel=1e-3)


@pytest.mark.parametrize("source", _sources())
def test_switched_off_its_edges_are_no_features(source):
    obj = add_grid()
    _mark(obj, source.identifier)
    _only(obj.hybrid_quad)
    assert len(prepare_task(obj, bpy.context.evaluated_depsgraph_get()).marked_edges) == 0


@pytest.mark.parametrize("identifier", sorted(STORES))
def test_marks_and_weights_are_the_results_too(identifier):
    obj = add_grid()
    _mark(obj, identifier)
    source = next(each for each in edge_marks.SOURCES if each.identifier == identifier)
    _only(obj.hybrid_quad, source.setting)
    result = remesh()
    name, property_name, data_type = STORES[identifier]
    values = _edge_values(result, name, property_name)
    assert _on_line(result).any()
    expected = np.where(_on_line(result), WEIGHT if data_type == "FLOAT" else 1, 0)
    assert values == pytest.approx(expected, abs=1e-2)


@pytest.mark.parametrize("identifier", ["MATERIAL", "FACE_SET", "UV_ISLAND"])
def test_borders_are_found_on_a_mirrored_object(identifier):
    obj = add_grid()
    _mark(obj, identifier)
    obj.scale = (-1, 2, 1)
    source = next(each for each in edge_marks.SOURCES if each.identifier == identifier)
    _only(obj.hybrid_quad, source.setting)
    task = prepare_task(obj, bpy.context.evaluated_depsgraph_get())
    assert len(task.marked_edges) == 12
    assert np.abs(task.source.vertices[task.marked_edges][..., 0] + LINE).max() < 1e-6


def test_a_border_without_another_side_is_none():
    obj = add_grid()
    obj.data.uv_layers.new(name="Map")  # every face its own square
    for loop in obj.data.uv_layers[0].data:
        loop.uv = (0, 0)
    _only(obj.hybrid_quad, "use_uv_borders", "use_material_borders")
    assert len(prepare_task(obj, bpy.context.evaluated_depsgraph_get()).marked_edges) == 0


def test_edges_at_which_custom_normals_break_are_marked_and_kept():
    obj = add_grid()
    obj.data.polygons.foreach_set("use_smooth", [True] * len(obj.data.polygons))
    left = _left(obj)
    normals = np.empty((len(obj.data.loops), 3))
    for polygon in obj.data.polygons:
        normals[list(polygon.loop_indices)] = (-0.6, 0, 0.8) if left[polygon.index] else (0.6, 0, 0.8)
    obj.data.normals_split_custom_set(normals.tolist())
    _only(obj.hybrid_quad, "use_marked_sharp")
    task = prepare_task(obj, bpy.context.evaluated_depsgraph_get())
    assert len(task.marked_edges) == 12
    assert np.abs(task.source.vertices[task.marked_edges][..., 0] - LINE).max() < 1e-6
