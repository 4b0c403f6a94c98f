"""Batches as a farm sees them: processes that crash, hang and are killed, and results that are made once."""

import csv
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from hybrid_quad.batch_jobs import run_asset as run_module
from hybrid_quad.batch_jobs import worker_process
from hybrid_quad.batch_jobs.asset import WORK_FOLDER, Asset, BatchPlan, files_of
from hybrid_quad.batch_jobs.asset_status import read_status
from hybrid_quad.batch_jobs.engine import run_locally
from hybrid_quad.cli import exit_codes
from hybrid_quad.cli.main import main
from hybrid_quad.core import native
from hybrid_quad.core.mesh_io import read_mesh, write_mesh
from hybrid_quad.core.validation import violations
from support import surfaces


def write_obj(path, vertices, faces):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(vertices, float).tolist()]
    path.write_text("\n".join([*lines, *("f " + " ".join(str(int(v) + 1) for v in face) for face in faces)]) + "\n")


@pytest.fixture
def meshes(tmp_path):
    """Three meshes that can be remeshed, one that cannot, one that is none."""
    folder = tmp_path / "in"
    folder.mkdir()
    vertices, faces = surfaces.torus()
    for number in range(3):
        write_obj(folder / f"torus{number}.obj", np.asarray(vertices) * [1, 1, 1 + 0.1 * number], faces)
    write_obj(folder / "moebius.obj", *surfaces.moebius())
    (folder / "broken.ply").write_text("no ply")
    return folder


def batch(*arguments):
    return main(["batch", *map(str, arguments), "--quads", "150", "--quiet"])


def statuses(out):
    return {path: json.loads(path.read_text()) for path in sorted(out.rglob("*.hq.json"))}


def identities(out):
    """Files as the system tells them apart: another one in the same place, or new content, is a difference."""
    # Not by rglob: folders of jobs that are running come and go, which os.walk() passes over.
    found = [Path(folder) / name for folder, _, names in os.walk(out) for name in names if name.endswith(".hq.json")]
    return {path: (path.stat().st_ino, path.stat().st_mtime_ns) for path in found}


def readable(out):
    """The same without the asset that is looked at anew each time."""
    return {path: identity for path, identity in identities(out).items() if path.name != "broken.hq.json"}


def assert_sound(path):
    vertices, polygons = read_mesh(path)
    assert violations(vertices, polygons.vertices.reshape(-1, 4)) == []


def test_failures_of_assets_are_no_failure_of_the_batch(meshes, tmp_path):
    out = tmp_path / "out"
    assert batch(meshes, "--output", out, "--jobs", 2) == exit_codes.OK
    found = {status["asset"]: status["status"] for status in statuses(out).values()}
    assert found == {"broken": "unreadable_file", "moebius": "input_error"} | {f"torus{n}": "ok" for n in range(3)}
    for number in range(3):
        assert_sound(out / f"torus{number}.obj")
    assert not (out / "moebius.obj").exists() and not (out / WORK_FOLDER).exists()
    assert statuses(out)[out / "moebius.hq.json"]["code"] == "non_orientable"
    assert batch(meshes, "--output", out, "--fail-above", 40) == exit_codes.OK
    assert batch(meshes, "--output", out, "--fail-above", 39) == exit_codes.CANNOT_REMESH


def test_workers_find_the_compiled_part_where_blenders_extensions_have_it(meshes, tmp_path):
    """In a package of its own, in a folder that only Blender's own process knows."""
    own, wheels, out = tmp_path / "own", tmp_path / "wheels", tmp_path / "out"
    compiled = Path(native.load().__file__)
    package = Path(run_module.__file__).parents[1]
    shutil.copytree(package, own / "hybrid_quad", ignore=shutil.ignore_patterns("*.so", "*.pyd", "__pycache__"))
    (wheels / "hybrid_quad_native").mkdir(parents=True)
    (wheels / "hybrid_quad_native" / "__init__.py").touch()
    shutil.copy(compiled, wheels / "hybrid_quad_native")
    words = ["batch", str(meshes / "torus0.obj"), "--output", str(out), "--quads", "150", "--quiet"]
    code = f"import sys; sys.path[:0] = {[str(own), str(wheels)]}; from hybrid_quad.cli.main import main; main({words})"
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120, env=environment, cwd=tmp_path)
    status = json.loads((out / "torus0.hq.json").read_text())
    assert status["status"] == "ok", status["message"]


@pytest.mark.skipif(sys.platform == "win32", reason="needs a pseudo-terminal")
def test_nothing_but_numpy_is_needed_in_a_terminal_either(tmp_path):
    """As in Blender's Python: all files are read, there is a line for each asset, and the page has its pictures."""
    bare, folder, out = tmp_path / "bare", tmp_path / "in", tmp_path / "out"
    for each in (bare, folder):
        each.mkdir()
    others = ("meshio", "tqdm", "PIL", "trimesh", "distributed", "scipy")
    (bare / "sitecustomize.py").write_text(f"import sys\nfor name in {others}: sys.modules[name] = None\n")
    vertices, faces = surfaces.torus()
    facets = "".join(
        "facet\n" + "".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in vertices[list(face)].tolist())
        for face in faces
    )
    (folder / "b.stl").write_text(f"solid\n{facets}endsolid\n")
    write_mesh(folder / "a.ply", *surfaces.quad_box(3))
    code = f"import sys; sys.path[:0] = {[str(worker_process.PACKAGE_PARENT)]}; from hybrid_quad.cli.main import main; "
    code += f"sys.exit(main({['batch', str(folder), '--output', str(out), '--quads', '150', '--jobs', '1']}))"
    terminal, its_end = os.openpty()
    environment = {**os.environ, "PYTHONPATH": f"{bare}{os.pathsep}{os.environ.get('PYTHONPATH', '')}"}
    done = subprocess.run([sys.executable, "-c", code], stderr=its_end, timeout=120, env=environment)
    said = os.read(terminal, 100_000).decode()
    assert done.returncode == exit_codes.OK, said
    assert {status["status"] for status in statuses(out).values()} == {"ok"}
    assert "[1/2] a: ok" in said and "[2/2] b: ok" in said
    assert (out / "summary.html").read_text().count("<img") == 2


def test_the_summary_has_every_asset(meshes, tmp_path):
    out = tmp_path / "out"
    assert batch(meshes, "--output", out) == exit_codes.OK
    names = ["broken", "moebius", "torus0", "torus1", "torus2"]
    whole = json.loads((out / "summary.json").read_text())
    assert [line["asset"] for line in whole["lines"]] == names
    assert whole["statuses"] == {"ok": 3, "input_error": 1, "unreadable_file": 1}
    rows = list(csv.DictReader((out / "summary.csv").open()))
    assert [row["asset"] for row in rows] == names
    for row in rows[2:]:
        assert len(read_mesh(out / row["result"])[1].sizes) == int(row["quads"])
    page = (out / "summary.html").read_text()
    assert all(name in page for name in names)
    assert not re.search(r'(src|href)="(?!data:)', page) and "<script" not in page
    assert page.count("<img") == 3


def test_what_is_done_is_not_done_again_until_something_changes(meshes, tmp_path):
    out = tmp_path / "out"
    batch(meshes, "--output", out)
    first = identities(out)
    batch(meshes, "--output", out)
    kept = identities(out)
    # What could not even be read is looked at again.
    assert {path.name for path in first if first[path] != kept[path]} <= {"broken.hq.json"}
    write_obj(meshes / "torus0.obj", *surfaces.torus())
    (out / "torus1.obj").unlink()
    with (meshes / "torus2.obj").open("a") as file:
        file.write("# changed\n")
    batch(meshes, "--output", out)
    changed = identities(out)
    assert {path.name for path in kept if kept[path] != changed[path]} >= {"torus1.hq.json", "torus2.hq.json"}
    assert changed[out / "moebius.hq.json"] == kept[out / "moebius.hq.json"]
    assert (out / "torus1.obj").exists()
    assert main(["batch", str(meshes), "--output", str(out), "--quads", "90", "--quiet"]) == exit_codes.OK
    assert all(identities(out)[path] != changed[path] for path in changed)
    assert batch(meshes, "--output", out, "--retry-failed") == exit_codes.OK


def children_of(pid):
    listed = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True).stdout
    return [int(word) for word in listed.split()]


def start(*arguments):
    words = [sys.executable, "-m", "hybrid_quad", "batch", *map(str, arguments), "--quiet"]
    return subprocess.Popen(words, env={**os.environ, "PYTHONPATH": str(worker_process.PACKAGE_PARENT)})


def wait_for(condition, seconds=120):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


@pytest.mark.skipif(sys.platform != "linux", reason="looks at processes by ps")
def test_workers_end_with_a_batch_that_is_killed(meshes, tmp_path):
    for path in meshes.iterdir():
        if path.name != "torus0.obj":
            path.unlink()
    process = start(meshes, "--output", tmp_path / "out", "--quads", 500_000)
    try:
        wait_for(lambda: children_of(process.pid))
        workers = children_of(process.pid)
    finally:
        process.kill()
        process.wait()
    for pid in workers:
        wait_for(lambda pid=pid: not os.path.exists(f"/proc/{pid}") or is_zombie(pid), 20)


def is_zombie(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except FileNotFoundError:
        return True


def test_killed_at_any_moment_it_loses_nothing_and_does_nothing_twice(meshes, tmp_path):
    out, moments = tmp_path / "out", random.Random(5)
    vertices, faces = surfaces.torus()
    for number in range(3, 6):
        write_obj(meshes / f"torus{number}.obj", np.asarray(vertices) * [1, 1, 1 + 0.1 * number], faces)
    good = [f"torus{number}" for number in range(6)]
    finished, kills = {}, 0
    while True:
        process = start(meshes, "--output", out, "--quads", 100, "--jobs", 2)
        # After some progress, so that there is an end however slow the machine is; the first time before any.
        before = len(finished)
        wait_for(lambda: process.poll() is not None or not kills or len(readable(out)) > before)  # noqa: B023
        try:
            process.wait(moments.uniform(0.0, 0.5))
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
            kills += 1
        process.wait()
        now = identities(out)
        for path, identity in finished.items():
            assert now[path] == identity, f"{path} was done again"
        for path, status in statuses(out).items():
            if status["status"] == "ok":  # whatever the moment, what a status file promises is there
                assert_sound(path.with_name(status["result"]))
        finished = readable(out)
        if process.returncode == 0:
            break
        assert kills < 20
    assert kills > 0
    found = {status["asset"]: status["status"] for status in statuses(out).values()}
    assert found == {"broken": "unreadable_file", "moebius": "input_error"} | dict.fromkeys(good, "ok")
    assert sorted(path.stem for path in out.glob("*.obj")) == good
    assert not (out / WORK_FOLDER).exists()


@pytest.fixture
def asset(meshes):
    return Asset("torus", str(meshes / "torus0.obj"), settings={"quads": 150})


class Killed(BaseException):
    """Stands for SIGKILL between two steps."""


@pytest.mark.parametrize(
    "step", ["before the result is moved", "before the status is written", "before it has tidied up"]
)
def test_a_finished_run_whose_end_was_missed_is_taken_over(asset, tmp_path, monkeypatch, step):
    plan = BatchPlan(output=str(tmp_path / "out"))
    files = files_of(asset, plan)

    def killed(*_arguments):
        raise Killed

    name = {
        "before the result is moved": "_publish",
        "before the status is written": "write_status",
        "before it has tidied up": "_tidy_up",
    }[step]
    with monkeypatch.context() as patch:
        patch.setattr(run_module, name, killed)
        with pytest.raises(Killed):
            run_module.run_asset(asset, plan)
    assert files.result.exists() == (step != "before the result is moved")
    assert (read_status(files.status) is None) == (step != "before it has tidied up")
    monkeypatch.setattr(run_module, "run_process", lambda *_, **__: pytest.fail("it was run again"))
    assert run_module.run_asset(asset, plan).status == "ok"
    assert read_status(files.status).result_bytes == files.result.stat().st_size
    assert_sound(files.result)
    assert not list(files.work.parent.iterdir())


@pytest.mark.parametrize(
    ("code", "status"),
    [
        ("import os; os.abort()", "crashed"),
        ("import os, signal; os.kill(os.getpid(), signal.SIGKILL)", "lost"),
        ("import time; time.sleep(600)", "time_limit"),
        ("raise SystemExit(3)", "internal_error"),
        ("raise SystemExit(0)", "crashed"),  # without a result
        pytest.param(
            "x = bytearray(2**31)", "crashed", marks=pytest.mark.skipif(sys.platform != "linux", reason="no hard limit")
        ),
    ],
)
def test_whatever_a_worker_does_the_rest_goes_on(asset, meshes, tmp_path, monkeypatch, code, status):
    plan = BatchPlan(output=str(tmp_path / "out"))
    usual = run_module.command_of

    def command_of(each, *others):
        return [sys.executable, "-c", code] if each.name == "bad" else usual(each, *others)

    monkeypatch.setattr(run_module, "command_of", command_of)
    monkeypatch.setattr(worker_process, "_GRACE", 0.5)
    limits = {"time_limit": 0.5} if status == "time_limit" else {"memory_limit": 100.0}
    bad = Asset("bad", asset.source, settings={"quads": 10, **limits})
    found = {each.asset: each for each in run_locally([bad, asset], plan, 1)}
    assert (found["bad"].status, found["torus"].status) == (status, "ok")
    assert found["bad"].message
    assert read_status(files_of(bad, plan).status) == found["bad"]


def test_a_machine_at_fault_stops_the_batch(meshes, tmp_path):
    out = tmp_path / "out"
    out.write_text("a file")
    assert batch(meshes, "--output", out) == exit_codes.WRONG_USAGE
    assert out.read_text() == "a file"
    assert batch(tmp_path / "nowhere", "--output", tmp_path / "other") == exit_codes.WRONG_USAGE
    blend = meshes / "scene.blend"
    blend.write_text("")
    assert batch(blend, "--output", tmp_path / "other", "--blender", "/nowhere/blender") == exit_codes.WRONG_USAGE


@pytest.mark.parametrize("name", ["list.json", "list.jsonl"])
def test_a_farm_runs_parts_and_one_summary(meshes, tmp_path, name):
    out, listed = tmp_path / "out", tmp_path / name
    assert batch(meshes, "--output", out, "--write-list", listed) == exit_codes.OK
    assert not statuses(out)
    for part in ("0-1", "2-3", "4-5"):
        assert main(["batch", str(listed), "--output", str(out), "--range", part, "--quiet"]) == exit_codes.OK
    assert not (out / "summary.json").exists()
    assert main(["batch", str(listed), "--output", str(out), "--summary-only", "--quiet"]) == exit_codes.OK
    assert json.loads((out / "summary.json").read_text())["statuses"]["ok"] == 3
    # A list says the same as what it was made of.
    before = identities(out)
    batch(meshes, "--output", out)
    assert {path.name for path in before if identities(out)[path] != before[path]} <= {"broken.hq.json"}


def test_terminated_it_ends_and_goes_on_later(meshes, tmp_path):
    out = tmp_path / "out"
    shutil.rmtree(out, ignore_errors=True)
    process = start(meshes / "torus0.obj", "--output", out, "--quads", 500_000)
    wait_for(lambda: list(out.glob(f"{WORK_FOLDER}/*/messages.txt")))
    process.send_signal(signal.SIGTERM)
    assert process.wait(60) == exit_codes.CANCELLED
    assert not statuses(out)
    assert json.loads((out / "summary.json").read_text())["statuses"] == {"pending": 1}
    assert batch(meshes / "torus0.obj", "--output", out) == exit_codes.OK
