"""The previews without a window: what is computed of which object, when it is computed anew, and that nothing is left behind."""

from __future__ import annotations

import time

import bpy
import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.blender import result_features
from hybrid_quad.blender.preview import drawing, sessions
from scenes import activate, add_cube, add_grid, add_sphere, points_of, remesh

PATIENCE = 60  # seconds until a test gives up waiting


def show(**switches: bool) -> None:
    asked = bpy.context.window_manager.hybrid_quad_preview
    for name, value in switches.items():
        setattr(asked, name, value)


def settle() -> None:
    """Waits until nothing goes on any more."""
    sessions.step(at_once=True)
    deadline = time.monotonic() + PATIENCE
    while sessions.field.session.is_busy or sessions.limit.session.is_busy:
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.01)
        sessions.step(at_once=True)


def shapes_of_field():
    return sessions.field.shapes(bpy.context.window_manager.hybrid_quad_preview)


@pytest.fixture(autouse=True)
def leaves_nothing():
    handlers = list(bpy.app.handlers.depsgraph_update_post)
    yield
    show(show_field=False, show_limit=False, show_quads=False)
    assert not drawing.is_on()
    assert not sessions.field.session.is_busy
    assert list(bpy.app.handlers.depsgraph_update_post) == handlers


def test_the_field_of_a_sphere_has_eight_singularities_on_its_surface():
    obj = add_sphere()
    obj.location, obj.scale = (3, 1, 2), (2, 2, 2)
    bpy.context.view_layer.update()
    show(show_field=True)
    settle()
    assert sessions.field.counts() == [(1, 8)]
    assert sessions.field.session.target() == obj
    for shape in (shape for shape in shapes_of_field() if len(shape.points)):
        distances = np.linalg.norm(shape.points, axis=1)
        assert distances.min() > 0.8 and distances.max() < 1.2
        assert len(shape.colors) == len(shape.points)


def test_switches_choose_what_is_shown():
    add_cube()
    show(show_field=True)
    settle()
    everything = len(shapes_of_field())
    show(show_crosses=False)
    assert len(shapes_of_field()) == everything - 1
    show(show_features=False)
    assert len(shapes_of_field()) == everything - 2
    show(show_crosses=True, show_features=True)


def test_quad_lines_come_after_the_field():
    add_sphere(quads=300)
    show(show_field=True, show_quads=True)
    settle()
    lines = sessions.field.session.result.quads
    assert 400 < len(lines) < 900
    np.testing.assert_allclose(np.linalg.norm(lines, axis=2), 1.0, atol=0.1)


def test_a_change_of_settings_or_mesh_is_followed_and_other_objects_are_not():
    grid, cube = add_grid(), add_cube()
    activate(grid)
    show(show_field=True)
    settle()
    first = sessions.field.session.result
    cube.location.x = 5
    bpy.context.view_layer.update()
    assert not sessions.field.session.is_busy
    grid.hybrid_quad.quads = 800
    settle()
    second = sessions.field.session.result
    assert second is not first and second.report["wanted_quads"] == pytest.approx(800)
    grid.data.vertices[0].co.z = 1
    grid.data.update()
    bpy.context.view_layer.update()
    assert sessions.field.session.is_busy
    settle()
    assert sessions.field.session.result.features[..., 2].max() > 0.9
    activate(cube)
    settle()
    assert sessions.field.session.target() == cube and len(sessions.field.session.result.features) > 0


def test_one_worker_answers_all_changes_of_the_field():
    obj = add_sphere()
    show(show_field=True)
    settle()
    seat = sessions.field.session._seat
    for quads in (300, 350):
        obj.hybrid_quad.quads = quads
        settle()
        assert sessions.field.session.result.report["wanted_quads"] == pytest.approx(quads)
    obj.hybrid_quad.quads = 200_000
    sessions.step(at_once=True)
    assert sessions.field.session._worker is not None
    obj.hybrid_quad.quads = 400  # while it is at work
    settle()
    assert sessions.field.session.result.report["wanted_quads"] == pytest.approx(400)
    assert sessions.field.session._seat is seat and seat.is_there() and seat.requests == 5
    show(show_field=False)
    assert not seat.is_there()


def test_views_are_drawn_anew_for_results_and_not_for_news(monkeypatch):
    obj = add_sphere()
    show(show_field=True)
    settle()
    told, views = [], []
    monkeypatch.setattr(sessions, "redraw_sidebars", lambda: told.append(sessions.field.session.status))
    monkeypatch.setattr(sessions, "redraw", lambda: views.append(sessions.field.session.result))
    obj.hybrid_quad.quads += 100
    settle()
    assert views == [sessions.field.session.result] and told


def test_the_time_in_which_the_window_is_drawn_after_a_change_counts_as_calm():
    obj = add_grid()
    show(show_field=True)
    settle()
    session = sessions.field.session
    obj.hybrid_quad.quads += 100
    obj.update_tag()  # as the panel does
    bpy.context.view_layer.update()
    assert session._changed_at is not None
    session._changed_at -= 1.0
    sessions.step()
    assert session._worker is not None
    settle()


def test_sculpt_mode_is_followed_and_edit_mode_when_it_is_left():
    obj = add_grid()
    show(show_field=True)
    settle()
    for mode in ("SCULPT", "EDIT"):
        bpy.ops.object.mode_set(mode=mode)
        obj.hybrid_quad.quads += 100
        before = sessions.field.session.result
        sessions.step(at_once=True)
        if mode == "EDIT":
            assert sessions.field.session.status == "Waiting"
            bpy.ops.object.mode_set(mode="OBJECT")
        settle()
        assert sessions.field.session.result is not before, mode


def test_an_object_without_a_surface_says_so():
    obj = add_grid()
    obj.scale.x = 0
    bpy.context.view_layer.update()
    show(show_field=True)
    settle()
    assert "scaled to zero" in sessions.field.session.error and not shapes_of_field()


def test_guides_are_shown():
    obj = add_grid()
    attribute = obj.data.attributes.new("hybrid_quad_guide", "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", np.tile([1.0, 1.0, 0.0], len(obj.data.vertices)))
    show(show_field=True)
    settle()
    assert len(sessions.field.session.result.guides) == len(obj.data.vertices)


def test_deleting_the_object_and_loading_a_file_end_the_preview():
    add_sphere()
    show(show_field=True)
    settle()
    bpy.ops.object.delete()
    settle()
    assert sessions.field.session.result is None and sessions.field.session.target() is None
    add_sphere()
    settle()
    assert shapes_of_field()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    assert not bpy.context.window_manager.hybrid_quad_preview.show_field and not drawing.is_on()


def test_disabling_the_add_on_ends_the_worker():
    obj = add_sphere()
    obj.hybrid_quad.quads = 200_000
    show(show_field=True, show_quads=True)
    sessions.step(at_once=True)
    worker = sessions.field.session._worker
    hybrid_quad.unregister()
    assert worker.wait(5) and not worker.has_result
    assert not drawing.is_on()
    hybrid_quad.register()


def test_the_limit_surface_of_a_result_is_measured_to_its_source():
    source = add_sphere(quads=300)
    source.location.x = 4
    result = remesh()
    assert result.hybrid_quad.source_name == source.name
    show(show_limit=True)
    settle()
    assert not sessions.limit.session.error
    (shape,) = sessions.limit.shapes(None)
    assert len(shape.indices) == 2 * 16 * len(result.data.polygons)
    inside = 1.0 - np.linalg.norm(shape.points, axis=1).min()
    distance = sessions.limit.distance
    assert distance.largest == pytest.approx(inside, abs=0.02)
    assert 0 < distance.mean < distance.largest < 0.2
    show(limit_levels=1)
    settle()
    assert len(sessions.limit.shapes(None)[0].indices) == 2 * 4 * len(result.data.polygons)
    show(limit_levels=2)


def test_fitting_brings_the_limit_surface_nearer():
    source = add_sphere(quads=200)
    show(show_limit=True)
    found = []
    for fit in (False, True):
        activate(source)
        source.hide_set(False)
        source.hybrid_quad.fit_limit_surface = fit
        activate(source)
        remesh()
        settle()
        found.append(sessions.limit.distance.mean)
    assert found[1] < 0.5 * found[0]


def test_features_of_a_result_are_creases_of_its_limit_surface_and_of_the_modifier():
    add_cube(quads=200)
    result = remesh()
    edges, corners = result_features.features_of(result.data)
    assert len(corners) == 8 and len(edges) > 12
    show(show_limit=True)
    settle()
    assert sessions.limit.distance.percent < 0.5
    assert bpy.ops.object.hybrid_quad_apply_subdivision(levels=2) == {"FINISHED"}
    modifier = result.modifiers[-1]
    assert (modifier.type, modifier.levels, modifier.use_creases) == ("SUBSURF", 2, True)
    shown = result.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    points = np.array([tuple(v.co) for v in shown.vertices])
    np.testing.assert_allclose(np.abs(points).max(axis=1), 1.0, atol=0.02)
    assert bpy.ops.object.hybrid_quad_apply_subdivision(levels=1) == {"FINISHED"}
    assert [each.type for each in result.modifiers].count("SUBSURF") == 1


def test_without_a_source_the_limit_surface_is_shown_all_the_same():
    obj = add_cube(segments=2)
    show(show_limit=True)
    settle()
    assert sessions.limit.distance is None
    (shape,) = sessions.limit.shapes(None)
    assert np.linalg.norm(shape.points, axis=1).max() < 0.9 * np.linalg.norm(points_of(obj), axis=1).max()
