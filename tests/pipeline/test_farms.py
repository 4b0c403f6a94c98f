"""The same batch on other engines: a Dask cluster that loses a worker, OpenJD's own runner, Flamenco's job type."""

import json
import os
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from hybrid_quad.batch_jobs.asset import WORK_FOLDER, BatchPlan
from hybrid_quad.batch_jobs.job_list import list_assets
from hybrid_quad.batch_jobs.worker_process import PACKAGE_PARENT
from hybrid_quad.cli import exit_codes
from hybrid_quad.cli.main import main
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.validation import violations

ENVIRONMENT = {**os.environ, "PYTHONPATH": str(PACKAGE_PARENT)}


@pytest.fixture
def assets(models, tmp_path):
    """A function that makes a folder of real models, each a little different."""

    def make(count):
        folder = tmp_path / "in"
        folder.mkdir()
        kinds = [models / "oded_cube.obj", models / "hexme_n11o_limit_cycle_g.obj"]
        for number in range(count):
            source = kinds[number % 2]
            vertices, polygons = read_mesh(source)
            lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in (vertices * [1, 1, 1 + 0.01 * number]).tolist()]
            corners = np.split(polygons.vertices + 1, np.cumsum(polygons.sizes)[:-1])
            lines += ["f " + " ".join(map(str, face.tolist())) for face in corners]
            (folder / f"{source.stem}_{number:03}.obj").write_text("\n".join(lines) + "\n")
        return folder

    return make


def assert_all_done(out, count):
    statuses = [json.loads(path.read_text()) for path in sorted(out.rglob("*.hq.json"))]
    assert [status["status"] for status in statuses] == ["ok"] * count
    assert len({status["job_hash"] for status in statuses}) == count
    for status in statuses:
        vertices, polygons = read_mesh(out / status["result"])
        assert violations(vertices, polygons.vertices.reshape(-1, 4)) == []
    whole = json.loads((out / "summary.json").read_text())
    assert [line["asset"] for line in whole["lines"]] == [status["asset"] for status in statuses]
    assert not (out / WORK_FOLDER).exists()


def finished(out):
    return len(list(out.glob("*.hq.json")))


def running(out):
    return list(out.glob(f"{WORK_FOLDER}/*/messages.txt"))


def wait_for(condition, seconds=120):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.02)


@pytest.fixture
def cluster(tmp_path, request):
    """A Dask scheduler with two workers of one thread each, on this machine: its address and the workers.

    The parameter is how many deaths of workers a task may survive (3, as usual).
    """
    pytest.importorskip("distributed")
    file = tmp_path / "scheduler.json"
    environment = {**ENVIRONMENT, "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": str(getattr(request, "param", 3))}

    def start(command, *arguments):
        words = [sys.executable, "-m", "distributed.cli." + command, "--scheduler-file", str(file), *arguments]
        return subprocess.Popen(
            words, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=tmp_path
        )

    processes = [start("dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")]
    try:
        wait_for(file.exists)
        processes += [start("dask_worker", "--nthreads", "1", "--no-nanny", "--no-dashboard") for _ in range(2)]
        yield json.loads(file.read_text())["address"], processes[1:]
    finally:
        for process in processes:
            process.kill()
            process.wait()


def test_a_dask_cluster_that_loses_a_worker(assets, tmp_path, cluster):
    address, workers = cluster
    out, count = tmp_path / "out", 50
    words = [sys.executable, "-m", "hybrid_quad", "batch", str(assets(count)), "--output", str(out), "--quads", "60"]
    batch = subprocess.Popen([*words, "--no-pictures", "--quiet", "--dask", address], env=ENVIRONMENT)
    try:
        # In the middle of a run of its own: each worker has one thread, so two runs at once are one of each.
        wait_for(lambda: batch.poll() is not None or (finished(out) > 5 and len(running(out)) == 2))
        workers[0].kill()
        early = {path: path.stat().st_ino for path in out.glob("*.hq.json")}
        assert len(early) < count
        assert batch.wait(250) == exit_codes.OK
    finally:
        batch.kill()
        batch.wait()
    assert_all_done(out, count)
    assert {path: path.stat().st_ino for path in early} == early


@pytest.mark.parametrize("cluster", [0], indirect=True)
def test_a_task_under_which_a_worker_dies_is_taken_apart(assets, tmp_path, cluster, monkeypatch):
    from distributed import Client

    from hybrid_quad.batch_jobs import dask_engine

    address, workers = cluster
    monkeypatch.setattr(dask_engine, "_TASKS_PER_THREAD", 1)
    plan = BatchPlan(output=str(tmp_path / "out"))
    listed = list_assets([str(assets(10))], {"quads": 60}, plan, lambda _: [])
    assert [len(task) for task in dask_engine.tasks_of(listed, 2)] == [5, 5]
    with Client(address, set_as_default=False) as client:
        client.wait_for_workers(2, timeout=60)

    def kill() -> None:
        wait_for(lambda: finished(tmp_path / "out") > 1 and len(running(tmp_path / "out")) == 2)
        workers[0].kill()

    killer = threading.Thread(target=kill)
    killer.start()
    found = list(dask_engine.run_on_dask(listed, plan, address))
    killer.join()
    assert workers[0].wait() != 0
    assert sorted(status.asset for status in found) == [asset.name for asset in listed]
    assert {status.status for status in found} == {"ok"}


def test_no_cluster_is_said(assets, tmp_path, capfd):
    pytest.importorskip("distributed")
    from hybrid_quad.batch_jobs import dask_engine

    patience, dask_engine._PATIENCE = dask_engine._PATIENCE, 1
    try:
        words = ["batch", str(assets(1)), "--output", str(tmp_path / "out"), "--quiet", "--dask", "tcp://127.0.0.1:9"]
        assert main(words) == exit_codes.WRONG_USAGE
    finally:
        dask_engine._PATIENCE = patience
    assert "tcp://127.0.0.1:9" in capfd.readouterr().err


@pytest.fixture
def program(tmp_path):
    """The command as a file, whatever is on the path."""
    path = tmp_path / "hybrid-quad"
    path.write_text(f'#!/bin/sh\nPYTHONPATH={PACKAGE_PARENT} exec {sys.executable} -m hybrid_quad "$@"\n')
    path.chmod(0o755)
    return path


def test_openjd_runs_the_template(root, assets, tmp_path, program):
    openjd = shutil.which("openjd", path=f"{Path(sys.executable).parent}:{os.environ.get('PATH', '')}")
    if openjd is None:
        pytest.skip("openjd-cli is not installed")
    out, listed, count = tmp_path / "out", tmp_path / "list.jsonl", 5
    main(["batch", str(assets(count)), "--output", str(out), "--quads", "60", "--write-list", str(listed), "--quiet"])
    values = {"JobList": listed, "Output": out, "Assets": f"0-{count - 1}", "ChunkSize": 2, "Program": program}
    template = root / "farm" / "openjd" / "hybrid_quad_batch.yaml"
    words = [openjd, "run", str(template), "--step", "Summary", "--run-dependencies"]
    for name, value in values.items():
        words += ["-p", f"{name}={value}"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=250)
    assert done.returncode == 0, done.stdout + done.stderr
    assert_all_done(out, count)


STUB = """
const fs = require("fs"), vm = require("vm");
const made = { tasks: [] };
class Task {
    constructor(name, type) { Object.assign(this, { name, type, commands: [], dependencies: [] }); }
    addCommand(command) { this.commands.push(command); }
    addDependency(task) { this.dependencies.push(task.name); }
}
const context = {
    author: {
        Task: (name, type) => new Task(name, type),
        Command: (name, parameters) => ({ name, parameters }),
    },
    frameChunker: (text, size) => {
        const [first, last] = text.split("-").map(Number), chunks = [];
        for (let at = first; at <= last; at += size) chunks.push(`${at}-${Math.min(at + size - 1, last)}`);
        return chunks;
    },
    print: () => {},
};
vm.createContext(context);
const script = fs.readFileSync(process.argv[2], "utf8");
vm.runInContext(script + "\\nthis.JOB_TYPE = JOB_TYPE; this.compileJob = compileJob;", context);
const settings = {};
for (const each of context.JOB_TYPE.settings) if ("default" in each) settings[each.key] = each.default;
Object.assign(settings, JSON.parse(process.argv[3]));
for (const each of context.JOB_TYPE.settings) if (!(each.key in settings)) throw new Error(each.key + " is missing");
context.compileJob({ settings, addTask: (task) => made.tasks.push(task) });
console.log(JSON.stringify({ ...made, type: context.JOB_TYPE }));
"""


def test_the_flamenco_job_compiles_to_tasks_that_run(root, assets, tmp_path, program):
    node = shutil.which("node")
    if node is None:
        pytest.skip("Node is not installed")
    out, listed, count = tmp_path / "out", tmp_path / "list.jsonl", 5
    main(["batch", str(assets(count)), "--output", str(out), "--quads", "60", "--write-list", str(listed), "--quiet"])
    (tmp_path / "stub.js").write_text(STUB)
    settings = {"job_list": str(listed), "output": str(out), "assets": "0-4", "chunk_size": 2, "program": str(program)}
    script = root / "farm" / "flamenco" / "hybrid_quad_remesh.js"
    words = [node, str(tmp_path / "stub.js"), str(script), json.dumps(settings)]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    made = json.loads(done.stdout)
    tasks = {task["name"]: task for task in made["tasks"]}
    assert list(tasks) == ["assets 0-1", "assets 2-3", "assets 4-4", "summary"]
    assert sorted(tasks["summary"]["dependencies"]) == sorted(set(tasks) - {"summary"})
    for task in made["tasks"]:
        for command in task["commands"]:
            assert command["name"] == "exec"
            words = [command["parameters"]["exe"], *command["parameters"]["args"]]
            assert subprocess.run(words, timeout=250).returncode == 0
    assert_all_done(out, count)
