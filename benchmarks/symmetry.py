#!/usr/bin/env python3
"""Exact mirror symmetry on real models, as Markdown.

Suzanne and Spot; a scanned camel's head, which is only nearly symmetric; and the same made symmetric by mirroring one
half of it. Each at three counts, about the plane x = 0 as asked, and about what is detected. Exit status 1 if a result is
not what is promised.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import hybrid_quad
from hybrid_quad.core.mesh_arrays import Polygons
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.validation import violations
from runs import COLLECTION, ROOT

sys.path.append(str(ROOT / "tests"))
from support.mirroring import assert_mirrored, assert_seam

HEADER = "| model | asked | planes | deviation x % max (mean) | quads (asked) | valid | exact mirror image | seam |"


def main() -> int:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=Path, default=COLLECTION, help="folder of the models (default %(default)s)")
    parser.add_argument("--quads", nargs="+", type=int, default=[500, 2000, 8000], metavar="N")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "symmetry", help="for symmetry.md")
    arguments = parser.parse_args()
    lines = [HEADER, "|---|---|---|--:|--:|---|---|---|"]
    good = True
    for name, vertices, faces, is_symmetric in _models(arguments.models):
        for asked in ("x", "auto"):
            for quads in arguments.quads:
                line, passed = _row(name, vertices, faces, asked, quads, "x" if asked == "x" or is_symmetric else "")
                print(line, file=sys.stderr, flush=True)
                lines.append(line)
                good = good and passed
    text = "\n".join(lines) + "\n"
    arguments.out.mkdir(parents=True, exist_ok=True)
    (arguments.out / "symmetry.md").write_text(text)
    print(text)
    return 0 if good else 1


def _models(folder: Path) -> list[tuple[str, np.ndarray, Any, bool]]:
    """Name, vertices, faces, and whether the plane x = 0 has to be found."""
    suzanne, suzanne_faces = read_mesh(folder / "c3d_suzanne.obj")
    spot, spot_faces = read_mesh(folder / "c3d_spot_triangulated.obj")
    camel, camel_faces = read_mesh(folder / "dir_camelhead.obj")
    half, half_faces = mirrored_half(camel, camel_faces)
    middle = 0.5 * (suzanne.min(axis=0) + suzanne.max(axis=0))
    return [
        ("Suzanne", suzanne - middle, suzanne_faces, True),
        ("Spot", spot, spot_faces, True),
        ("camel head", camel, camel_faces, False),
        ("camel head, one half mirrored", half, half_faces, True),
    ]


def mirrored_half(vertices: np.ndarray, faces: Polygons) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """What lies at x >= 0, cut at the plane, and its mirror image."""
    points = [tuple(point) for point in vertices.tolist()]
    crossings: dict[tuple[int, int], int] = {}

    def crossing(a: int, b: int) -> int:
        key = (min(a, b), max(a, b))
        if key not in crossings:
            p, q = vertices[key[0]], vertices[key[1]]
            point = p + p[0] / (p[0] - q[0]) * (q - p)
            crossings[key] = len(points)
            points.append((0.0, *point[1:]))
        return crossings[key]

    kept: list[tuple[int, ...]] = []
    for corners in np.split(faces.vertices, np.cumsum(faces.sizes)[:-1]):
        polygon: list[int] = []
        for a, b in zip(corners.tolist(), np.roll(corners, -1).tolist(), strict=True):
            if vertices[a, 0] >= 0:
                polygon.append(a)
            if vertices[a, 0] * vertices[b, 0] < 0:
                polygon.append(crossing(a, b))
        if len(polygon) >= 3:
            kept.append(tuple(polygon))
    image = {v: v for face in kept for v in face}
    for v in sorted(image):
        if points[v][0] != 0:
            image[v] = len(points)
            points.append((-points[v][0], *points[v][1:]))
    both = kept + [tuple(image[v] for v in reversed(face)) for face in kept]
    used, corners = np.unique([v for face in both for v in face], return_inverse=True)
    bounds = np.cumsum([len(face) for face in both])[:-1]
    return np.array(points)[used], [tuple(face.tolist()) for face in np.split(corners, bounds)]


def _row(name: str, vertices: np.ndarray, faces: Any, asked: str, quads: int, expected: str) -> tuple[str, bool]:
    result = hybrid_quad.remesh(vertices, faces, quads=quads, symmetry=asked)
    record = result.report["symmetry"]
    found = violations(result.vertices, result.quads)
    mirrored = seam = "-"
    passed = not found and record["planes"] == expected
    if "x" in record["planes"]:
        mirrored = _said(lambda: assert_mirrored(result.vertices, result.quads, 0))
        seam = _said(lambda: f"{assert_seam(result.vertices, result.quads, 0)} edges")
        passed = passed and "no" not in (mirrored, seam)
    deviation = record["deviation_percent"]["x"]
    cells = (
        name,
        asked,
        record["planes"] or "none",
        f"{deviation['max']:.3f} ({deviation['mean']:.3f})",
        f"{len(result.quads)} ({quads})",
        "yes" if not found else found[0],
        mirrored,
        seam,
    )
    return "| " + " | ".join(cells) + " |", passed


def _said(check: Callable[[], str | None]) -> str:
    try:
        return check() or "yes"
    except AssertionError:
        return "no"


if __name__ == "__main__":
    sys.exit(main())
