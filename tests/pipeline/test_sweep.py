"""The sweep over models: tables, limits, and going on where it stopped."""

import csv
import subprocess
import sys

import pytest

from support import surfaces

pytest.importorskip("resource")


def sweep(root, out, *arguments):
    command = [sys.executable, root / "benchmarks" / "sweep.py", "--out", out, "--no-judge", *map(str, arguments)]
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
    more = sweep(root, out, good, "--quads", 200, "--settings", "sharp", "no_sharp")
    assert "2 runs, 1 to do" in more.stdout
    assert more.returncode == 0
    assert (out / "sweep.md").read_text().count("| torus |") == 2


def test_runs_that_take_too_long_or_too_much_are_ended(root, tmp_path):
    big = obj(tmp_path / "big.obj", *surfaces.torus(300, 120))
    slow = sweep(root, tmp_path / "slow", big, "--quads", 8000, "--settings", "sharp", "--time-limit", 0.8)
    assert (slow.returncode, rows(tmp_path / "slow")[0]["valid"]) == (1, "time_limit")
    large = sweep(root, tmp_path / "large", big, "--quads", 8000, "--settings", "sharp", "--memory-mb", 150)
    assert large.returncode == 1
    assert rows(tmp_path / "large")[0]["valid"] == "memory_limit"
