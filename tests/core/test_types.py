"""What a user's type checker sees of the package as it is installed."""

import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

import hybrid_quad

SOUND = """
import numpy as np
import numpy.typing as npt

import hybrid_quad
from hybrid_quad import Cancelled, InputError, RemeshOptions, RemeshResult, Stroke


def quads_of(points: npt.NDArray[np.float64], faces: list[list[int]], count: int) -> npt.NDArray[np.int32]:
    try:
        result: RemeshResult = hybrid_quad.remesh(points, faces, quads=count, strokes=[Stroke(points[:2], kind="loop")])
    except InputError as error:
        print(error.code, error.elements)
        raise
    except Cancelled:
        return np.zeros((0, 4), np.int32)
    print([defect.code for defect in hybrid_quad.check(points, faces)], result.report["quads"])
    return result.quads


class Shape:
    vertices: list[list[float]] = []
    faces: list[list[int]] = []


options = RemeshOptions(quads=500)
fine = hybrid_quad.subdivide(hybrid_quad.remesh(Shape(), quads=options.quads).vertices, [[0, 1, 2, 3]], levels=1)
normals: npt.NDArray[np.float64] = fine.normals
"""

WRONG = {
    "hybrid_quad.remsh([], [])": "attr-defined",
    'hybrid_quad.remesh([], [], quads="many")': "arg-type",
    "hybrid_quad.remesh(object())": "arg-type",
    "hybrid_quad.repair([], []).triangels": "attr-defined",
}


@pytest.fixture
def checked(tmp_path):
    """A function that checks a user's script strictly, in an environment in which the package is installed."""
    pytest.importorskip("mypy")
    numpy = pytest.importorskip("numpy")
    place = tmp_path / "environment"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", place], check=True, timeout=60)
    packages = Path(sysconfig.get_path("purelib", vars={"base": str(place), "platbase": str(place)}))
    (packages / "hybrid_quad").symlink_to(Path(hybrid_quad.__file__).parent)
    (packages / "others.pth").write_text(str(Path(numpy.__file__).parents[1]) + "\n")

    def check(text):
        script = tmp_path / "script.py"
        script.write_text(text)
        words = [sys.executable, "-m", "mypy", "--strict", "--python-executable", place / "bin" / "python"]
        environment = {"MYPY_CACHE_DIR": str(tmp_path / "cache"), "PATH": ""}
        return subprocess.run(
            [*words, script], capture_output=True, text=True, cwd=tmp_path, env=environment, timeout=250
        )

    return check


@pytest.mark.skipif(sys.platform == "win32", reason="makes links")
def test_a_strict_user_is_content_and_warned_of_mistakes(checked):
    done = checked(SOUND)
    assert done.returncode == 0, done.stdout + done.stderr
    done = checked("import hybrid_quad\n" + "\n".join(WRONG) + "\n")
    for number, kind in enumerate(WRONG.values(), 2):
        assert any(
            line.startswith(f"script.py:{number}:") and f"[{kind}]" in line for line in done.stdout.splitlines()
        ), done.stdout
    assert done.stdout.count("error:") == len(WRONG)
