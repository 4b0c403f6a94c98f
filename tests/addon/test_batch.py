"""batch.py from end to end: a Blender file in, another one out, exit codes."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import bpy
import pytest

import hybrid_quad
from hybrid_quad.blender import command, command_arguments, edge_marks
from hybrid_quad.blender.remesh_task import prepare_task
from hybrid_quad.core.file_places import MeshFileError
from scenes import add_cube, add_object, assert_sound

BATCH = Path(hybrid_quad.__file__).parent / "batch.py"


def _start(blend: Path, *arguments: str, **options) -> subprocess.Popen:
    if bpy.app.binary_path:
        words = [
            bpy.app.binary_path,
            "-b",
            "--factory-startup",
            str(blend),
            "--python-exit-code",
            "1",
            "-P",
            str(BATCH),
            "--",
        ]
    else:  # the package bpy has no program; this is what the program does
        script = (
            "import sys, runpy, bpy\n"
            "bpy.ops.wm.open_mainfile(filepath=sys.argv[1])\n"
            "path, sys.argv = sys.argv[2], ['blender', '--', *sys.argv[3:]]\n"
            "runpy.run_path(path, run_name='__main__')\n"
        )
        words = [sys.executable, "-c", script, str(blend), str(BATCH)]
    return subprocess.Popen(
        [*words, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace", **options
    )


def _run(blend: Path, *arguments: str) -> subprocess.CompletedProcess:
    process = _start(blend, *arguments)
    out, err = process.communicate(timeout=240)
    return subprocess.CompletedProcess(process.args, process.returncode, out, err)


@pytest.fixture
def blend(tmp_path):
    """A file with a cube, and an object without faces."""
    add_object("Nothing", [(0, 0, 0)], [])
    add_cube(quads=250).data.name = "Cube mesh"
    path = tmp_path / "in.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def test_what_comes_along_can_be_chosen(blend, tmp_path):
    for layer in ("One", "Two"):
        bpy.data.meshes["Cube mesh"].uv_layers.new(name=layer)
    bpy.data.objects["Cube"].vertex_groups.new(name="Group")
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    out = tmp_path / "out.blend"
    done = _run(blend, "--object", "Cube", "--no-transfer-uv-maps", "--transfer-vertex-groups", "--output", str(out))
    assert done.returncode == 0, done.stderr
    bpy.ops.wm.open_mainfile(filepath=str(out))
    result = bpy.data.objects["Cube Quads"]
    assert len(result.data.uv_layers) == 0 and [group.name for group in result.vertex_groups] == ["Group"]


def test_a_file_in_a_file_out(blend, tmp_path):
    out, report = tmp_path / "out.blend", tmp_path / "r.json"
    done = _run(
        blend,
        "--object",
        "Cube",
        "--quads",
        "600",
        "--sharp-angle",
        "50",
        "--output",
        str(out),
        "--report",
        str(report),
    )
    assert done.returncode == 0, done.stderr
    record = json.loads(report.read_text())
    assert record["status"] == "ok" and record["options"]["quads"] == 600 and record["options"]["sharp_angle"] == 50
    bpy.ops.wm.open_mainfile(filepath=str(out))
    result = bpy.data.objects[record["object"]]
    assert len(result.data.polygons) == record["quads"]
    assert_sound(result)
    assert bpy.data.objects["Cube"].hide_get() and len(bpy.data.objects["Cube"].data.polygons) == 216
    assert bpy.data.objects["Cube"].hybrid_quad.quads == 600
    assert str(record["quads"]) in done.stdout


def test_replace_and_the_objects_own_settings(blend, tmp_path):
    out, report = tmp_path / "out.blend", tmp_path / "r.json"
    done = _run(blend, "--object", "Cube", "--replace", "--quiet", "--output", str(out), "--report", str(report))
    assert done.returncode == 0, done.stderr
    assert "hybrid_quad" not in done.stdout
    record = json.loads(report.read_text())
    assert record["object"] == "Cube" and record["options"]["quads"] == 250
    bpy.ops.wm.open_mainfile(filepath=str(out))
    assert_sound(bpy.data.objects["Cube"])


SETTINGS_OF_ARGUMENTS = {
    **{source.argument: source.setting for source in edge_marks.SOURCES},
    "guide-annotations": "use_guide_annotations",
    "guide-attribute": "use_guide_attribute",
    "density-attribute": "use_density_attribute",
}


@pytest.mark.parametrize("argument", sorted(SETTINGS_OF_ARGUMENTS))
def test_every_switch_has_an_argument(argument):
    obj, name = add_cube(), SETTINGS_OF_ARGUMENTS[argument]
    for prefix, value in (("--", True), ("--no-", False)):
        setattr(obj.hybrid_quad, name, not value)
        command_arguments.apply_settings(
            obj, command_arguments.command_parser().parse_args(["--object", "Cube", "--output", "o.blend"])
        )
        assert getattr(obj.hybrid_quad, name) is not value
        words = ["--object", "Cube", "--output", "o.blend", prefix + argument]
        command_arguments.apply_settings(obj, command_arguments.command_parser().parse_args(words))
        assert getattr(obj.hybrid_quad, name) is value


def test_guides_and_flow_from_arguments():
    obj = add_cube()
    line = bpy.data.objects.new("Line", bpy.data.curves.new("Line", "CURVE"))
    bpy.data.collections.new("Lines")
    words = (
        "--object Cube --output o.blend --guide-object Line --guide-collection Lines --guide-radius 3 --adaptivity 0.5"
    )
    words += " --field-smoothness 0.25 --anisotropy 2"
    command_arguments.apply_settings(obj, command_arguments.command_parser().parse_args(words.split()))
    settings = obj.hybrid_quad
    assert settings.guide_object == line and settings.guide_collection == bpy.data.collections["Lines"]
    assert (settings.guide_radius, settings.adaptivity) == (3, 0.5)
    assert (settings.field_smoothness, settings.anisotropy) == (0.25, 2)


def test_a_ratio_of_the_faces_is_a_target():
    obj = add_cube(segments=10)  # 600 faces
    command_arguments.apply_settings(
        obj,
        command_arguments.command_parser().parse_args(["--object", "Cube", "--output", "o.blend", "--ratio", "0.5"]),
    )
    assert prepare_task(obj, bpy.context.evaluated_depsgraph_get()).options.quads == 300
    obj.modifiers.new("Subdivision", "SUBSURF").levels = 1
    assert prepare_task(obj, bpy.context.evaluated_depsgraph_get()).options.quads == 1200


def test_a_chord_error_from_arguments_takes_the_place_of_count_and_adaptivity():
    obj = add_cube()
    obj.hybrid_quad.adaptivity = 0.5
    words = "--object Cube --output o.blend --chord-error 0.02 --narrow-quads 1"
    command_arguments.apply_settings(obj, command_arguments.command_parser().parse_args(words.split()))
    assert (obj.hybrid_quad.target_mode, obj.hybrid_quad.narrow_quads) == ("CHORD", 1)
    options = prepare_task(obj, bpy.context.evaluated_depsgraph_get()).options
    assert options.chord_error == pytest.approx(0.02)
    assert (options.adaptivity, options.edge_length, options.narrow_quads) == (0, None, 1)


@pytest.mark.parametrize(
    ("arguments", "code", "status"),
    [
        (["--object", "Nothing"], 1, "input_error"),
        (["--object", "Nobody"], 2, "wrong_usage"),
        (["--object", "Cube", "--guide-object", "Nobody"], 2, "wrong_usage"),
        (["--object", "Cube", "--time-limit", "0.000001"], 4, "time_limit"),
    ],
)
def test_a_failure_writes_a_report_and_nothing_else(blend, tmp_path, arguments, code, status):
    out, report = tmp_path / "out.blend", tmp_path / "r.json"
    out.write_bytes(b"as it was")
    done = _run(blend, *arguments, "--output", str(out), "--report", str(report))
    assert done.returncode == code, done.stderr
    assert out.read_bytes() == b"as it was"
    assert json.loads(report.read_text())["status"] == status
    assert "hybrid_quad: " in done.stderr
    assert sorted(path.name for path in tmp_path.iterdir()) == ["in.blend", "out.blend", "r.json"]


@pytest.mark.parametrize(
    "arguments",
    [
        ["--object", "Cube"],
        ["--object", "Cube", "--output", "nowhere/out.blend"],
        ["--object", "Cube", "--output", "out.obj"],
        ["--object", "Cube", "--output", "out.blend", "--quads", "0"],
        ["--object", "Cube", "--output", "out.blend", "--quads", "many"],
        ["--object", "Cube", "--output", "out.blend", "--sharp-angle", "200"],
        ["--object", "Cube", "--output", "out.blend", "--adaptivity", "2"],
        ["--object", "Cube", "--output", "out.blend", "--anisotropy", "0.5"],
        ["--object", "Cube", "--output", "out.blend", "--quads", "5", "--edge-length", "1"],
        ["--object", "Cube", "--output", "out.blend", "--report", "nowhere/r.json"],
        ["--object", "Cube", "--output", "out.blend", "--report", "both", "--picture", "both"],
    ],
)
def test_wrong_usage_is_status_2(tmp_path, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    add_cube()
    assert command.main(arguments) == 2
    assert list(tmp_path.iterdir()) == []


def test_a_report_does_not_take_the_place_of_the_file_that_was_opened(blend):
    before = blend.read_bytes()
    out = blend.with_name("out.blend")
    for other in (blend, out):
        done = _run(blend, "--object", "Cube", "--output", str(out), "--report", str(other))
        assert done.returncode == 2 and "named twice" in done.stderr
        assert blend.read_bytes() == before and not out.exists()


def test_a_bug_is_status_3(tmp_path, monkeypatch):
    from hybrid_quad.worker import request

    def broken(*_args, **_kwargs):
        raise RuntimeError("made for this test")

    monkeypatch.setattr(request, "remesh_with_options", broken)
    add_cube()
    assert command.main(["--object", "Cube", "--output", str(tmp_path / "out.blend")]) == 3
    assert list(tmp_path.iterdir()) == []


def test_a_picture_and_a_report_of_success_are_there_only_with_the_file(tmp_path, monkeypatch):
    def full(path):
        raise MeshFileError(f"{path}: no space left")

    monkeypatch.setattr(command, "_save", full)
    add_cube(quads=250)
    picture, report = tmp_path / "p.png", tmp_path / "r.json"
    picture.write_bytes(b"as it was")
    arguments = ["--output", str(tmp_path / "out.blend"), "--picture", str(picture), "--report", str(report)]
    assert command.main(["--object", "Cube", *arguments]) == 2
    assert picture.read_bytes() == b"as it was"
    assert json.loads(report.read_text())["status"] != "ok"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["p.png", "r.json"]


def test_terminating_it_leaves_nothing_half_written(blend, tmp_path):
    out, report = tmp_path / "out.blend", tmp_path / "r.json"
    process = _start(blend, "--object", "Cube", "--quads", "1000000", "--output", str(out), "--report", str(report))
    first_line = ""
    while "hybrid_quad:" not in first_line:  # the first sign of progress: the run has begun
        first_line = process.stderr.readline()
        assert first_line, "ended without a sign of progress"
    process.send_signal(signal.SIGTERM)
    started = time.monotonic()
    process.communicate(timeout=60)
    assert time.monotonic() - started < 10
    assert process.returncode == 4
    assert not out.exists()
    assert json.loads(report.read_text())["status"] == "cancelled"


def test_a_file_saved_in_edit_mode_is_taken(tmp_path):
    add_cube(quads=250)
    bpy.ops.object.mode_set(mode="EDIT")
    out = tmp_path / "out.blend"
    assert command.main(["--object", "Cube", "--output", str(out), "--quiet"]) == 0
    assert out.exists()


@pytest.mark.skipif(not hasattr(bpy.utils, "register_cli_command"), reason="from Blender 4.2 on")
def test_blender_knows_the_command():
    assert len(command._handles) == 1


def test_help_is_no_failure(capsys):
    assert command.main(["--help"]) == 0
    assert "--object" in capsys.readouterr().out
    assert os.path.exists(BATCH)
