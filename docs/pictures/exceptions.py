"""Takes the pictures of docs/exceptions.md: the input around a badly shaped quad beside the quads' edges there.

    blender -b --factory-startup --python-exit-code 1 -P docs/pictures/exceptions.py -- FOLDER [--size N] [--samples N]

For each FOLDER/NAME.npz, which benchmarks/exceptions.py leaves, writes NAME.png where it is not there yet. Orange: quads with a scaled
Jacobian of zero or less. Red: lines that are kept.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "lib"))

from stage import FEATURES, FEWER, INPUT, LINES, Stage, save_side_by_side  # noqa: E402

VIEW = (38.0, 25.0)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--size", type=int, default=230, help="width of one of the two views in pixels")
    parser.add_argument("--samples", type=int, default=8)
    arguments = parser.parse_args(sys.argv[sys.argv.index("--") + 1 :])
    stage = Stage(_sphere(), arguments.size, arguments.samples, VIEW)
    temporary = Path(tempfile.mkdtemp())
    for path in sorted(arguments.folder.glob("*.npz")):
        picture = path.with_suffix(".png")
        if picture.exists() and picture.stat().st_mtime >= path.stat().st_mtime:
            continue
        with np.load(path) as scene:
            _draw_input(stage, scene)
            left = stage.render(temporary / "input.png")
            _draw_quads(stage, scene)
            right = stage.render(temporary / "quads.png")
        save_side_by_side([left, right], picture)


def _draw_input(stage: Stage, scene: dict) -> None:
    stage.clear()
    stage.add_surface(scene["points"], list(scene["triangles"]), INPUT)
    stage.add_wires(scene["points"], _edges(scene["triangles"]), LINES, 0.006)
    _add_lines(stage, scene)


def _draw_quads(stage: Stage, scene: dict) -> None:
    """Only the bad ones as surfaces, so that nothing hides them, and with thick edges, as many have hardly any area."""
    stage.clear()
    bad = scene["quads"][scene["is_bad"]]
    stage.add_wires(scene["vertices"], _edges(scene["quads"]), LINES, 0.01)
    stage.add_surface(scene["vertices"], list(bad), FEWER)
    stage.add_wires(scene["vertices"], _edges(bad), FEWER, 0.022)
    _add_lines(stage, scene)


def _add_lines(stage: Stage, scene: dict) -> None:
    ends = scene["lines"].reshape(-1, 3)
    stage.add_wires(ends, np.arange(len(ends)).reshape(-1, 2), FEATURES, 0.014)


def _edges(faces: np.ndarray) -> np.ndarray:
    sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
    return np.unique(np.sort(sides, axis=1), axis=0)


def _sphere() -> np.ndarray:
    """Points that the camera has to see."""
    rows = np.random.default_rng(0).normal(size=(200, 3))
    return rows / np.linalg.norm(rows, axis=1, keepdims=True)


main()
