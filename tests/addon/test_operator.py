"""The operator: same result as the Python call, honest errors, one undo step, nothing else touched."""

from __future__ import annotations

import math

import bpy
import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.core.validation import violations
from scenes import (
    activate,
    add_cube,
    add_grid,
    add_object,
    add_sphere,
    assert_sound,
    faces_of,
    points_of,
    remesh,
    sharp_edges_of,
    signed_volume,
)


def _core_result(obj: bpy.types.Object, **options):
    options = {"quads": obj.hybrid_quad.quads, "sharp_angle": 40.0, **options}
    return hybrid_quad.remesh(points_of(obj), faces_of(obj), **options)


def test_gives_what_the_python_call_gives():
    source = add_sphere()
    expected = _core_result(source)
    result = remesh()
    assert np.array_equal(points_of(result), expected.vertices.astype(np.float32).astype(float))
    assert np.array_equal(np.array(faces_of(result)), expected.quads)


def test_settings_reach_the_run():
    source = add_sphere(quads=200)
    few = len(faces_of(remesh()))
    activate(source).hide_set(False)
    source.hybrid_quad.quads = 1600
    assert len(faces_of(remesh())) > 3 * few
    activate(source)
    source.hybrid_quad.target_mode = "LENGTH"
    source.hybrid_quad.edge_length = 0.25
    result = remesh()
    points, quads = points_of(result), np.array(faces_of(result))
    lengths = np.linalg.norm(points[quads] - points[np.roll(quads, -1, axis=1)], axis=2)
    assert 0.2 < lengths.mean() < 0.3


def test_an_override_of_a_library_has_settings_and_a_mesh_of_its_own(tmp_path):
    library, scene = str(tmp_path / "library.blend"), str(tmp_path / "scene.blend")
    bpy.data.libraries.write(library, {add_cube()})
    with bpy.data.libraries.load(library, link=True) as (theirs, ours):
        ours.objects = list(theirs.objects)
    bpy.context.scene.collection.objects.link(ours.objects[0])
    obj = activate(ours.objects[0].override_create(remap_local_usages=True))
    obj.name = "Override"
    obj.hybrid_quad.quads, obj.hybrid_quad.result_mode = 200, "REPLACE"
    obj.hybrid_quad.transfer.use_parent = False
    faces = len(faces_of(remesh()))
    bpy.ops.wm.save_as_mainfile(filepath=scene)
    bpy.ops.wm.open_mainfile(filepath=scene)
    (obj,) = (each for each in bpy.data.objects if each.override_library)
    assert len(obj.data.polygons) == faces
    assert (obj.hybrid_quad.quads, obj.hybrid_quad.result_mode) == (200, "REPLACE")
    assert obj.hybrid_quad.transfer.use_parent == (bpy.app.version >= (5, 0))  # lost from 5.0 on


@pytest.mark.parametrize(("kind", "hint"), [("FONT", "Convert"), ("EMPTY", "Select a mesh")])
def test_objects_that_are_no_meshes_are_refused_with_what_to_do(kind, hint):
    data = bpy.data.curves.new("Text", kind) if kind == "FONT" else None
    obj = bpy.data.objects.new("Other", data)
    bpy.context.scene.collection.objects.link(obj)
    activate(obj)
    with pytest.raises(RuntimeError, match=hint):
        bpy.ops.object.hybrid_quad_remesh()


def test_new_object_keeps_the_source():
    source = add_sphere()
    source.location = (1, 2, 3)
    source.rotation_euler = (0.1, 0.2, 0.3)
    bpy.context.view_layer.update()
    before = (points_of(source).tolist(), faces_of(source))
    result = remesh()
    assert result is not source and result.data is not source.data
    assert (points_of(source).tolist(), faces_of(source)) == before
    assert source.hide_get() and source.hide_render
    assert not result.hide_get() and not result.hide_render and result.select_get()
    assert np.allclose(result.matrix_world, source.matrix_world)
    assert list(result.users_collection) == list(source.users_collection)
    assert_sound(result)


def test_new_object_keeps_its_place_under_a_parent():
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.location = (5, 0, 0)
    parent.scale = (1, 2, 1)
    source = add_sphere()
    source.parent = parent
    source.rotation_euler = (0.4, 0.5, 0.6)
    bpy.context.view_layer.update()
    result = remesh()
    bpy.context.view_layer.update()
    assert result.parent is parent
    assert np.allclose(result.matrix_world, source.matrix_world)


def test_replace_puts_the_quads_in_the_same_object():
    source = add_sphere()
    source.hybrid_quad.result_mode = "REPLACE"
    name, objects, meshes = source.data.name, len(bpy.data.objects), len(bpy.data.meshes)
    result = remesh()
    assert result is source and source.data.name == name and not source.hide_get()
    assert (len(bpy.data.objects), len(bpy.data.meshes)) == (objects, meshes)
    assert_sound(source)


def test_replace_leaves_other_users_of_the_mesh_alone():
    source = add_sphere()
    shared = source.data
    other = bpy.data.objects.new("Other", shared)
    bpy.context.scene.collection.objects.link(other)
    before = (points_of(other).tolist(), faces_of(other))
    source.hybrid_quad.result_mode = "REPLACE"
    remesh()
    assert other.data is shared and (points_of(other).tolist(), faces_of(other)) == before
    assert source.data is not shared
    assert_sound(source)


@pytest.mark.parametrize("mode", ["NEW", "REPLACE"])
def test_modifiers_are_part_of_what_is_remeshed(mode):
    source = add_cube(segments=2, quads=400)
    source.hybrid_quad.use_sharp_angle = False
    modifier = source.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = 3
    off = source.modifiers.new("Off", "ARRAY")
    off.show_viewport = False
    source.hybrid_quad.result_mode = mode
    result = remesh()
    # Subdivision rounds the cube's corners, which lie sqrt(3) from the middle.
    assert np.linalg.norm(points_of(result), axis=1).max() < 1.4
    assert [m.name for m in result.modifiers] == ["Off"]
    assert_sound(result)


def test_uneven_scale_gives_even_quads_in_the_world():
    source = add_grid(cells=20, quads=400)
    source.scale = (4.0, 1.0, 1.0)
    result = remesh()
    points, quads = points_of(result, in_world=True), np.array(faces_of(result))
    assert np.allclose(points.min(axis=0), (-4, -1, 0), atol=1e-4)
    assert np.allclose(points.max(axis=0), (4, 1, 0), atol=1e-4)
    edges = points[quads] - points[np.roll(quads, -1, axis=1)]
    lengths = np.linalg.norm(edges, axis=2)
    assert np.percentile(lengths, 95) < 2 * np.percentile(lengths, 5)


@pytest.mark.parametrize("scale", [(1, 1, -1), (-2, 1, 1), (-1, -1, -1), (-1, -1, 1)])
def test_mirrored_objects_keep_their_outside(scale):
    source = add_sphere()
    source.scale = scale
    bpy.context.view_layer.update()
    before = signed_volume(points_of(source), faces_of(source))
    result = remesh()
    assert signed_volume(points_of(result), faces_of(result)) == pytest.approx(before, rel=0.1)
    assert_sound(result)


def test_an_object_squashed_flat_is_refused(scene_state):
    source = add_sphere()
    source.scale = (1, 1, 0)
    before = scene_state()
    with pytest.raises(RuntimeError, match="scaled to zero"):
        bpy.ops.object.hybrid_quad_remesh()
    assert scene_state() == before


@pytest.mark.parametrize("vertices", [[], [(0, 0, 0), (1, 0, 0)]])
def test_a_mesh_without_faces_is_refused(scene_state, vertices):
    add_object("Empty", vertices, [])
    before = scene_state()
    with pytest.raises(RuntimeError, match="has no faces"):
        bpy.ops.object.hybrid_quad_remesh()
    assert scene_state() == before


def test_what_the_method_refuses_is_an_error_and_changes_nothing(scene_state):
    # A Moebius strip has no outside.
    count = 24
    angle = np.arange(count) * 2 * math.pi / count
    ring = [
        [
            (math.cos(a) * (1 + w * math.cos(a / 2)), math.sin(a) * (1 + w * math.cos(a / 2)), w * math.sin(a / 2))
            for a in angle
        ]
        for w in (-0.3, 0.3)
    ]
    faces = [(i, i + 1, count + i + 1, count + i) for i in range(count - 1)] + [(count - 1, count, 0, 2 * count - 1)]
    add_object("Moebius", ring[0] + ring[1], faces)
    before = scene_state()
    with pytest.raises(RuntimeError):
        bpy.ops.object.hybrid_quad_remesh()
    assert scene_state() == before


def test_a_bug_of_ours_is_an_error_and_changes_nothing(scene_state, monkeypatch):
    from hybrid_quad.worker import request

    def broken(*_args, **_kwargs):
        raise hybrid_quad.InternalError("made for this test", "nowhere")

    add_sphere()
    before = scene_state()
    monkeypatch.setattr(request, "remesh_with_options", broken)
    with pytest.raises(RuntimeError, match="made for this test"):
        bpy.ops.object.hybrid_quad_remesh()
    assert scene_state() == before


def test_an_invalid_result_never_reaches_the_scene(scene_state, monkeypatch):
    from hybrid_quad.worker import request

    original = request.remesh_with_options

    def with_a_hole_in_a_vertex(*args, **kwargs):
        result = original(*args, **kwargs)
        result.quads[0, 1] = result.quads[0, 0]
        return result

    add_sphere()
    before = scene_state()
    monkeypatch.setattr(request, "remesh_with_options", with_a_hole_in_a_vertex)
    with pytest.raises(RuntimeError, match="no valid quad mesh"):
        bpy.ops.object.hybrid_quad_remesh()
    assert scene_state() == before


def test_edit_mode_is_refused():
    source = add_sphere()
    bpy.ops.object.mode_set(mode="EDIT")
    assert not bpy.ops.object.hybrid_quad_remesh.poll()
    with pytest.raises(RuntimeError, match="Object Mode"):
        bpy.ops.object.hybrid_quad_remesh()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert activate(source) and bpy.ops.object.hybrid_quad_remesh.poll()


def test_sculpt_mode_is_gone_on_with():
    source = add_sphere()
    bpy.ops.object.mode_set(mode="SCULPT")
    result = remesh()
    assert result != source and (result.mode, source.mode) == ("SCULPT", "OBJECT")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert_sound(result)


def test_dyntopo_is_refused():
    add_sphere()
    bpy.ops.object.mode_set(mode="SCULPT")
    bpy.ops.sculpt.dynamic_topology_toggle()
    with pytest.raises(RuntimeError, match="Switch Dyntopo off first"):
        bpy.ops.object.hybrid_quad_remesh()


def test_only_mesh_objects_are_taken():
    assert not bpy.ops.object.hybrid_quad_remesh.poll()
    curve = bpy.data.objects.new("Curve", bpy.data.curves.new("Curve", "CURVE"))
    bpy.context.scene.collection.objects.link(curve)
    activate(curve)
    assert not bpy.ops.object.hybrid_quad_remesh.poll()


@pytest.mark.parametrize("mode", ["NEW", "REPLACE"])
def test_one_undo_takes_it_back(mode):
    source = add_sphere()
    source.hybrid_quad.result_mode = mode
    faces = len(faces_of(source))
    objects = sorted(bpy.data.objects.keys())
    bpy.ops.ed.undo_push(message="before")
    assert bpy.ops.object.hybrid_quad_remesh("EXEC_DEFAULT", True) == {"FINISHED"}
    assert mode == "NEW" or len(faces_of(bpy.data.objects["Sphere"])) != faces
    bpy.ops.ed.undo()
    assert sorted(bpy.data.objects.keys()) == objects
    assert len(faces_of(bpy.data.objects["Sphere"])) == faces
    assert not bpy.data.objects["Sphere"].hide_get()


def test_sharp_edges_by_angle_are_kept_and_marked():
    add_cube()
    result = remesh()
    points, sharp = points_of(result), sharp_edges_of(result)
    on_an_edge_of_the_cube = (np.abs(np.abs(points) - 1) < 1e-4).sum(axis=1) >= 2
    assert on_an_edge_of_the_cube[sharp].all()
    # All twelve edges, each two long.
    assert np.linalg.norm(points[sharp[:, 0]] - points[sharp[:, 1]], axis=1).sum() == pytest.approx(24, rel=1e-4)


def test_no_sharp_edges_where_none_are_asked():
    source = add_sphere()
    source.hybrid_quad.use_sharp_angle = False
    assert len(sharp_edges_of(remesh())) == 0


def _mark_middle_line(obj: bpy.types.Object, name: str) -> None:
    """Marks the edges of a grid on the line x = 0."""
    flags = [all(abs(obj.data.vertices[v].co.x) < 1e-6 for v in edge.vertices) for edge in obj.data.edges]
    assert any(flags)
    if name == "hybrid_quad_feature":
        obj.data.attributes.new(name, "BOOLEAN", "EDGE").data.foreach_set("value", flags)
    else:
        obj.data.edges.foreach_set(name, flags)
        obj.data.update()


@pytest.mark.parametrize(
    ("mark", "setting"),
    [
        ("use_edge_sharp", "use_marked_sharp"),
        ("use_seam", "use_seams"),
        ("hybrid_quad_feature", "use_feature_attribute"),
    ],
)
def test_marked_edges_are_kept_and_marked_alike(mark, setting):
    source = add_grid()
    _mark_middle_line(source, mark)
    setattr(source.hybrid_quad, setting, True)
    result = remesh()
    if mark == "hybrid_quad_feature":
        attribute = result.data.attributes[mark]
        flags = [item.value for item in attribute.data]
    else:
        flags = [getattr(edge, mark) for edge in result.data.edges]
    marked = np.array([tuple(edge.vertices) for edge, flag in zip(result.data.edges, flags, strict=True) if flag])
    points = points_of(result)
    assert len(marked) and np.abs(points[marked][:, :, 0]).max() < 1e-4
    lengths = np.linalg.norm(points[marked[:, 0]] - points[marked[:, 1]], axis=1)
    assert lengths.sum() == pytest.approx(2.0, rel=1e-3)


@pytest.mark.parametrize("mark", ["use_edge_sharp", "hybrid_quad_feature"])
def test_marks_that_are_switched_off_are_not_features(mark):
    source = add_grid()
    _mark_middle_line(source, mark)
    source.hybrid_quad.use_marked_sharp = False
    source.hybrid_quad.use_feature_attribute = False
    result = remesh()
    assert len(sharp_edges_of(result)) == 0
    assert "hybrid_quad_feature" not in result.data.attributes


def test_materials_and_shading_come_from_the_surface_below():
    source = add_cube()
    for name in ("Rest", "Top"):
        source.data.materials.append(bpy.data.materials.new(name))
    for polygon in source.data.polygons:
        polygon.material_index = int(polygon.center.z > 0.99)
        polygon.use_smooth = polygon.center.z < -0.99
    result = remesh()
    assert [material.name for material in result.data.materials] == ["Rest", "Top"]
    for polygon in result.data.polygons:
        assert polygon.material_index == int(polygon.center.z > 0.99)
        assert polygon.use_smooth == (polygon.center.z < -0.99)


def test_the_report_stays_with_the_object():
    from hybrid_quad.blender.result_mesh import read_report

    add_sphere()
    result = remesh()
    report = read_report(result)
    assert report["quads"] == len(faces_of(result))
    assert report["status"] == "ok"


def test_a_repaired_mesh_is_reported():
    from hybrid_quad.blender.result_mesh import read_report

    source = add_sphere()
    source.data.vertices.add(1)
    source.data.vertices[-1].co = (3, 3, 3)
    source.data.update()
    result = remesh()
    assert [defect["code"] for defect in read_report(result)["defects"]] == ["isolated_vertex"]
    assert_sound(result)
    assert points_of(result).max() < 1.5


def test_polygons_of_any_size_are_taken():
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, end_fill_type="NGON")
    bpy.context.object.hybrid_quad.quads = 300
    result = remesh()
    assert_sound(result)
    assert not violations(points_of(result), np.array(faces_of(result)))


def test_twice_the_same_result():
    source = add_sphere()
    first = remesh()
    activate(source)
    second = remesh()
    assert first is not second
    assert points_of(first).tolist() == points_of(second).tolist() and faces_of(first) == faces_of(second)
