"""Symmetry is along the object's own axes, wherever the object is and however it is turned."""

from __future__ import annotations

import json
import math

import bpy
import numpy as np
import pytest
from mathutils import Vector

from hybrid_quad.blender import command
from hybrid_quad.blender.remesh_task import prepare_task
from scenes import (
    activate,
    add_cube,
    add_sphere,
    assert_sound,
    faces_of,
    points_of,
    remesh,
    sharp_edges_of,
    signed_volume,
)
from support.mirroring import assert_mirrored, assert_seam


def assert_symmetric(obj: bpy.types.Object, axes: str) -> None:
    assert_sound(obj)
    points, quads = points_of(obj), np.array(faces_of(obj))
    for letter in axes:
        assert_mirrored(points, quads, "xyz".index(letter))
        assert assert_seam(points, quads, "xyz".index(letter)) > 0


def _volume(obj: bpy.types.Object) -> float:
    return signed_volume(points_of(obj), faces_of(obj))


def planes_of(obj: bpy.types.Object) -> str:
    return json.loads(obj.hybrid_quad.last_report)["symmetry"]["planes"]


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 0.5, 1), (-1, 1, 1), (1, -2, -1)])
def test_planes_are_the_objects_own(scale):
    source = add_cube()
    source.rotation_euler = (0.4, 0.5, 0.6)
    source.location = (5, 6, 7)
    source.scale = scale
    source.hybrid_quad.symmetry_axes = (True, False, True)
    result = remesh()
    assert_symmetric(result, "xz")
    assert planes_of(result) == "xz"
    assert _volume(result) == pytest.approx(_volume(source), rel=1e-3)
    corners = points_of(result, in_world=True)[np.array(faces_of(result))]
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    assert lengths.std() / lengths.mean() < 0.25, "even in the scene, whatever the scale"


def test_a_sheared_object_is_mirrored_in_its_own_space():
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.scene.collection.objects.link(parent)
    parent.scale = (1, 3, 1)
    source = add_sphere()
    source.parent = parent
    source.rotation_euler = (0.4, 0.5, 0.6)
    source.hybrid_quad.symmetry_axes = (False, True, False)
    bpy.context.view_layer.update()
    assert_symmetric(remesh(), "y")


def test_edge_length_is_that_of_the_scene():
    source = add_cube()
    source.scale = (3, 3, 3)
    source.rotation_euler = (0, 0, math.radians(30))
    source.hybrid_quad.target_mode = "LENGTH"
    source.hybrid_quad.edge_length = 0.6
    source.hybrid_quad.symmetry_axes = (True, False, False)
    result = remesh()
    corners = points_of(result, in_world=True)[np.array(faces_of(result))]
    assert np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean() == pytest.approx(0.6, rel=0.1)


@pytest.mark.parametrize("axes", [(False, False, False), (True, False, False)])
def test_guide_lines_come_along(axes):
    source = add_cube(segments=2)
    source.location, source.rotation_euler, source.scale = (1, 2, 3), (0.4, 0.5, 0.6), (1, -2, 3)
    curve = bpy.data.curves.new("Line", "CURVE")
    curve.dimensions = "3D"
    spline = curve.splines.new("POLY")
    spline.points.add(1)
    bpy.context.view_layer.update()
    for point, corner in zip(spline.points, ((1, 1, 1), (1, 1, -1)), strict=True):
        point.co = (*(source.matrix_world @ Vector(corner)), 1)
    line = bpy.data.objects.new("Line", curve)
    bpy.context.scene.collection.objects.link(line)
    source.hybrid_quad.guide_object = line
    source.hybrid_quad.symmetry_axes = axes
    bpy.context.view_layer.update()
    task = prepare_task(source, bpy.context.evaluated_depsgraph_get())
    assert len(task.strokes) == 1
    ends = task.strokes[0].points[[0, -1]]
    distance = np.linalg.norm(task.source.vertices[:, None] - ends, axis=2)
    assert distance.min(axis=0) == pytest.approx(0, abs=1e-5), "at corners of the mesh, in the same space"


def test_auto_finds_the_planes():
    source = add_cube()
    for vertex in source.data.vertices:
        vertex.co.y += 0.3
    source.hybrid_quad.use_auto_symmetry = True
    result = remesh()
    assert_symmetric(result, "xz")
    assert planes_of(result) == "xz"


def test_a_smooth_seam_is_not_marked_sharp_and_a_crease_across_it_is():
    source = add_cube()
    source.hybrid_quad.symmetry_axes = (True, False, False)
    result = remesh()
    points = points_of(result)
    edges = np.array([list(edge) for edge in sharp_edges_of(result)])
    middles = points[edges].mean(axis=1)
    assert (np.sort(np.abs(middles), axis=1)[:, 1] > 1 - 1e-6).all(), "only the cube's own edges"
    assert len(edges) > 12


def test_an_object_beside_its_origin_is_refused():
    source = add_sphere()
    for vertex in source.data.vertices:
        vertex.co.x += 3
    activate(source)
    source.hybrid_quad.symmetry_axes = (True, False, False)
    with pytest.raises(RuntimeError, match="mirror plane x = 0"):
        remesh()


def test_the_batch_command_takes_axes(tmp_path):
    source = add_cube()
    source.hybrid_quad.symmetry_axes = (False, True, False)
    out, report = tmp_path / "out.blend", tmp_path / "r.json"
    arguments = ["--object", "Cube", "--output", str(out), "--report", str(report), "--quiet"]
    for given, planes in (
        ((), "y"),
        (("--symmetry", "xz"), "xz"),
        (("--symmetry", "auto"), "xyz"),
        (("--symmetry", "none"), ""),
    ):
        source.hide_set(False)
        activate(source)
        assert command.main([*arguments, *given]) == 0
        assert json.loads(report.read_text())["symmetry"]["planes"] == planes
    assert command.main([*arguments, "--symmetry", "q"]) == 2
