"""Reports of bad meshes: what is in them, what is not, and that they run again to the same."""

import json
import os
import shlex
import subprocess
import sys
import zipfile

import numpy as np
import pytest

from hybrid_quad.batch_jobs import run_asset as run_module
from hybrid_quad.batch_jobs.worker_process import PACKAGE_PARENT
from hybrid_quad.cases.case_file import load_case
from hybrid_quad.cli import exit_codes
from hybrid_quad.cli.main import main
from hybrid_quad.core.mesh_io import read_mesh
from support import surfaces

SECRETS = ("jane", "doe", "secret", "project_x", "hero", "gold")


@pytest.fixture
def private(tmp_path, monkeypatch):
    """A folder whose name, and an .obj file with names and comments, are nobody's business."""
    folder = tmp_path / "Jane Doe" / "secret project_x"
    folder.mkdir(parents=True)
    monkeypatch.chdir(folder)
    vertices, faces = surfaces.torus()
    lines = ["# made by jane", "mtllib project_x.mtl", "o hero", "g secret_group", "usemtl gold"]
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(vertices, float).tolist()]
    lines += ["f " + " ".join(str(int(v) + 1) for v in face) for face in faces]
    (folder / "hero.obj").write_text("\n".join(lines) + "\n")
    return folder


@pytest.fixture
def files(private):
    """Options that name a file of each kind, with comments in them."""
    vertices = np.asarray(surfaces.torus()[0], float)
    ring = [f"v {x} {y} 0.39" for x, y in ((0.6, 0.1), (0.8, 0.0), (0.9, -0.2), (0.8, -0.5))]
    texts = {
        "guides": "\n".join(["# by jane", "o loop_secret", *ring, "l 1 2 3 4", "o hero", "l -4 -3", ""]),
        "density": "# jane\n" + "".join(f"{1 + 0.5 * (x > 0.3)}\n" for x in vertices[:, 0]),
        "frames": "0 0 0 0 0 0 # gold\n" * len(vertices),
        "features": "0 1 # secret\n",
    }
    words = []
    for name, text in texts.items():
        path = private / f"hero_{name}.dat"
        path.write_text(text)
        words += [f"--{name}", str(path)]
    return words


def pack(*arguments):
    return main(["case", *map(str, arguments), "--quiet"])


def described(path):
    with zipfile.ZipFile(path) as archive:
        return json.loads(archive.read("case.json"))


def test_an_anonymous_case_names_nobody(private, files, tmp_path):
    out = tmp_path / "case.zip"
    assert pack("hero.obj", "-o", out, "--quads", 200, "--anonymous", *files) == exit_codes.OK
    with zipfile.ZipFile(out) as archive:
        names = archive.namelist()
        content = b"\n".join([*map(archive.read, names), "\n".join(names).encode(), out.read_bytes()]).lower()
        vertices, polygons = (
            (private / "hero.obj").read_text().count("\nv "),
            (private / "hero.obj").read_text().count("\nf "),
        )
        archive.extract("mesh.off", tmp_path)
    for secret in (*SECRETS, str(tmp_path).lower(), tmp_path.name.lower()):
        assert secret.encode() not in content, secret
    assert set(names) >= {
        "case.json",
        "mesh.off",
        "guides.obj",
        "density.txt",
        "check.json",
        "report.json",
        "quads.off",
    }
    mesh = read_mesh(tmp_path / "mesh.off")
    assert (len(mesh[0]), len(mesh[1].sizes)) == (vertices, polygons)
    assert described(out)["outcome"]["status"] == "ok" and described(out)["origin"] == {}
    assert main(["case", "--replay", str(out), "--quiet"]) == exit_codes.OK


def test_a_case_is_the_run_that_it_is_of(private, files, tmp_path):
    out = tmp_path / "case.zip"
    assert (
        main(["remesh", "hero.obj", str(tmp_path / "quads.off"), "--quads", "200", *files, "--quiet"]) == exit_codes.OK
    )
    assert pack("hero.obj", "-o", out, "--quads", 200, *files) == exit_codes.OK
    case = load_case(out)
    assert case.result == (tmp_path / "quads.off").read_bytes()
    # As it was found, for bugs in reading; and the command that is in it does the same by hand.
    assert case.files["original.obj"] == (private / "hero.obj").read_bytes()
    by_hand = tmp_path / "by_hand"
    by_hand.mkdir()
    with zipfile.ZipFile(out) as archive:
        archive.extractall(by_hand)
    (by_hand / "quads.off").unlink()
    words = shlex.split(described(out)["command"])
    assert words[0] == "hybrid-quad"
    environment = {**os.environ, "PYTHONPATH": str(PACKAGE_PARENT)}
    subprocess.run([sys.executable, "-m", "hybrid_quad", *words[1:]], cwd=by_hand, env=environment, check=True)
    assert (by_hand / "quads.off").read_bytes() == case.result


@pytest.mark.parametrize(
    ("suffix", "text", "status", "code"),
    [
        (".obj", "v 0 0 0\nv 1 0 0\nv 0 1 nan\nf 1 2 3\n", "input_error", "non_finite_vertex"),
        (".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\nf 1 2 0\n", "input_error", "index_out_of_range"),
        (".obj", "", "input_error", "empty_mesh"),
        (".ply", "no ply", "unreadable_file", "unreadable_file"),
    ],
)
def test_what_is_refused_is_refused_again(tmp_path, suffix, text, status, code):
    source, out = tmp_path / f"bad{suffix}", tmp_path / "case.zip"
    source.write_text(text)
    assert pack(source, "-o", out) == exit_codes.OK
    assert (load_case(out).status, load_case(out).code) == (status, code)
    assert main(["case", "--replay", str(out), "--quiet"]) == exit_codes.OK


def test_what_cannot_be_read_cannot_be_anonymous(tmp_path, capfd):
    (tmp_path / "bad.ply").write_text("no ply")
    assert pack(tmp_path / "bad.ply", "-o", tmp_path / "case.zip", "--anonymous") == exit_codes.WRONG_USAGE
    assert "--anonymous" in capfd.readouterr().err
    assert not (tmp_path / "case.zip").exists()


def test_a_crash_is_an_outcome_and_another_outcome_is_noticed(private, tmp_path, monkeypatch, capfd):
    out = tmp_path / "case.zip"
    crash = [sys.executable, "-c", "import os; print('/home/jane/x.so'); os.abort()"]
    with monkeypatch.context() as patch:
        patch.setattr(run_module, "command_of", lambda *_: crash)
        assert pack("hero.obj", "-o", out, "--quads", 100, "--anonymous") == exit_codes.OK
    assert described(out)["outcome"]["status"] == "crashed"
    assert "jane" not in json.dumps(described(out))
    assert main(["case", "--replay", str(out)]) == exit_codes.CANNOT_REMESH
    assert "something else" in capfd.readouterr().err


def test_cases_that_are_none(tmp_path, capfd):
    (tmp_path / "no.zip").write_text("no zip")
    assert main(["case", "--replay", str(tmp_path / "no.zip")]) == exit_codes.WRONG_USAGE
    assert main(["case", "a.obj"]) == main(["case"]) == exit_codes.WRONG_USAGE
    assert main(["case", str(tmp_path / "none.obj"), "-o", str(tmp_path / "case.zip")]) == exit_codes.WRONG_USAGE
    capfd.readouterr()
    evil = tmp_path / "evil.zip"
    with zipfile.ZipFile(evil, "w") as archive:
        archive.writestr("../outside.off", "OFF\n0 0 0\n")
        outcome = {"status": "ok", "code": "ok"}
        case = {"form": 1, "mesh": "../outside.off", "settings": {}, "files": ["../outside.off"], "outcome": outcome}
        archive.writestr("case.json", json.dumps({**case, "version": "0", "machine": {}}))
    assert main(["case", "--replay", str(evil)]) == exit_codes.WRONG_USAGE
    assert "outside" in capfd.readouterr().err
    assert not (tmp_path.parent / "outside.off").exists()
