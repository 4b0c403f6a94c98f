#!/usr/bin/env python3
"""Finds all quads with a scaled Jacobian of zero or less in a sweep's results, measures on the input why, writes docs/exceptions.md.

    exceptions.py                      results of out/sweep; meshes that are not there are made again
    exceptions.py FILE ... --quads N   runs of these models instead, for a look: only prints the table

What is measured is kept in a folder for each build of the library: what was interrupted goes on where it stopped. Pictures need
Blender and Pillow.
"""

from __future__ import annotations

import argparse
import functools
import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import exceptions_page
import exceptions_pictures
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.surface_points import fan_triangles
from hybrid_quad.core.validation import scaled_jacobian
from input_patch import InputSurface
from kept_lines import KeptLines, line_edges
from results import build_id, read_results
from runs import COLLECTION, ROOT, SETTINGS, Limits, Outcome, Run, run_and_judge
from shape_causes import CAUSES, OPEN, Inspector, Measured

SHARP_DEGREES = {"sharp": 40.0, "no_sharp": None}
GOOD = 0.3
OTHERS = 60  # quads of good shape that are measured for comparison


def main() -> int:
    """Measures what is missing and writes the page; exit status 1 where quads are open, whose cause is not the input's."""
    arguments = _parser().parse_args()
    build, outcomes = _outcomes(arguments)
    folder = arguments.out / build
    (folder / "panels").mkdir(parents=True, exist_ok=True)
    kept = folder / "exceptions.jsonl"
    if arguments.fresh:
        for old in (kept, *(folder / "panels").iterdir()):
            old.unlink(missing_ok=True)
    done = {row["name"]: row for row in _rows(kept)}
    rows = []
    with kept.open("a") as file:
        for outcome, run, mesh in _exceptions(arguments, build, outcomes):
            case = functools.cache(functools.partial(Case, outcome, run, mesh))  # not read where all is done
            if run.name not in done:
                done[run.name] = case().measured()
                file.write(json.dumps(done[run.name]) + "\n")
                file.flush()
            row = done[run.name]
            for cause in exceptions_pictures.shown_causes(row["quads"]):
                scene = folder / "panels" / exceptions_pictures.panel_name(run.name, cause)
                if not scene.exists():
                    worst = next(quad["quad"] for quad in row["quads"] if quad["cause"] == cause)
                    np.savez_compressed(scene, **case().scene_at(worst))
            rows.append(row)
            print(exceptions_page.line(row), flush=True)
    if not arguments.files:
        sheets: dict[str, Path] = {}
        if arguments.blender:
            script = ROOT / "docs" / "pictures" / "exceptions.py"
            command = [arguments.blender, "-b", "--factory-startup", "--python-exit-code", "1", "-P", str(script), "--"]
            subprocess.run([*command, str(folder / "panels")], check=True, stdout=subprocess.DEVNULL)
            sheets = exceptions_pictures.sheets(
                rows, folder / "panels", arguments.page.parent / "images" / "exceptions"
            )
        arguments.page.write_text(exceptions_page.page(rows, len(outcomes), sheets, arguments.page.parent))
        print(f"{arguments.page}: {len(rows)} of {len(outcomes)} runs")
    return int(any(quad["cause"] == OPEN for row in rows for quad in row["quads"]))


class Case:
    """A run with what it was made of.

    Parameters
    ----------
    outcome : Outcome
    run : Run
    mesh : Path
        The result.
    """

    def __init__(self, outcome: Outcome, run: Run, mesh: Path) -> None:
        self._outcome, self._run = outcome, run
        points, polygons = read_mesh(run.path)
        self._surface = InputSurface(points, fan_triangles(polygons))
        self._vertices, faces = read_mesh(mesh)
        self._quads = faces.vertices.reshape(-1, 4)
        self._length = float(np.sqrt(self._surface.area.sum() / run.quads))
        candidates = line_edges(self._surface, SHARP_DEGREES[run.setting])
        self._lines = KeptLines(self._surface, candidates, self._vertices, self._quads, self._length)
        self._shape = scaled_jacobian(self._vertices, self._quads)
        self._bad = np.flatnonzero(self._shape <= 0)

    def measured(self) -> dict[str, Any]:
        """All bad quads with their causes, the worst first, and how often these hold at good ones."""
        inspector = Inspector(self._surface, self._lines, self._vertices, self._quads, self._length)
        found = []
        for quad in self._bad[np.argsort(self._shape[self._bad])]:
            at = inspector.measure(int(quad))
            shape = round(float(self._shape[quad]), 4)
            found.append({"quad": int(quad), "sj": shape, "cause": at.cause, "at": at.as_json()})
        good = np.flatnonzero(self._shape >= GOOD)
        sample = np.random.default_rng(0).choice(good, min(OTHERS, len(good)), replace=False)
        return {
            "name": self._run.name,
            "model": self._run.model,
            "asked": self._run.quads,
            "setting": self._run.setting,
            "got": len(self._quads),
            "features_given_way": self._outcome.report.get("features_given_way", 0),
            "faces": len(self._surface.triangles),
            "minimum": round(float(self._shape.min()), 4),
            "quads": found,
            "others": _shares([inspector.measure(int(quad)) for quad in sample]),
        }

    def scene_at(self, quad: int) -> dict[str, np.ndarray]:
        """For the picture of a quad."""
        place = (self._surface, self._lines, self._vertices, self._quads, self._bad)
        return exceptions_pictures.scene(*place, quad, self._length)


def _shares(others: list[Measured]) -> dict[str, float]:
    """How often each cause holds, and how often none does."""
    count = max(len(others), 1)
    holding = {cause: sum(at.holds[cause] for at in others) for cause in CAUSES if cause != OPEN}
    holding[OPEN] = sum(at.cause == OPEN for at in others)
    return {cause: round(times / count, 3) for cause, times in holding.items()}


def _outcomes(arguments: argparse.Namespace) -> tuple[str, list[Outcome]]:
    """The build and what it made: of a sweep, or of some files that are run now."""
    if not arguments.files:
        lines = _rows(arguments.sweep / "results.jsonl")
        if not lines:
            raise SystemExit(f"{arguments.sweep}: no results; run scripts/sweep first")
        build = str(lines[-1]["build"])
        found = read_results(arguments.sweep / "results.jsonl", build).values()
        return build, [outcome for outcome in found if outcome.variant == "default" and outcome.report.get("quads")]
    build = build_id()
    folder = arguments.out / build
    folder.mkdir(parents=True, exist_ok=True)
    outcomes = []
    for run in (Run(p.stem, p, n, s) for p in arguments.files for n in arguments.quads for s in arguments.settings):
        known = folder / f"{run.name}.outcome.json"
        if known.exists() and not arguments.fresh:
            outcomes.append(Outcome(**json.loads(known.read_text())))
            continue
        outcomes.append(run_and_judge(run, folder, Limits(), judge=None))
        known.write_text(json.dumps(outcomes[-1].as_json()))
    return build, [outcome for outcome in outcomes if outcome.report.get("quads")]


def _exceptions(
    arguments: argparse.Namespace, build: str, outcomes: list[Outcome]
) -> Iterator[tuple[Outcome, Run, Path]]:
    """Runs with a quad of scaled Jacobian of zero or less, small models first, with their meshes."""
    sources = {path.stem: path for folder in arguments.models for path in sorted(folder.glob("*.obj"))}
    sources |= {path.stem: path for path in arguments.files}
    folder = arguments.out / build if arguments.files else arguments.sweep
    for outcome in sorted(outcomes, key=lambda each: (each.report["input_faces"], each.model, each.quads)):
        if outcome.report["scaled_jacobian"]["min"] > 0:
            continue
        run = Run(outcome.model, sources[outcome.model], outcome.quads, outcome.setting)
        mesh = folder / f"{run.name}.obj"
        if not mesh.exists():
            if build_id() != build:
                raise SystemExit(f"{mesh} is not there, and the library is another than the sweep's")
            run_and_judge(run, arguments.out / build, Limits(), judge=None)
            mesh = arguments.out / build / f"{run.name}.obj"
        yield outcome, run, mesh


def _rows(path: Path) -> list[dict[str, Any]]:
    """Lines of JSON; the last is left out where a run that was ended had not written all of it."""
    rows = []
    for text in path.read_text().splitlines() if path.exists() else []:
        try:
            rows.append(json.loads(text))
        except ValueError:
            continue
    return rows


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path, help="mesh files to run instead of a sweep's results")
    parser.add_argument("--sweep", type=Path, default=ROOT / "out" / "sweep", help="folder of scripts/sweep")
    parser.add_argument("--models", nargs="+", type=Path, default=[COLLECTION], metavar="DIR", help="of the sweep")
    parser.add_argument("--quads", nargs="+", type=int, default=[500, 2000, 8000], metavar="N", help="of files")
    parser.add_argument("--settings", nargs="+", choices=list(SETTINGS), default=list(SETTINGS), help="of files")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "exceptions")
    parser.add_argument("--page", type=Path, default=ROOT / "docs" / "exceptions.md")
    parser.add_argument("--blender", help="program that takes the pictures; the page has none without")
    parser.add_argument("--fresh", action="store_true", help="measure everything again")
    return parser


if __name__ == "__main__":
    sys.exit(main())
