"""What is painted and marked on real models, through the operator, and what the quads make of it."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import pytest

from hybrid_quad.core.edge_mark_values import SHARP
from hybrid_quad.core.mesh_arrays import as_polygons
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.transfer.edges import add_sharp_by_angle
from scenes import add_object, assert_sound, faces_of, points_of, remesh

MESHES = Path(__file__).resolve().parents[1] / "data" / "meshes"
FLANK = 0.18  # half the height of the painted part of Spot's flank, of which the inner two thirds are measured


def _add_model(name: str, quads: int) -> bpy.types.Object:
    vertices, polygons = read_mesh(MESHES / f"{name}.obj")
    vertices = vertices - 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))  # mirror planes go through the origin
    faces = np.split(polygons.vertices, np.cumsum(polygons.sizes)[:-1])
    obj = add_object("Model", vertices.tolist(), [face.tolist() for face in faces])
    obj.hybrid_quad.quads = quads
    obj.hybrid_quad.use_sharp_angle = False
    return obj


def _paint(obj: bpy.types.Object, name: str, data_type: str, key: str, values: np.ndarray) -> None:
    attribute = obj.data.attributes.new(name, data_type, "POINT")
    attribute.data.foreach_set(key, np.asarray(values, np.float32).ravel())


def _edges_of(obj: bpy.types.Object) -> tuple[np.ndarray, np.ndarray]:
    """Both ends of every edge."""
    points = points_of(obj)
    pairs = np.array([tuple(edge.vertices) for edge in obj.data.edges])
    return points[pairs[:, 0]], points[pairs[:, 1]]


def _vertex_normals(points: np.ndarray, faces: list[tuple[int, ...]]) -> np.ndarray:
    corners = points[np.array([face[:3] for face in faces])]
    normals = np.zeros_like(points)
    for i in range(3):
        np.add.at(
            normals, [face[i] for face in faces], np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        )
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)


def _on_flank(points: np.ndarray, normals: np.ndarray, size: float) -> np.ndarray:
    """On Spot's left side (x > 0), around the middle of her body."""
    near = np.abs(points[:, 1:] + (0.1, 0.1)).max(axis=1) < size
    return near & (normals[:, 0] > 0.5)


def test_edges_run_along_directions_painted_on_a_model():
    obj = _add_model("c3d_spot_triangulated", 2500)
    points = points_of(obj)
    normals = _vertex_normals(points, faces_of(obj))
    slanted = np.array([0.0, np.cos(0.45), np.sin(0.45)])
    on_surface = slanted - (normals @ slanted)[:, None] * normals
    painted = on_surface * _on_flank(points, normals, FLANK)[:, None]
    assert (np.linalg.norm(painted, axis=1) > 0).sum() > 50
    free = remesh()
    free_off = _degrees_off(free, slanted)
    bpy.context.view_layer.objects.active = obj
    obj.hide_set(False)
    _paint(obj, "hybrid_quad_guide", "FLOAT_VECTOR", "vector", painted)
    result = remesh()
    assert_sound(result)
    off = _degrees_off(result, slanted)
    assert len(off) > 40
    assert np.median(off) <= 5
    assert np.median(off) < 0.5 * np.median(free_off)


def _degrees_off(obj: bpy.types.Object, direction: np.ndarray) -> np.ndarray:
    """Of the edges on the measured part of the flank, seen along x, from the nearest of a cross's four directions."""
    begin, end = _edges_of(obj)
    normals = _vertex_normals(points_of(obj), faces_of(obj))
    pairs = np.array([tuple(edge.vertices) for edge in obj.data.edges])
    there = _on_flank(0.5 * (begin + end), normals[pairs].mean(axis=1), FLANK * 2 / 3)
    edges, normal = (end - begin)[there], normals[pairs].mean(axis=1)[there]
    along = direction - (normal @ direction)[:, None] * normal
    cosine = (edges * along).sum(axis=1) / np.linalg.norm(edges, axis=1) / np.linalg.norm(along, axis=1)
    angle = np.degrees(np.arccos(np.clip(np.abs(cosine), 0, 1)))
    return np.minimum(angle, 90 - angle)


@pytest.mark.parametrize("density", [2.0, 0.5])
def test_edges_are_as_long_as_the_density_painted_on_a_model_says(density):
    obj = _add_model("c3d_spot_triangulated", 3000)
    points = points_of(obj)
    # Head and forequarters against the rest, with a transition as wide as a few quads.
    behind = np.clip((points[:, 2] + 0.24) / 0.2 + 0.5, 0, 1)
    _paint(obj, "hybrid_quad_density", "FLOAT", "value", density ** (1 - behind))
    result = remesh()
    assert_sound(result)
    begin, end = _edges_of(result)
    length, place = np.linalg.norm(end - begin, axis=1), 0.5 * (begin + end)[:, 2]
    ratio = np.median(length[place < -0.5]) / np.median(length[place > 0.0])
    assert ratio == pytest.approx(1 / density, rel=0.15)


def _crease(obj: bpy.types.Object) -> np.ndarray:
    """(#edges,) Edges that bend by more than 40 degrees."""
    edges = np.array([tuple(edge.vertices) for edge in obj.data.edges], np.int32)
    marks = np.zeros(len(edges), np.uint16)
    bent = add_sharp_by_angle(marks, points_of(obj), as_polygons(faces_of(obj)), edges, np.radians(40))
    return (bent & SHARP) != 0


def _mark_by(obj: bpy.types.Object, source: str, marked: np.ndarray) -> None:
    if source == "use_marked_sharp":
        obj.data.edges.foreach_set("use_edge_sharp", marked)
    elif source == "use_seams":
        obj.data.edges.foreach_set("use_seam", marked)
    elif source == "use_feature_attribute":
        obj.data.attributes.new("hybrid_quad_feature", "BOOLEAN", "EDGE").data.foreach_set("value", marked)
    else:
        raise ValueError(source)
    obj.data.update()


SOURCES = ["use_marked_sharp", "use_seams", "use_feature_attribute"]


@pytest.mark.parametrize("source", SOURCES)
def test_creases_of_a_part_are_kept_whatever_marks_them(source):
    obj = _add_model("c3d_fandisk", 1500)
    marked = _crease(obj)
    _mark_by(obj, source, marked)
    for other in SOURCES:
        setattr(obj.hybrid_quad, other, other == source)
    points = points_of(obj)
    edges = np.array([tuple(edge.vertices) for edge in obj.data.edges])[marked]
    middles = points[edges].mean(axis=1)
    diagonal = np.linalg.norm(np.ptp(points, axis=0))
    result = remesh()
    assert_sound(result)
    begin, end = _edges_of(result)
    assert _distance_to_segments(middles, begin, end).max() < 0.01 * diagonal
    setattr(obj.hybrid_quad, source, False)
    obj.hide_set(False)
    bpy.context.view_layer.objects.active = obj
    unmarked = remesh()
    begin, end = _edges_of(unmarked)
    assert _distance_to_segments(middles, begin, end).max() > 0.01 * diagonal


def _distance_to_segments(points: np.ndarray, begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    along = end - begin
    square = (along**2).sum(axis=1)
    distances = []
    for point in points:
        share = np.clip(((point - begin) * along).sum(axis=1) / square, 0, 1)
        distances.append(np.linalg.norm(begin + share[:, None] * along - point, axis=1).min())
    return np.array(distances)


@pytest.mark.parametrize("name", ["c3d_spot_triangulated", "c3d_suzanne"])
def test_models_are_mirrored_exactly_in_their_own_space(name):
    obj = _add_model(name, 1000)
    obj.location, obj.scale, obj.rotation_euler = (1, 2, 3), (1.5, 0.5, 1), (0.3, 0.2, 0.1)
    obj.hybrid_quad.symmetry_axes = (True, False, False)
    result = remesh()
    assert_sound(result)
    points = points_of(result)
    images = points * (-1, 1, 1)
    assert sorted(map(tuple, (points + 0.0).tolist())) == sorted(map(tuple, (images + 0.0).tolist()))
    assert (points[:, 0] == 0).sum() > 20
