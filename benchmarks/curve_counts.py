#!/usr/bin/env python3
"""How often curves of models get exactly the number of quads that was asked for, as a Markdown table.

On each model, creases of different lengths are asked for half and twice the number of quads that they would get, for 6
and 11, and for an even number where they are closed.
"""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path

import numpy as np

from hybrid_quad.core.curve_counts import chains_of_edges
from hybrid_quad.core.mesh_arrays import FloatArray, Polygons, surface_area
from hybrid_quad.core.mesh_io import read_mesh
from runs import COLLECTION, JUDGE, ROOT, Limits, Run, run_and_judge

MODELS = (
    "c3d_fandisk",
    "loopy_joint",
    "c3d_rocker_arm",
    "dir_deckel_input",
    "loopy_hinge",
    "fc_ex3d_04_g",
    "prusa_plug_aligner",
    "hexme_i01o_m1_g",
    "dir_dome",
    "loopy_mechanical05",
)
OWN_MODELS = ROOT / "tests" / "data" / "meshes"
SHARP_COSINE = math.cos(math.radians(40))
SHORTEST = 3.5  # quads
Chain = list[int]  # vertices


def main() -> int:
    """Runs every model with every demand and prints the table; exit status 1 if a number was missed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=Path, default=COLLECTION, help="folder of the models (default %(default)s)")
    parser.add_argument("--quads", type=int, nargs="+", default=[2000])
    parser.add_argument("--curves", type=int, default=2, help="curves of each model")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "curve_counts")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    paths = [path for name in MODELS if (path := arguments.models / f"{name}.obj").exists()]
    lines = ["| model | quads (asked) | curve | fits | asked | got | valid |", "|---|--:|--:|--:|--:|--:|---|"]
    met = total = 0
    for path in paths or sorted(OWN_MODELS.glob("*.obj")):
        vertices, polygons = read_mesh(path)
        for quads in arguments.quads:
            length = math.sqrt(surface_area(vertices, polygons) / quads)
            curves = _curves(vertices, polygons, SHORTEST * length, arguments.curves)
            if not curves:
                continue
            fits = [_length(vertices, curve) / length for curve in curves]
            for name, asked in _demands(curves, fits).items():
                wishes = arguments.out / f"{path.stem}_{quads}_{name}.txt"
                wishes.write_text("".join(f"{n} {' '.join(map(str, c))}\n" for c, n in zip(curves, asked, strict=True)))
                run = Run(f"{path.stem}_{name}", path, quads, "sharp", ("--curve-counts", str(wishes)))
                outcome = run_and_judge(run, arguments.out, Limits(), JUDGE)
                rows = outcome.report.get("curve_counts", [])
                for i, row in enumerate(rows):
                    total += 1
                    met += row["asked"] == row["got"]
                    made = f"{outcome.report['quads']} ({quads})"
                    got = f"{row['got']}" + (f" ({row['reason']})" if row["reason"] else "")
                    cells = (path.stem, made, f"{i}", f"{fits[i]:.1f}", f"{row['asked']}", got, outcome.status)
                    lines.append("| " + " | ".join(cells) + " |")
                    print(lines[-1], ", ".join(outcome.failed), file=sys.stderr, flush=True)
                if not rows:
                    total += len(curves)
                    lines.append(f"| {path.stem} | ({quads}) | | | {asked} | | {outcome.status} |")
    lines.append(f"\n{met} of {total} met.")
    text = "\n".join(lines) + "\n"
    (arguments.out / "curve_counts.md").write_text(text)
    print(text)
    return 0 if met == total else 1


def _demands(curves: list[Chain], fits: list[float]) -> dict[str, list[int]]:
    """Named lists of numbers, one for each curve; loops are asked for even ones."""
    demands = {
        "half": [max(1, round(fit / 2)) for fit in fits],
        "twice": [round(2 * fit) for fit in fits],
        "six_eleven": [(6, 11)[i % 2] for i in range(len(fits))],
    }
    loops = [curve[0] == curve[-1] for curve in curves]
    return {
        name: [max(4, n + n % 2) if loop else n for n, loop in zip(numbers, loops, strict=True)]
        for name, numbers in demands.items()
    }


def _curves(vertices: FloatArray, polygons: Polygons, shortest: float, count: int) -> list[Chain]:
    """Creases between their forks, spread evenly from the longest to the shortest that is long enough."""
    chains = [path for path, _ in chains_of_edges(*_creases(vertices, polygons))]
    simple = [path for path in chains if len(set(path)) == len(path) - (path[0] == path[-1])]
    long = sorted((path for path in simple if _length(vertices, path) > shortest), key=lambda p: -_length(vertices, p))
    if not long:
        return []
    return [long[i] for i in sorted({round(x) for x in np.linspace(0, len(long) - 1, count)})]


def _creases(vertices: FloatArray, polygons: Polygons) -> tuple[np.ndarray, np.ndarray]:
    """Edges between faces that bend by more than 40 degrees, or of one face, and a 1 for each."""
    starts = np.cumsum(polygons.sizes) - polygons.sizes
    faces_at: dict[tuple[int, int], list[int]] = {}
    normals = []
    for face, (start, size) in enumerate(zip(starts.tolist(), polygons.sizes.tolist(), strict=True)):
        ring = polygons.vertices[start : start + size].tolist()
        points = vertices[ring]
        normal = np.cross(points[1:-1] - points[0], points[2:] - points[0]).sum(axis=0)
        normals.append(normal / max(float(np.linalg.norm(normal)), np.finfo(float).tiny))
        for a, b in zip(ring, ring[1:] + ring[:1], strict=True):
            faces_at.setdefault((min(a, b), max(a, b)), []).append(face)
    edges = [
        edge
        for edge, faces in faces_at.items()
        if len(faces) == 1 or (len(faces) == 2 and normals[faces[0]] @ normals[faces[1]] < SHARP_COSINE)
    ]
    return np.array(edges, np.int32).reshape(-1, 2), np.ones(len(edges), np.int32)


def _length(vertices: FloatArray, path: Chain) -> float:
    return float(np.linalg.norm(np.diff(vertices[path], axis=0), axis=1).sum())


if __name__ == "__main__":
    sys.exit(main())
