"""`hybrid-quad batch` on a Blender file with several objects: one worker Blender for each, a library file from each."""

from __future__ import annotations

import json
import zipfile

import bpy
import pytest

from hybrid_quad.blender import command
from scenes import add_cube, add_object, assert_sound


@pytest.fixture
def blend(tmp_path):
    """A file with two cubes, one with a slash in its name, an object without faces and a hidden one."""
    add_cube(quads=120).name = "Cube"
    add_cube(quads=100).name = "Left/Right"
    add_cube(quads=100).name = "Hidden"
    bpy.data.objects["Hidden"].hide_set(True)
    add_object("Empty", [(0, 0, 0)], [])
    path = tmp_path / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def test_the_objects_of_the_open_file_are_listed(blend, tmp_path):
    assert command.main(["--list-objects", str(tmp_path / "objects.json")]) == 0
    assert json.loads((tmp_path / "objects.json").read_text()) == ["Cube", "Left/Right"]


def test_only_the_result_is_saved(blend, tmp_path):
    out, report = tmp_path / "out.blend", tmp_path / "r.json"
    words = ["--object", "Cube", "--output", str(out), "--report", str(report), "--only-result", "--quiet"]
    assert command.main(words) == 0
    name = json.loads(report.read_text())["object"]
    with bpy.data.libraries.load(str(out)) as (inside, wanted):
        assert list(inside.objects) == [name]
        wanted.objects = [name]
    assert_sound(wanted.objects[0])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["out.blend", "r.json", "scene.blend"]


@pytest.mark.skipif(not bpy.app.binary_path, reason="the package bpy has no program")
def test_a_batch_in_blender_of_a_file_with_many_objects(blend, tmp_path):
    out = tmp_path / "out"
    words = ["batch", str(blend), "--output", str(out), "--jobs", "2", "--quiet"]
    assert command.main(words) == 0
    whole = json.loads((out / "summary.json").read_text())
    found = {line["object"]: line for line in whole["lines"]}
    assert {name: line["status"] for name, line in found.items()} == {"Cube": "ok", "Left/Right": "ok"}
    # Each object's own settings are taken.
    assert [found[name]["asked_quads"] for name in ("Cube", "Left/Right")] == [120, 100]
    for line in whole["lines"]:
        assert (out / line["result"]).suffix == ".blend"
    before = {path: path.stat().st_mtime_ns for path in out.rglob("*.hq.json")}
    assert command.main(words) == 0
    assert {path: path.stat().st_mtime_ns for path in out.rglob("*.hq.json")} == before


def test_mesh_files_are_run_and_packed_by_blenders_own_python(tmp_path):
    source, case = tmp_path / "one sided.obj", tmp_path / "case.zip"
    source.write_text("v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n")
    assert command.main(["batch", str(source), "--output", str(tmp_path / "out"), "--quiet"]) == 0
    assert json.loads((tmp_path / "out" / "one sided.hq.json").read_text())["code"] == "non_finite_vertex"
    assert command.main(["case", str(source), "-o", str(case), "--anonymous", "--quiet"]) == 0
    with zipfile.ZipFile(case) as archive:
        assert json.loads(archive.read("case.json"))["outcome"]["code"] == "non_finite_vertex"
    assert command.main(["case", "--replay", str(case), "--quiet"]) == 0
