"""Directions and densities from attributes, edges, curves, grease pencils and annotations."""

from __future__ import annotations

import json
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from hybrid_quad.blender import guide_lines
from hybrid_quad.blender.remesh_task import prepare_task
from hybrid_quad.worker import request
from scenes import activate, add_cube, add_grid, points_of, remesh

MATRIX = np.array([[2, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1]], float)


def _task(obj):
    bpy.context.view_layer.update()
    return prepare_task(obj, bpy.context.evaluated_depsgraph_get())


def _paint(obj, name: str, domain: str, values) -> None:
    data_type, key = ("FLOAT", "value") if np.ndim(values) == 1 else ("FLOAT_VECTOR", "vector")
    attribute = obj.data.attributes.new(name, data_type, domain)
    attribute.data.foreach_set(key, np.asarray(values, np.float32).ravel())


def _angle_to(vectors: np.ndarray, direction) -> np.ndarray:
    """Degrees between crosses: 0 where a vector runs along the direction or square to it, in the plane z = 0."""
    angle = np.arctan2(vectors[:, 1], vectors[:, 0]) - np.arctan2(direction[1], direction[0])
    return np.degrees(np.abs((angle + np.pi / 4) % (np.pi / 2) - np.pi / 4))


def test_painted_directions_move_with_the_object_and_keep_their_strength():
    obj = add_grid()
    painted = np.zeros((len(obj.data.vertices), 3))
    painted[::2] = 0.5 * np.array([1, 1, 0]) / np.sqrt(2)
    painted[1] = (0, 3, 0)
    _paint(obj, "hybrid_quad_guide", "POINT", painted)
    obj.scale, obj.rotation_euler, obj.location = (2, 1, 1), (0, 0, np.pi / 2), (5, 5, 5)
    guides = _task(obj).guides()
    assert guides.shape == painted.shape
    assert guides[::2] == pytest.approx(
        np.tile(0.5 * np.array([-1, 2, 0]) / np.sqrt(5), (len(guides[::2]), 1)), abs=1e-6
    )
    assert guides[1] == pytest.approx([-1, 0, 0], abs=1e-6)
    assert not guides[3::2].any()


def test_painted_directions_of_faces_are_one_for_each_face():
    obj = add_grid()
    _paint(obj, "hybrid_quad_guide", "FACE", np.tile([0.0, 1.0, 0.0], (len(obj.data.polygons), 1)))
    guides = _task(obj).guides()
    assert guides == pytest.approx(np.tile([0.0, 1.0, 0.0], (len(obj.data.polygons), 1)))


def test_directions_of_faces_go_to_vertices_where_there_are_as_many():
    bpy.ops.mesh.primitive_torus_add()
    obj = bpy.context.object
    assert len(obj.data.polygons) == len(obj.data.vertices)
    painted = np.zeros((len(obj.data.polygons), 3))
    painted[7] = (0, 0, 0.5)
    _paint(obj, "hybrid_quad_guide", "FACE", painted)
    guides = _task(obj).guides()
    assert sorted(np.flatnonzero(guides.any(axis=1))) == sorted(obj.data.polygons[7].vertices)
    assert guides[list(obj.data.polygons[7].vertices)] == pytest.approx(np.tile([0, 0, 0.5], (4, 1)))


def test_attributes_come_through_modifiers():
    obj = add_grid(cells=3)
    _paint(obj, "hybrid_quad_guide", "POINT", np.tile([0.0, 1.0, 0.0], (len(obj.data.vertices), 1)))
    _paint(obj, "hybrid_quad_density", "POINT", np.full(len(obj.data.vertices), 2.0))
    obj.modifiers.new("Twice", "ARRAY")
    task = _task(obj)
    assert len(task.source.vertices) == 2 * len(obj.data.vertices)
    assert (task.guides() == [0, 1, 0]).all() and (task.source.density == 2).all()


def test_density_that_says_nothing_is_neutral():
    obj = add_grid()
    values = np.zeros(len(obj.data.vertices))
    _paint(obj, "hybrid_quad_density", "POINT", values)
    assert _task(obj).source.density is None
    values[:4] = 2, 0.5, -1, np.nan
    obj.data.attributes["hybrid_quad_density"].data.foreach_set("value", values.astype(np.float32))
    obj.data.update()
    density = _task(obj).source.density
    assert density[:4].tolist() == [2, 0.5, 1, 1] and (density[4:] == 1).all()


def test_attributes_of_another_kind_are_left_alone():
    obj = add_grid()
    _paint(obj, "hybrid_quad_guide", "CORNER", np.ones((len(obj.data.loops), 3)))
    _paint(obj, "hybrid_quad_density", "FACE", np.full(len(obj.data.polygons), 2.0))
    task = _task(obj)
    assert task.guides() is None and task.source.density is None
    for name in ("hybrid_quad_guide", "hybrid_quad_density"):
        assert any(name in sentence for sentence in task.ignored)
    told = json.loads(remesh().hybrid_quad.last_report)["warnings"]
    assert set(task.ignored) <= set(told)


def test_attributes_of_the_form_that_is_read_are_not_told_of():
    obj = add_grid()
    _paint(obj, "hybrid_quad_guide", "FACE", np.ones((len(obj.data.polygons), 3)))
    _paint(obj, "hybrid_quad_density", "POINT", np.full(len(obj.data.vertices), 2.0))
    assert _task(obj).ignored == ()


def test_what_is_switched_off_is_not_asked(monkeypatch):
    obj = add_grid()
    _paint(obj, "hybrid_quad_guide", "POINT", np.ones((len(obj.data.vertices), 3)))
    _paint(obj, "hybrid_quad_density", "POINT", np.full(len(obj.data.vertices), 2.0))
    asked = {}
    monkeypatch.setattr(request, "violations", lambda *_: [])
    result = SimpleNamespace(vertices=None, quads=None)
    monkeypatch.setattr(request, "remesh_with_options", lambda *_, **more: asked.update(more) or result)
    _task(obj).solve()
    assert len(asked["guides"]) == len(asked["density"]) == len(obj.data.vertices)
    obj.hybrid_quad.use_guide_attribute = obj.hybrid_quad.use_density_attribute = False
    asked.clear()
    _task(obj).solve()
    assert asked["guides"] is None and asked["density"] is None


def _line_points() -> np.ndarray:
    """A straight line over the square [-1, 1]^2, at 30 degrees to its sides."""
    return np.linspace(-0.8, 0.8, 9)[:, None] * [np.cos(np.pi / 6), np.sin(np.pi / 6), 0] + [0, 0, 0.1]


def _add(name: str, data) -> bpy.types.Object:
    obj = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(obj)
    return obj


def _curve(kind: str, points: np.ndarray) -> bpy.types.Object:
    data = bpy.data.curves.new("Line", "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new(kind)
    if kind == "BEZIER":
        spline.bezier_points.add(len(points) - 1)
        for point, place in zip(spline.bezier_points, points, strict=True):
            point.co = place
            point.handle_left_type = point.handle_right_type = "VECTOR"
    else:
        spline.points.add(len(points) - 1)
        for point, place in zip(spline.points, points, strict=True):
            point.co = (*place, 1)
        spline.use_endpoint_u = True
    return _add("Line", data)


def _thick_curve(points: np.ndarray) -> bpy.types.Object:
    obj = _curve("POLY", points)
    obj.data.bevel_depth = 0.3
    return obj


def _mesh_line(points: np.ndarray) -> bpy.types.Object:
    mesh = bpy.data.meshes.new("Line")
    mesh.from_pydata(points.tolist(), [(i, i + 1) for i in range(len(points) - 1)], [])
    return _add("Line", mesh)


def _hair(points: np.ndarray) -> bpy.types.Object:
    data = bpy.data.hair_curves.new("Line")
    if not hasattr(data, "add_curves"):
        pytest.skip("scripts cannot make hair curves in this Blender")
    data.add_curves([len(points)])
    data.attributes["position"].data.foreach_set("vector", points.astype(np.float32).ravel())
    return _add("Line", data)


def _pencil(points: np.ndarray) -> bpy.types.Object:
    data = getattr(bpy.data, "grease_pencils_v3", bpy.data.grease_pencils).new("Line")
    obj = _add("Line", data)
    layer = data.layers.new("Layer")
    frame = layer.frames.new(1)
    hidden = data.layers.new("Hidden")
    hidden.hide = True
    for each, places in ((frame, points), (hidden.frames.new(1), np.flip(points, 1))):
        if hasattr(each, "drawing"):
            each.drawing.add_strokes([len(places)])
            each.drawing.attributes["position"].data.foreach_set("vector", places.astype(np.float32).ravel())
        else:
            stroke = each.strokes.new()
            stroke.display_mode = "3DSPACE"
            stroke.points.add(len(places))
            stroke.points.foreach_set("co", places.astype(np.float32).ravel())
    return obj


MAKERS = {
    "poly": lambda points: _curve("POLY", points),
    "bezier": lambda points: _curve("BEZIER", points),
    "nurbs": lambda points: _curve("NURBS", points),
    "thick": _thick_curve,
    "mesh": _mesh_line,
    "hair": _hair,
    "pencil": _pencil,
}


@pytest.mark.parametrize("maker", sorted(MAKERS))
@pytest.mark.parametrize("by", ["object", "collection"])
def test_quads_near_a_line_are_guided_along_it(maker, by):
    if by == "collection" and maker == "mesh":
        pytest.skip("models in a collection are no lines")
    line = MAKERS[maker](_line_points())
    matrix = np.linalg.inv(MATRIX)
    if maker in ("poly", "mesh"):
        line.data.transform(_blender_matrix(matrix))
        line.matrix_world = _blender_matrix(MATRIX)
    before = sorted(bpy.data.objects.keys()), sorted(bpy.data.curves.keys()), sorted(bpy.data.meshes.keys())
    obj = add_grid(cells=30)
    if by == "object":
        obj.hybrid_quad.guide_object = line
    else:
        collection = bpy.data.collections.new("Lines")
        bpy.context.scene.collection.children.link(collection)
        collection.objects.link(line)
        obj.hybrid_quad.guide_collection = collection
    obj.hybrid_quad.guide_objects_strength = 0.7
    obj.hybrid_quad.guide_radius = 2
    guides = _task(obj).guides()
    length = np.linalg.norm(guides, axis=1)
    points, along = points_of(obj), np.array([np.cos(np.pi / 6), np.sin(np.pi / 6)])
    away = np.abs(points[:, 0] * along[1] - points[:, 1] * along[0])
    inside = np.abs(points[:, :2] @ along) < 0.6
    edge = np.sqrt(4 / obj.hybrid_quad.quads)
    assert (length[(away < 0.5 * edge) & inside] > 0.5).all()
    assert not length[away > 2 * edge].any()
    assert 0.6 < length.max() <= 0.7 + 1e-6
    assert _angle_to(guides[length > 0], along).max() < 0.5
    now = sorted(bpy.data.objects.keys()), sorted(bpy.data.curves.keys()), sorted(bpy.data.meshes.keys())
    assert set(now[0]) - set(before[0]) == {"Grid"} and now[1] == before[1] and set(now[2]) - set(before[2]) == {"Grid"}


def _blender_matrix(matrix: np.ndarray):
    from mathutils import Matrix

    return Matrix(matrix.tolist())


def test_guide_objects_say_what_their_lines_are_for():
    obj = add_grid(cells=30)
    loop, ring = _mesh_line(_line_points()), _curve("POLY", _line_points() + np.array([0, 0.3, 0]))
    loop["hybrid_quad_guide_kind"] = "loop"
    collection = bpy.data.collections.new("Lines")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(ring)
    obj.hybrid_quad.guide_object, obj.hybrid_quad.guide_collection = loop, collection
    obj.hybrid_quad.guide_objects_kind = "RING"
    obj.hybrid_quad.quads = 2000
    task = _task(obj)
    assert [(stroke.kind, len(stroke.points)) for stroke in task.strokes] == [("loop", 9), ("ring", 9)]
    assert task.guides() is None
    guides = task.solve().report["guides"]
    assert [(guide["kind"], guide["met"]) for guide in guides] == [("loop", True), ("ring", True)]


def test_a_moved_objects_guides_lie_where_its_surface_is():
    line = _curve("POLY", _line_points() + np.array([7, 0, 0]))
    obj = add_grid(cells=30)
    obj.location = (7, 0, 0)
    obj.hybrid_quad.guide_object = line
    length = np.linalg.norm(_task(obj).guides(), axis=1)
    assert length[np.abs(points_of(obj)).max(axis=1) < 0.05].min() > 0.8


def test_an_object_without_lines_guides_nothing():
    obj = add_grid()
    obj.hybrid_quad.guide_object = _add("Empty", None)
    assert _task(obj).guides() is None
    assert any('"Empty"' in sentence for sentence in _task(obj).ignored)


def test_guide_edges_guide_and_are_not_kept():
    obj = add_grid()
    flags = [all(abs(obj.data.vertices[v].co.x) < 1e-6 for v in edge.vertices) for edge in obj.data.edges]
    obj.data.edges.foreach_set("use_seam", flags)
    obj.data.update()
    obj.hybrid_quad.guide_marks = {"SEAM"}
    obj.hybrid_quad.guide_marks_strength = 0.5
    task = _task(obj)
    guides = task.guides()
    assert len(task.marked_edges) == 0
    on_line = np.abs(points_of(obj)[:, 0]) < 1e-6
    assert np.linalg.norm(guides[on_line], axis=1).min() > 0.4
    assert _angle_to(guides[on_line], (0, 1)).max() < 0.1
    obj.hybrid_quad.use_seams = True
    task = _task(obj)
    assert len(task.marked_edges) == 12 and task.guides() is None


def test_drawn_and_painted_guides_come_together():
    obj = add_cube(segments=7)  # as many faces as it takes that the counts differ
    assert len(obj.data.polygons) != len(obj.data.vertices)
    painted = np.zeros((len(obj.data.polygons), 3))
    painted[[polygon.center.z < -0.99 for polygon in obj.data.polygons]] = (0.0, 1.0, 0.0)
    _paint(obj, "hybrid_quad_guide", "FACE", painted)
    obj.hybrid_quad.guide_object = _curve("POLY", _line_points() + np.array([0, 0, 1]))
    guides, points = _task(obj).guides(), points_of(obj)
    assert len(guides) == len(points)
    assert guides[points[:, 2] < -0.99] == pytest.approx(np.tile([0.0, 1.0, 0.0], ((points[:, 2] < -0.99).sum(), 1)))
    on_top = (points[:, 2] > 0.99) & (np.abs(points[:, :2]).max(axis=1) < 0.9)
    drawn = guides[on_top & (np.linalg.norm(guides, axis=1) > 0)]
    assert len(drawn) and _angle_to(drawn, (np.cos(np.pi / 6), np.sin(np.pi / 6))).max() < 0.5


def _annotations(points: np.ndarray):
    """Annotations of the scene; a stand-in with the same members where Blender lets no script draw them (4.3 to 5.0)."""
    scene = bpy.context.scene
    groups = getattr(bpy.data, "annotations", bpy.data.grease_pencils)
    data = groups.new("Notes")
    layer = data.layers.new("Layer")
    frame = layer.frames.new(1)
    if hasattr(frame.strokes, "new"):
        stroke = frame.strokes.new()
        stroke.display_mode = "3DSPACE"
        stroke.points.add(len(points))
        stroke.points.foreach_set("co", points.astype(np.float32).ravel())
        on_screen = frame.strokes.new()
        on_screen.display_mode = "2DSPACE" if hasattr(scene, "annotation") else "SCREEN"
        setattr(scene, "annotation" if hasattr(scene, "annotation") else "grease_pencil", data)
        return scene, layer

    class Points(list):
        def foreach_get(self, _name, values):
            values[:] = points.ravel()

    stroke = SimpleNamespace(points=Points(points))
    layer = SimpleNamespace(annotation_hide=False, frames=[SimpleNamespace(frame_number=1, strokes=[stroke])])
    return SimpleNamespace(annotation=SimpleNamespace(layers=[layer]), frame_current=5), layer


def test_annotation_strokes_are_lines():
    scene, layer = _annotations(_line_points())
    lines = guide_lines.lines_of_annotations(scene)
    assert len(lines) == 1 and lines[0] == pytest.approx(_line_points(), abs=1e-6)
    layer.annotation_hide = True
    assert guide_lines.lines_of_annotations(scene) == []


def test_annotations_guide_where_asked():
    scene, _ = _annotations(_line_points())
    if scene is not bpy.context.scene:
        pytest.skip("scripts cannot draw annotations in this Blender")
    obj = activate(add_grid(cells=30))
    assert _task(obj).guides() is None
    obj.hybrid_quad.use_guide_annotations = True
    guides = _task(obj).guides()
    guided = guides[np.linalg.norm(guides, axis=1) > 0]
    assert len(guided) and _angle_to(guided, (np.cos(np.pi / 6), np.sin(np.pi / 6))).max() < 0.5


def test_no_annotations_no_lines():
    assert guide_lines.lines_of_annotations(bpy.context.scene) == []
