"""Runs on meshes that stay in the compiled part: the same as those on arrays, without NumPy."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.cli import exit_codes
from hybrid_quad.cli.main import main
from hybrid_quad.core import held_mesh
from hybrid_quad.core.file_places import MeshFileError
from hybrid_quad.core.mesh_formats import WRITABLE
from hybrid_quad.core.mesh_io import read_mesh, write_mesh
from hybrid_quad.core.options import RemeshOptions
from hybrid_quad.core.validation import violations
from support import surfaces

MODELS = Path(__file__).resolve().parents[1] / "data" / "meshes"


def held(path, options, **more):
    return held_mesh.remesh_held(held_mesh.read_held(path), options, lambda *_: None, **more)


def write_arrays(path, result):
    write_mesh(path, result.vertices, result.quads)


def without_clock(report):
    stages = [stage["name"] for stage in report["stages"]]
    return {**report, "stages": stages}


@pytest.mark.parametrize("name", ["c3d_fandisk", "c3d_suzanne"])
def test_quads_and_report_and_files_are_those_of_arrays(tmp_path, name):
    path = MODELS / f"{name}.obj"
    options = RemeshOptions(quads=700, seed=3)
    found = held(path, options)
    expected = hybrid_quad.remesh(*read_mesh(path), quads=700, seed=3)
    assert np.array_equal(found.vertices, expected.vertices)
    assert np.array_equal(found.quads, expected.quads)
    assert without_clock(found.report) == without_clock(expected.report)
    assert len(found.mesh) == len(expected.quads)
    for name, write in (("held", held_mesh.write_held), ("arrays", write_arrays)):
        for suffix in WRITABLE:
            write(tmp_path / f"{name}{suffix}", found if name == "held" else expected)
    for suffix in WRITABLE:
        assert (tmp_path / f"held{suffix}").read_bytes() == (tmp_path / f"arrays{suffix}").read_bytes()
    rows = [("v %.17g %.17g %.17g", expected.vertices), ("f %d %d %d %d", expected.quads + 1)]
    lines = [form % tuple(row) for form, values in rows for row in values.tolist()]
    assert (tmp_path / "held.obj").read_text().splitlines() == lines


def test_what_is_wrong_with_a_mesh_is_told_in_the_same_words(tmp_path):
    path = tmp_path / "fin.obj"
    vertices, faces = surfaces.torus(12, 8)
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(vertices, float).tolist()] + ["v 3 3 3", "v 9 9 9"]
    lines += ["f " + " ".join(str(int(v) + 1) for v in face) for face in faces]
    a, b = int(faces[0][0]) + 1, int(faces[0][1]) + 1
    lines.append(f"f {b} {a} {len(vertices) + 1}")
    path.write_text("\n".join(lines) + "\n")
    found = held(path, RemeshOptions(quads=100))
    expected = hybrid_quad.remesh(*read_mesh(path), quads=100)
    assert {row["element_kind"] for row in found.report["defects"]} >= {"edge", "vertex"}
    assert found.report["defects"] == expected.report["defects"]
    assert json.loads(json.dumps(found.report["defects"])) == [
        {**defect.as_json()} for defect in hybrid_quad.check(*read_mesh(path)) if defect.repairable
    ]


def test_a_result_passes_both_checks():
    found = held(MODELS / "c3d_fandisk.obj", RemeshOptions(quads=300))
    assert found.mesh.violations() == []
    assert violations(found.vertices, found.quads) == []


def test_distances_are_measured_for_reports_only(tmp_path):
    path = MODELS / "c3d_fandisk.obj"
    names = ("hausdorff_percent", "mean_distance_percent", "feature_hausdorff_percent")
    quick = held(path, RemeshOptions(quads=300), measure_distances=False)
    assert [quick.report[name] for name in names] == [None] * 3
    out, report = tmp_path / "out.obj", tmp_path / "report.json"
    assert main(["remesh", str(path), str(out), "--quads", "300", "--quiet", "--report", str(report)]) == exit_codes.OK
    written = json.loads(report.read_text())
    assert all(written[name] > 0 for name in names)
    with_report = out.read_bytes()
    assert main(["remesh", str(path), str(out), "--quads", "300", "--quiet"]) == exit_codes.OK
    assert out.read_bytes() == with_report


def test_a_run_from_obj_to_obj_needs_no_numpy(tmp_path):
    out = tmp_path / "out.obj"
    code = (
        "import sys\n"
        "sys.modules['numpy'] = None\n"
        "from hybrid_quad.cli.main import main\n"
        f"sys.exit(main(['remesh', {str(MODELS / 'c3d_fandisk.obj')!r}, {str(out)!r}, '--quads', '300']))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    assert done.returncode == exit_codes.OK, done.stderr
    assert "irregular vertices" in done.stderr
    assert violations(read_mesh(out)[0], read_mesh(out)[1].vertices.reshape(-1, 4)) == []


@pytest.mark.parametrize(
    ("path", "options", "expected"),
    [
        ("a.obj", RemeshOptions(), True),
        ("a.OBJ", RemeshOptions(edge_length=1.0, chord_error=0.1), True),
        ("a.obj", RemeshOptions(symmetry="x"), True),
        ("a.ply", RemeshOptions(), False),
        ("a.obj", RemeshOptions(edge_length=1.0), False),
        ("a.obj", RemeshOptions(symmetry="x", symmetry_center="bounds"), False),
    ],
)
def test_what_needs_arrays(path, options, expected):
    assert held_mesh.can_hold(path, options) == expected


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(MeshFileError, match="No such file"):
        held_mesh.read_held(tmp_path / "none.obj")
    (tmp_path / "bad.obj").write_text("v 0 0 zero\n")
    with pytest.raises(MeshFileError, match="line 1"):
        held_mesh.read_held(tmp_path / "bad.obj")
