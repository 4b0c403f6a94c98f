#!/usr/bin/env python3
"""How near the Catmull-Clark limit surface comes to the input by `fit_limit_surface`, as Markdown.

Over the smooth models of a collection: manifold ones of whose edges at most one in a hundred bends by more than 40 degrees.
Distances are mean and largest, in percent of the diagonal. Exit status 1 if the median model's mean distance falls by less
than four times, or a result is not valid.
"""

from __future__ import annotations

import argparse
import csv
import statistics
import sys
from pathlib import Path

import hybrid_quad
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.validation import violations
from runs import COLLECTION, ROOT

LEAST_GAIN = 4.0
SMOOTH_SHARE = 0.01
HEADER = "| model | quads | unfitted: mean | max | fitted: mean | max | times nearer | held back | seconds |"


def main() -> int:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--models", type=Path, default=COLLECTION, help="folder with an index.csv (default %(default)s)"
    )
    parser.add_argument("--only", nargs="+", metavar="NAME", help="only models whose name contains one of these")
    parser.add_argument("--quads", type=int, default=2000, metavar="N")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "limit_surface", help="for limit_surface.md")
    arguments = parser.parse_args()
    lines, gains, good = [HEADER, "|---|" + "--:|" * 8], [], True
    for path in smooth_models(arguments.models):
        if arguments.only and not any(part in path.stem for part in arguments.only):
            continue
        result = hybrid_quad.remesh(*read_mesh(path), quads=arguments.quads, fit_limit_surface=True)
        good = good and not violations(result.vertices, result.quads)
        fit = result.report["limit_distance_percent"]
        before, after = fit["before"], fit["after"]
        # What is met from the start, as something flat is, cannot come nearer.
        gain = before["mean"] / after["mean"] if before["mean"] > 1e-6 else None
        gains += [] if gain is None else [gain]
        seconds = sum(stage["seconds"] for stage in result.report["stages"] if stage["name"] == "limit surface")
        lines.append(
            f"| {path.stem} | {len(result.quads)} | {before['mean']:.4f} | {before['max']:.3f} | {after['mean']:.4f} "
            f"| {after['max']:.3f} | {'-' if gain is None else f'{gain:.1f}'} | {fit['held_back']} | {seconds:.1f} |"
        )
        print(lines[-1], file=sys.stderr, flush=True)
    if not gains:
        print(f"no smooth models with an index.csv in {arguments.models}", file=sys.stderr)
        return 2
    median = statistics.median(gains)
    lines += ["", f"In the median {median:.1f} times nearer; the target is {LEAST_GAIN:.0f}."]
    text = "\n".join(lines) + "\n"
    arguments.out.mkdir(parents=True, exist_ok=True)
    (arguments.out / "limit_surface.md").write_text(text)
    print(text)
    return 0 if good and median >= LEAST_GAIN else 1


def smooth_models(folder: Path) -> list[Path]:
    """Manifold models with few sharp edges, in the order of the index."""
    if not (folder / "index.csv").exists():
        return []
    with (folder / "index.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["edge_mf"] == row["vert_mf"] == "y"]
    edges_per_face = 1.5
    smooth = [row for row in rows if int(row["sharp40"]) <= SMOOTH_SHARE * edges_per_face * int(row["F"])]
    return [folder / f"{row['name']}.obj" for row in smooth]


if __name__ == "__main__":
    sys.exit(main())
