"""`case --object` packs what a run of an object would be given, so that the case comes to the same quads."""

from __future__ import annotations

import json
import zipfile

import bpy
import numpy as np
import pytest

from hybrid_quad.blender import command
from hybrid_quad.blender.case_command import write_files
from hybrid_quad.blender.remesh_task import prepare_task
from hybrid_quad.cli.main import main as package_main
from hybrid_quad.core.mesh_io import read_mesh
from scenes import add_cube


def pack(obj, path, *flags):
    return command.main(["case", "--object", obj.name, "-o", str(path), "--quiet", *flags])


def test_the_quads_of_a_case_are_those_of_the_object(tmp_path):
    obj = add_cube(quads=150)
    obj.name = "Secret Name"
    settings = obj.hybrid_quad
    settings.use_sharp_angle, settings.use_marked_sharp, settings.field_smoothness = False, True, 0.8
    for edge in list(obj.data.edges)[:4]:
        edge.use_edge_sharp = True
    attribute = obj.data.attributes.new("hybrid_quad_density", "FLOAT", "POINT")
    attribute.data.foreach_set("value", np.linspace(0.7, 1.5, len(obj.data.vertices)))
    obj.modifiers.new("Subdivision", "SUBSURF").subdivision_type = "SIMPLE"
    wanted = prepare_task(obj, bpy.context.evaluated_depsgraph_get()).solve()
    case = tmp_path / "case.zip"
    assert pack(obj, case, "--anonymous") == 0
    with zipfile.ZipFile(case) as archive:
        content = b"".join(archive.read(name) for name in archive.namelist())
        described = json.loads(archive.read("case.json"))
        archive.extract("quads.off", tmp_path)
    assert b"Secret" not in content and str(tmp_path).encode() not in content
    assert described["outcome"]["status"] == "ok"
    assert described["settings"].keys() == {"quads", "no_sharp", "field_smoothness", "features", "density"}
    vertices, polygons = read_mesh(tmp_path / "quads.off")
    assert np.array_equal(vertices, wanted.vertices)
    assert np.array_equal(polygons.vertices.reshape(-1, 4), wanted.quads)
    assert package_main(["case", "--replay", str(case), "--quiet"]) == 0


def test_lines_regions_and_lengths_are_packed_too(tmp_path):
    obj = add_cube(quads=150)
    settings = obj.hybrid_quad
    settings.target_mode, settings.edge_length = "LENGTH", 0.3
    settings.use_guide_annotations = False
    bpy.ops.curve.primitive_nurbs_path_add()
    curve = bpy.context.object
    settings.guide_object, settings.guide_objects_kind = curve, "LOOP"
    request = prepare_task(obj, bpy.context.evaluated_depsgraph_get()).request()
    assert request.strokes
    written = write_files(request, tmp_path)
    assert written["edge_length"] == pytest.approx(0.3) and "quads" not in written
    lines = (tmp_path / "guides.obj").read_text().splitlines()
    assert lines[0] == "o loop_" and sum(line.startswith("v ") for line in lines) == len(request.strokes[0].points)
    vertices, polygons = read_mesh(tmp_path / "object.off")
    assert np.array_equal(vertices, request.vertices) and np.array_equal(polygons.vertices, request.polygons.vertices)


def test_an_object_that_is_not_there_is_said(tmp_path, capfd):
    add_cube(quads=100)
    assert command.main(["case", "--object", "Nobody", "-o", str(tmp_path / "case.zip")]) == 2
    assert "Nobody" in capfd.readouterr().err
    assert not (tmp_path / "case.zip").exists()
