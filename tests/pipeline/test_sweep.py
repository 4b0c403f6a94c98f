"""The sweep over models: tables, limits, and going on where it stopped."""

import csv
import importlib.util
import json
import re
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

# Knows nothing of meshes: finds fault with one result, and with another only by samples.
JUDGE = """
class Topology:
    def components(self): ...
triangulate = feature_edges = count_inverted = lambda *_: None
read_obj = lambda path: (str(path), ())
weld = lambda *mesh: mesh
FAILED = {"torus_100_sharp.obj": ["no_doublets"], "torus_200_sharp.obj": ["no_inverted"]}
def judge(vertices, faces, result, *_):
    return {"failed": FAILED.get(result.split("/")[-1], []), "inverted": 0}
"""

ALWAYS_REFUSES = """
import json, pathlib, sys
report = {"status": "input_error", "code": "non_orientable", "message": "No.", "elements": [0]}
pathlib.Path(sys.argv[sys.argv.index("--report") + 1]).write_text(json.dumps(report))
sys.exit(1)
"""


def sweep(root, out, *arguments, variants=("default",), judge=None):
    command = [sys.executable, root / "benchmarks" / "sweep.py", "--out", out, *map(str, arguments)]
    command += ["--variants", *variants, *(["--judge", judge] if judge else ["--no-judge"])]
    return subprocess.run(command, capture_output=True, text=True, timeout=200, check=False)


def real_judge(root):
    """None where it is not beside the repository, or what it needs is not there."""
    judge = root.parent / "shared" / "judge" / "judge_quads.py"
    return judge if judge.exists() and all(map(importlib.util.find_spec, ("scipy", "igl"))) else None


@pytest.fixture
def fake_judge(tmp_path):
    path = tmp_path / "judge.py"
    path.write_text(JUDGE)
    return path


def rows(out):
    with (out / "sweep.csv").open() as file:
        return list(csv.DictReader(file))


def obj(path, vertices, faces):
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + ["f " + " ".join(str(v + 1) for v in face) for face in faces]
    path.write_text("\n".join(lines))
    return path


def ball_with_a_fin(path):
    vertices, faces = surfaces.sphere(3)
    fin = [faces[0][0], faces[0][1], len(vertices)]
    return obj(path, [*vertices, 1.5 * vertices[0]], [*faces, fin])


def refusals(folder, **codes):
    """A table of the models that are to be refused."""
    path = folder / "expected.csv"
    path.write_text("\n".join(["model,code", *map(",".join, codes.items())]))
    return path


def package_in(folder):
    installed = Path(hybrid_quad.__file__).parent
    shutil.copytree(installed, folder / "hybrid_quad", ignore=shutil.ignore_patterns("__pycache__"))
    return folder


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
    folder = package_in(tmp_path / "package")
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
    """Every variant of clean and broken models; what is repaired is held against the repaired surface."""
    collection, judge = tmp_path / "collection", real_judge(root)
    collection.mkdir()
    for name in ("oded_cube", "c3d_suzanne"):
        shutil.copy(models / f"{name}.obj", collection)
    ball_with_a_fin(collection / "fin.obj")
    obj(collection / "moebius.obj", *surfaces.moebius())
    vertices, faces = surfaces.sphere(3)
    obj(collection / "beyond.obj", vertices, [*faces, [0, 1, len(vertices)], [-1, 0, 1]])
    expected = refusals(tmp_path, moebius="non_orientable", beyond="index_out_of_range")
    arguments = ("--models", collection, "--expected", expected)

    variants = ("default", "field", "sizes", "features")
    done = sweep(root, tmp_path / "all", *arguments, "--quads", 100, variants=variants, judge=judge)
    assert done.returncode == 0, done.stdout + done.stderr
    table = rows(tmp_path / "all")
    assert {(row["setting"], row["variant"]) for row in table} == {
        (setting, variant) for setting in ("sharp", "no_sharp") for variant in variants
    }
    assert sum(row["valid"] == "refused" for row in table) == 16
    judged = {"ok", "samples"} if judge else {"not asked"}
    assert all(row["judge"] in judged for row in table if row["valid"] != "refused")

    more = sweep(root, tmp_path / "more", *arguments, "--quads", 2000, judge=judge)
    assert more.returncode == 0, more.stdout + more.stderr


def test_refusals_are_those_that_are_expected(root, tmp_path):
    collection, out = tmp_path / "collection", tmp_path / "out"
    collection.mkdir()
    obj(collection / "moebius.obj", *surfaces.moebius())
    obj(collection / "torus.obj", *surfaces.torus())
    arguments = ("--models", collection, "--quads", 100, "--settings", "sharp")

    def seen(**expected):
        """With what is expected: the exit status and what the runs came to."""
        done = sweep(root, out, *arguments, "--expected", refusals(tmp_path, **expected))
        return done.returncode, *(row["valid"] for row in rows(out))

    assert seen(moebius="non_orientable") == (0, "refused", "yes")
    page = (out / "sweep.md").read_text()
    assert "| refused | wrongly refused | not refused | other |" in page
    assert "| 100 | default | 2 | 1 | 0 | 1 | 0 | 0 | 0 |" in page
    head, _, *short = (out / "sweep_short.md").read_text().splitlines()
    assert head == "| model | outcome | quads | CPU s | peak MB |"
    assert short[0].startswith("| moebius | refused: `non_orientable` |  | 0.")
    assert re.fullmatch(r"\| torus \| valid \| \d+ \| \d+\.\d \| \d+ \|", short[1])
    assert "for non_orientable: 1" in page
    # What is stored is held against the table as it is now.
    assert "2 runs, 0 to do" in sweep(root, out, *arguments).stdout
    assert seen() == (1, "wrongly refused", "yes")
    assert "| 100 | default | 2 | 1 | 0 | 0 | 1 | 0 | 0 |" in (out / "sweep.md").read_text()
    assert seen(moebius="not_a_surface") == (1, "wrongly refused", "yes")
    assert seen(moebius="non_orientable", torus="no_area") == (1, "refused", "not refused")
    # Files of a collection are held against it too, others against nothing.
    for folder, status in ((collection, "wrongly refused"), (tmp_path, "input_error")):
        done = sweep(root, out, collection / "moebius.obj", "--models", folder, *arguments[2:])
        assert (done.returncode, rows(out)[0]["valid"]) == (1, status)


def test_a_command_that_always_refuses_is_noticed(root, tmp_path):
    collection, folder = tmp_path / "collection", package_in(tmp_path / "package")
    collection.mkdir()
    obj(collection / "moebius.obj", *surfaces.moebius())
    obj(collection / "torus.obj", *surfaces.torus())
    (collection / "index.csv").write_text("name,defect\nmoebius,made\ntorus,made\n")  # as of the broken models
    (folder / "hybrid_quad" / "__main__.py").write_text(ALWAYS_REFUSES)
    arguments = ("--models", collection, "--quads", 100, "--settings", "sharp", "--package", folder)
    for code, status in (("non_orientable", "refused"), ("not_a_surface", "wrongly refused")):
        done = sweep(root, tmp_path / "out", *arguments, "--expected", refusals(tmp_path, moebius=code))
        assert done.returncode == 1, done.stderr
        assert [row["valid"] for row in rows(tmp_path / "out")] == [status, "wrongly refused"]


def test_the_table_of_refusals_is_that_of_the_documentation(root):
    with (root / "benchmarks" / "expected_refusals.csv").open() as file:
        expected = {row["model"]: row["code"] for row in csv.DictReader(file)}
    page = (root / "docs" / "robustness.md").read_text()
    assert dict(re.findall(r"^\| (\w+) \| refused: `(\w+)` \|", page, re.MULTILINE)) == expected
    assert len(expected) == 14


def test_what_the_judge_says_beside_our_own_validation(root, fake_judge, tmp_path):
    out = tmp_path / "out"
    good = obj(tmp_path / "torus.obj", *surfaces.torus())
    done = sweep(root, out, good, "--quads", 100, 200, judge=fake_judge)
    assert done.returncode == 1, done.stderr
    assert "failed check no_doublets: 1" in done.stdout
    columns = ("asked", "setting", "valid", "own checks", "judge", "failed checks")
    said = [
        ("100", "sharp", "invalid", "ok", "failed", "no_doublets"),
        ("100", "no_sharp", "yes", "ok", "ok", ""),
        ("200", "sharp", "valid but for samples", "ok", "samples", "no_inverted"),
        ("200", "no_sharp", "yes", "ok", "ok", ""),
    ]
    assert [tuple(row[name] for name in columns) for row in rows(out)] == said
    assert "| invalid | ok | failed | no_doublets |" in (out / "sweep.md").read_text()
    packed, elsewhere = tmp_path / "packed.jsonl.xz", tmp_path / "elsewhere"
    sweep(root, out, good, "--quads", 100, 200, "--pack", packed)
    known = sweep(root, elsewhere, good, "--quads", 100, 200, "--known", packed, judge=fake_judge)
    assert "4 runs, 0 to do" in known.stdout
    assert [tuple(row[name] for name in columns) for row in rows(elsewhere)] == said


def test_a_judge_that_is_not_there_is_no_judge_that_agrees(root, tmp_path):
    good = obj(tmp_path / "torus.obj", *surfaces.torus())
    done = sweep(root, tmp_path / "out", good, "--quads", 100, judge=tmp_path / "none.py")
    assert done.returncode == 2
    assert done.stderr.startswith("no judge at ") and "--no-judge" in done.stderr
    assert not (tmp_path / "out" / "sweep.csv").exists()


def test_going_on_makes_again_what_was_not_judged_or_had_other_limits(root, fake_judge, tmp_path):
    out = tmp_path / "out"
    files = obj(tmp_path / "torus.obj", *surfaces.torus()), obj(tmp_path / "moebius.obj", *surfaces.moebius())

    def to_do(*arguments, judge=fake_judge):
        done = sweep(root, out, *files, "--quads", 200, "--settings", "no_sharp", *arguments, judge=judge)
        return int(re.search(r"(\d+) to do", done.stdout)[1])

    assert to_do(judge=None) == 2
    assert [row["judge"] for row in rows(out)] == ["not asked", "not asked"]
    assert "the judge was not asked: 1" in (out / "sweep.md").read_text()
    assert to_do() == 1  # of what was refused there is nothing to judge
    assert [row["judge"] for row in rows(out)] == ["ok", "not asked"]
    assert to_do() == to_do(judge=None) == 0
    assert to_do("--time-limit", 50) == 2
    assert to_do("--time-limit", 50, "--memory-mb", 4000) == 2
    # Results of before these were stored count as what they are.
    stored = [json.loads(line) for line in (out / "results.jsonl").read_text().splitlines()]
    for row in stored:
        del row["judged"], row["limits"]
    (out / "results.jsonl").write_text("".join(json.dumps(row) + "\n" for row in stored))
    assert to_do() == 0
    assert [row["judge"] for row in rows(out)] == ["ok", "not asked"]


def test_a_line_that_a_kill_cut_short_does_not_swallow_the_next(root, tmp_path):
    good, out = obj(tmp_path / "torus.obj", *surfaces.torus()), tmp_path / "out"
    arguments = (good, "--quads", 100)
    assert "2 to do" in sweep(root, out, *arguments).stdout
    results = out / "results.jsonl"
    results.write_bytes(results.read_bytes()[:-30])
    assert "2 runs, 1 to do" in sweep(root, out, *arguments).stdout
    assert "2 runs, 0 to do" in sweep(root, out, *arguments).stdout


def test_the_repaired_surface_tells_slits_and_sheets_apart(root, tmp_path):
    source = ball_with_a_fin(tmp_path / "fin.obj")
    target = tmp_path / "repaired.obj"
    command = [sys.executable, root / "benchmarks" / "repaired.py", source, target]
    subprocess.run(command, check=True, timeout=60)
    points, polygons = read_mesh(target)
    assert topology(polygons).euler == (1, 2)
    assert len({tuple(point) for point in points.tolist()}) == len(points)
