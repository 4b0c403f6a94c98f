#!/usr/bin/env python3
"""Measures how near results come to guides of all kinds, on real smooth models, as Markdown.

Guides are plane sections of the models: around limbs and bodies, along backs, and two that cross. Directions: the median
angle in the surface between edges within one edge length of the guide and the guide (asked: 5 degrees). Loops: the Hausdorff distance
from the guide to its chain of edges, in edge lengths (asked: 0.1). Rings: the largest distance from middles of edges to the guide,
in edge lengths (asked: 0.1), and the largest deviation from a right angle (asked: 10 degrees).
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import hybrid_quad
from hybrid_quad.core.mesh_arrays import FloatArray, as_polygons
from hybrid_quad.core.mesh_io import read_mesh, write_mesh
from hybrid_quad.core.strokes import Stroke, joined_lines
from hybrid_quad.core.surface_points import fan_triangles
from hybrid_quad.core.validation import violations
from runs import COLLECTION, JUDGE

# Axis square to the plane, its place within the bounds, which of the plane's sections (the longest first), and which part
# of that section.
PLACES = {
    "c3d_spot_triangulated": {"limb": [(1, 0.1, 0, None)], "back": [(0, 0.52, 0, (0.1, 0.3))],
                              "crossing": [(1, 0.3, 0, None), (2, 0.2, 0, None)]},
    "dir_fertility_input": {"limb": [(0, 0.2, 2, None)], "back": [(2, 0.55, 0, (0.1, 0.3))],
                            "crossing": [(1, 0.1, 0, None), (2, 0.55, 0, None)]},
    "c3d_stanford_bunny": {"limb": [(1, 0.85, 0, None)], "back": [(2, 0.52, 0, (0.2, 0.5))],
                           "crossing": [(1, 0.3, 0, None), (2, 0.55, 0, (0.1, 0.6))]},
}  # fmt: skip
HEADER = "| model | place | kind | quads (asked) | valid | distance (edge lengths) | angle (degrees) | met | seconds |"


def main() -> int:
    """Prints the table; exit status 1 if a result is not valid."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=Path, default=COLLECTION, help="folder of the models (default %(default)s)")
    parser.add_argument("--quads", type=int, nargs="+", default=[500, 2000, 8000])
    parser.add_argument("--only", default="", help="models whose names contain this")
    parser.add_argument("--no-judge", action="store_true")
    arguments = parser.parse_args()
    print(HEADER, "|---|---|---|--:|---|--:|--:|---|--:|", sep="\n")
    good = True
    for model, places in PLACES.items():
        if arguments.only not in model:
            continue
        vertices, polygons = read_mesh(arguments.models / f"{model}.obj")
        triangles = fan_triangles(as_polygons(polygons))
        for place, sections in places.items():
            lines = [section(vertices, triangles, *where) for where in sections]
            for kind in ("direction", "loop", "ring"):
                for quads in arguments.quads:
                    started = time.monotonic()
                    strokes = [Stroke(line, 1.0, kind) for line in lines]
                    result = hybrid_quad.remesh(vertices, polygons, quads=quads, sharp_angle=None, strokes=strokes)
                    seconds = time.monotonic() - started
                    judge = None if arguments.no_judge or not JUDGE.exists() else JUDGE
                    valid = is_valid(arguments.models / f"{model}.obj", result, judge)
                    good &= valid
                    print(row(model, place, kind, quads, result, lines, valid, seconds), flush=True)
    return 0 if good else 1


def row(model, place, kind, quads, result, lines, valid, seconds) -> str:
    """One line of the table."""
    if kind == "direction":
        distance, angle = "", median_angle(result, lines)
        met = angle <= 5
    else:
        guides = result.report["guides"]
        distance, angle = f"{max(guide['distance'] for guide in guides):.3f}", max(guide["angle"] for guide in guides)
        met = all(guide["met"] for guide in guides)
    shown = "" if kind == "loop" else f"{angle:.1f}"
    cells = (model, place, kind, f"{len(result.quads)} ({quads})", "yes" if valid else "NO", distance, shown)
    return f"| {' | '.join(cells)} | {'yes' if met else 'NO'} | {seconds:.1f} |"


def section(vertices: FloatArray, triangles, axis: int, place: float, number: int, part) -> FloatArray:
    """A line of 60 pieces along a section of the surface with a plane, or along a part of it."""
    height = vertices[:, axis] - vertices[:, axis].min()
    height = height - place * height.max()
    above = height > 0
    cut = triangles[above[triangles].any(axis=1) & ~above[triangles].all(axis=1)]
    pieces = []
    for triangle in cut:
        ends = []
        for a, b in zip(triangle, np.roll(triangle, -1), strict=True):
            if above[a] != above[b]:
                low, high = min(a, b), max(a, b)  # the same point from both triangles
                share = height[low] / (height[low] - height[high])
                ends.append((1 - share) * vertices[low] + share * vertices[high])
        pieces.append(np.array(ends))
    line = sorted(joined_lines(pieces), key=lambda each: -lengths(each)[-1])[number]
    along = lengths(line)
    begin, end = part or (0, 1)
    at = np.linspace(begin * along[-1], end * along[-1], 61)
    return np.stack([np.interp(at, along, line[:, i]) for i in range(3)], axis=1)


def lengths(line: FloatArray) -> FloatArray:
    """Arc length at every point of a line."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])


def median_angle(result, lines: list[FloatArray]) -> float:
    """Degrees between edges near some lines and the lines, up to quarter turns; the median.

    Within the surface: how steeply a line goes over its bumps is not for the quads to follow.
    """
    quads = result.quads
    of_quad = np.cross(*(result.vertices[quads[:, i + 2]] - result.vertices[quads[:, i]] for i in (0, 1)))
    of_vertex = np.zeros_like(result.vertices)
    np.add.at(of_vertex, quads, of_quad[:, None])
    of_vertex /= np.linalg.norm(of_vertex, axis=1, keepdims=True)
    begin, end = quads.ravel(), np.roll(quads, -1, axis=1).ravel()
    a, b, normal = result.vertices[begin], result.vertices[end], of_vertex[begin] + of_vertex[end]
    middle, edge = (a + b) / 2, within(b - a, normal)
    begin, end = (np.concatenate([line[shift : shift - 1 or None] for line in lines]) for shift in (0, 1))
    along = end - begin
    near = np.einsum("pij,ij->pi", middle[:, None] - begin, along) / (along**2).sum(axis=1)
    gap = np.linalg.norm(middle[:, None] - begin - np.clip(near, 0, 1)[:, :, None] * along, axis=2)
    which = gap.argmin(axis=1)
    close = gap.min(axis=1) < np.linalg.norm(b - a, axis=1).mean()
    direction = within(along[which], normal)
    cosine = np.abs((edge * direction).sum(axis=1)) / (np.linalg.norm(edge, axis=1) * np.linalg.norm(direction, axis=1))
    angle = np.degrees(np.arccos(np.clip(cosine, 0, 1)))[close]
    return float(np.median(np.minimum(angle, 90 - angle)))


def within(vectors: FloatArray, normals: FloatArray) -> FloatArray:
    """What vectors have square to some normals, of any length."""
    return vectors - ((vectors * normals).sum(axis=1) / (normals**2).sum(axis=1))[:, None] * normals


def is_valid(source: Path, result, judge: Path | None) -> bool:
    """Whether our own checks, and the judge where there is one, find the quads valid."""
    if violations(result.vertices, result.quads):
        return False
    if judge is None:
        return True
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "out.obj"
        write_mesh(target, result.vertices, result.quads)
        done = subprocess.run([sys.executable, judge, source, target, "--angle", "180"], capture_output=True, text=True)
        return done.returncode == 0


if __name__ == "__main__":
    sys.exit(main())
