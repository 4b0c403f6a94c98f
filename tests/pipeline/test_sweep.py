"""The sweep over models: tables, limits, and going on where it stopped."""

import csv
import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import hybrid_quad
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.validation import topology
from support import surfaces

pytest.importorskip("resource")


def sweep(root, out, *arguments, variants=("default",)):
    command = [sys.executable, root / "benchmarks" / "sweep.py", "--out", out, "--no-judge", *map(str, arguments)]
    command += ["--variants", *variants]
    return subprocess.run(command, capture_output=True, text=True, timeout=200, check=False)


def rows(out):
    with (out / "sweep.csv").open() as file:
        return list(csv.DictReader(file))


def obj(path, vertices, faces):
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    path.write_text("\n".join(lines))
    return path


def test_a_table_of_good_and_bad_runs_made_only_once(root, tmp_path):
    good = obj(tmp_path / "torus.obj", *surfaces.torus())
    bad = obj(tmp_path / "moebius.obj", *surfaces.moebius())
    out = tmp_path / "out"
    first = sweep(root, out, good, bad, "--quads", 200, "--settings", "sharp")
    assert first.returncode == 1, first.stderr
    assert "1 of 2 runs are valid" in first.stdout
    table = rows(out)
    assert [(row["model"], row["valid"]) for row in table] == [("torus", "yes"), ("moebius", "input_error")]
    assert int(table[0]["quads"]) > 100
    assert "non_orientable" in table[1]["message"]
    again = sweep(root, out, good, bad, "--quads", 200, "--settings", "sharp")
    assert "0 to do" in again.stdout
    assert rows(out) == table
    packed = tmp_path / "packed.jsonl.xz"
    assert sweep(root, out, good, bad, "--quads", 200, "--settings", "sharp", "--pack", packed).returncode == 0
    elsewhere = sweep(root, tmp_path / "elsewhere", good, bad, "--quads", 200, "--settings", "sharp", "--known", packed)
    assert "0 to do" in elsewhere.stdout
    assert [row["quads"] for row in rows(tmp_path / "elsewhere")] == [row["quads"] for row in table]
    of_another = tmp_path / "of_another"
    of_another.mkdir()
    lines = (out / "results.jsonl").read_text()
    (build,) = {json.loads(line)["build"] for line in lines.splitlines()}
    (of_another / "results.jsonl").write_text(lines.replace(build, "another"))
    also = sweep(root, of_another, good, bad, "--quads", 200, "--settings", "sharp", "--also", "another")
    assert "0 to do" in also.stdout
    assert rows(of_another) == table
    assert "2 to do" in sweep(root, of_another, good, bad, "--quads", 200, "--settings", "sharp").stdout
    more = sweep(root, out, good, "--quads", 200, "--settings", "sharp", "no_sharp")
    assert "2 runs, 1 to do" in more.stdout
    assert more.returncode == 0
    page = (out / "sweep.md").read_text()
    assert page.count("| torus |") == 2
    assert "| 200 | default | 2 | 2 | 0 | 0 | 0 |" in page


def test_runs_that_take_too_long_or_too_much_are_ended(root, tmp_path):
    big = obj(tmp_path / "big.obj", *surfaces.torus(300, 120))
    slow = sweep(root, tmp_path / "slow", big, "--quads", 50000, "--settings", "sharp", "--time-limit", 1)
    assert (slow.returncode, rows(tmp_path / "slow")[0]["valid"]) == (1, "timeout")
    assert "1 s of the processor" in rows(tmp_path / "slow")[0]["message"]
    again = sweep(
        root, tmp_path / "slow", big, "--quads", 50000, "--settings", "sharp", "--again", "timeout", "--threads", 2
    )
    assert "1 runs, 1 to do" in again.stdout
    assert [(row["valid"], row["threads"]) for row in rows(tmp_path / "slow")] == [("yes", "2")]
    large = sweep(root, tmp_path / "large", big, "--quads", 8000, "--settings", "sharp", "--memory-mb", 100)
    assert large.returncode == 1
    assert rows(tmp_path / "large")[0]["valid"] == "memory_limit"


def test_what_a_sanitizer_ends_counts_as_a_crash(root, tmp_path):
    """Runs of a package in a folder, which here ends as one built with a sanitizer does after a finding."""
    folder = tmp_path / "package"
    installed = Path(hybrid_quad.__file__).parent
    shutil.copytree(installed, folder / "hybrid_quad", ignore=shutil.ignore_patterns("__pycache__"))
    good = obj(tmp_path / "torus.obj", *surfaces.torus())
    arguments = (good, "--quads", 100, "--settings", "sharp", "--package", folder, "--memory-mb", 0)
    assert sweep(root, tmp_path / "good", *arguments).returncode == 0
    (folder / "hybrid_quad" / "__main__.py").write_text('raise SystemExit("ERROR: ThreadSanitizer: data race")')
    done = sweep(root, tmp_path / "bad", *arguments)
    assert done.returncode == 1, done.stderr
    assert [(row["valid"], row["message"]) for row in rows(tmp_path / "bad")] == [
        ("crash", "ERROR: ThreadSanitizer: data race")
    ]


def test_a_fixed_part_of_the_whole_sweep(root, models, tmp_path):
    """Every variant on a clean and a dirty model; dirty results are held against the repaired surface."""
    out = tmp_path / "out"
    variants = ("default", "field", "sizes", "features")
    files = [models / "oded_cube.obj", models / "c3d_suzanne.obj"]
    done = sweep(root, out, *files, "--quads", 100, 500, "--settings", "sharp", variants=variants)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "16 of 16 runs are valid" in done.stdout
    assert {row["variant"] for row in rows(out)} == set(variants)


def test_dirty_models_may_be_refused_and_clean_ones_may_not(root, tmp_path):
    collection = tmp_path / "collection"
    collection.mkdir()
    obj(collection / "moebius.obj", *surfaces.moebius())
    obj(collection / "strip.obj", *surfaces.moebius(20, 2))
    (collection / "index.csv").write_text("name,edge_mf,vert_mf\nmoebius,n,y\nstrip,y,y\n")
    arguments = ("--models", collection, "--quads", 100, "--settings", "sharp")
    done = sweep(root, tmp_path / "out", *arguments)
    assert done.returncode == 1
    assert [row["valid"] for row in rows(tmp_path / "out")] == ["refused", "input_error"]
    assert "for non_orientable: 1" in done.stdout
    assert sweep(root, tmp_path / "more", *arguments, "--only", "moebius").returncode == 0


def test_the_repaired_surface_tells_slits_and_sheets_apart(root, tmp_path):
    vertices, faces = surfaces.sphere(3)
    fin = [faces[0][0], faces[0][1], len(vertices)]
    source = obj(tmp_path / "fin.obj", [*vertices, 1.5 * vertices[0]], [*faces, fin])
    target = tmp_path / "repaired.obj"
    command = [sys.executable, root / "benchmarks" / "repaired.py", source, target]
    subprocess.run(command, check=True, timeout=60)
    points, polygons = read_mesh(target)
    assert topology(polygons).euler == (1, 2)
    assert len({tuple(point) for point in points.tolist()}) == len(points)
