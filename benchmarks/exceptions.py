#!/usr/bin/env python3
"""Finds all quads with a scaled Jacobian of zero or less in the results of a sweep, measures on the input why, and writes docs/exceptions.md.

    exceptions.py                      results of out/sweep; meshes that are not there are made again
    exceptions.py FILE ... --quads N   runs of these models instead, for a look: only prints the table

What is measured is kept in a folder for each build of the library: what was interrupted goes on where it stopped. Pictures need
Blender and Pillow.
"""

from __future__ import annotations

import argparse
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
from runs import COLLECTION, ROOT, SETTINGS, Limits, Outcome, Run, run_and_judge
from shape_causes import CAUSES, OPEN, Inspector, Measured
from sweep import build_id, read_results

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
        kept.unlink(missing_ok=True)
    done = {row["name"]: row for row in _rows(kept)}
    rows = []
    with kept.open("a") as file:
        for outcome, run, mesh in _exceptions(arguments, build, outcomes):
            if run.name not in done:
                row = measured(outcome, run, mesh, folder / "panels")
                file.write(json.dumps(row) + "\n")
                file.flush()
                done[run.name] = row
            rows.append(done[run.name])
            print(exceptions_page.line(done[run.name]), flush=True)
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


def measured(outcome: Outcome, run: Run, mesh: Path, panels: Path) -> dict[str, Any]:
    """What there is to say of one run: all its bad quads with their causes, and how often these hold at good ones.

    Leaves what its pictures need in `panels`.
    """
    points, polygons = read_mesh(run.path)
    surface = InputSurface(points, fan_triangles(polygons))
    vertices, faces = read_mesh(mesh)
    quads = faces.vertices.reshape(-1, 4)
    length = float(np.sqrt(surface.area.sum() / run.quads))
    lines = KeptLines(surface, line_edges(surface, SHARP_DEGREES[run.setting]), vertices, quads, length)
    inspector = Inspector(surface, lines, vertices, quads, length)
    shape = scaled_jacobian(vertices, quads)
    bad = np.flatnonzero(shape <= 0)
    found = []
    for quad in bad[np.argsort(shape[bad])]:
        at = inspector.measure(int(quad))
        found.append({"quad": int(quad), "sj": round(float(shape[quad]), 4), "cause": at.cause, "at": at.as_json()})
    good = np.flatnonzero(shape >= GOOD)
    sample = np.random.default_rng(0).choice(good, min(OTHERS, len(good)), replace=False)
    for cause in exceptions_pictures.shown_causes(found):
        worst = next(quad["quad"] for quad in found if quad["cause"] == cause)
        scene = exceptions_pictures.scene(surface, lines, vertices, quads, bad, worst, length)
        np.savez_compressed(panels / exceptions_pictures.panel_name(run.name, cause), **scene)
    return {
        "name": run.name,
        "model": run.model,
        "asked": run.quads,
        "setting": run.setting,
        "got": len(quads),
        "features_given_way": outcome.report.get("features_given_way", 0),
        "repairs": {name: count for name, count in outcome.report.get("repairs", {}).items() if count},
        "faces": len(surface.triangles),
        "length": length,
        "minimum": round(float(shape.min()), 4),
        "quads": found,
        "others": _shares([inspector.measure(int(quad)) for quad in sample]),
    }


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
