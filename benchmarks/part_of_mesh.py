#!/usr/bin/env python3
"""How often a random choice of faces can be remeshed with the rest left as it is, as Markdown.

Patches with smooth and with ragged borders, rings, patches with holes, several patches, one face, most faces, a random half of
them; each at the size of its border, twice and half the model's mean edge. Exit status 1 if a result is not joined exactly.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import hybrid_quad
from hybrid_quad.core.edge_borders import BoolArray, edge_keys
from hybrid_quad.core.mesh_arrays import FloatArray, Polygons
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.part_sheet import sides_of
from hybrid_quad.core.remesh_part import PartRemesh
from runs import COLLECTION

MODELS = ["c3d_spot_triangulated", "c3d_fandisk", "c3d_suzanne", "dir_bunny1k", "igl_beetle", "dir_camelhead"]
HEADER = "| chosen | runs | joined | of these cut and closed | with an inverted corner, of those at the border's size | refused |"


def main() -> int:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--folder", type=Path, default=COLLECTION, help="folder of the models (default %(default)s)")
    parser.add_argument("--models", nargs="+", default=MODELS, metavar="NAME")
    parser.add_argument("--rounds", type=int, default=3, metavar="N", help="choices of each kind (default %(default)s)")
    parser.add_argument("--odd-border", default="grow", choices=["refuse", "grow", "shrink"])
    arguments = parser.parse_args()
    counts: dict[str, Counter[str]] = {}
    for name in arguments.models:
        vertices, polygons = read_mesh(arguments.folder / f"{name}.obj")
        random = np.random.default_rng(7)
        for _ in range(arguments.rounds):
            for kind, part in choices(polygons, len(vertices), random):
                for size in (None, 2.0, 0.5):
                    outcome = run(vertices, polygons, part, size, arguments.odd_border)
                    counts.setdefault(kind, Counter()).update(outcome)
                    print(name, kind, int(part.sum()), size, *outcome, file=sys.stderr, flush=True)
    print(table(counts))
    return int(any(count["wrong"] for count in counts.values()))


def choices(polygons: Polygons, vertex_count: int, random: np.random.Generator) -> Iterator[tuple[str, BoolArray]]:
    """Kinds of parts of a mesh, one of each."""
    patches = _Patches(polygons, vertex_count)
    faces = len(polygons.sizes)
    count = min(int(random.choice([20, 100, 400, 1500])), faces // 3)

    def patch(share: float = 1.0) -> BoolArray:
        return patches.around(int(random.integers(faces)), max(1, int(share * count)))

    yield "a patch with a smooth border", patches.smooth(patch())
    yield "a patch with a ragged border", patch()
    middle = int(random.integers(faces))
    yield "a ring", patches.around(middle, count) & ~patches.around(middle, max(1, count // 4))
    holes = patch()
    for _ in range(3):
        inside = np.flatnonzero(holes)
        holes = holes & ~patches.around(int(random.choice(inside)), max(1, count // 30)) if len(inside) > 9 else holes
    yield "a patch with holes", holes
    yield "patches, maybe in touch", patch(0.3) | patch(0.3) | patch(0.3) | patch(0.3)
    yield "one face", patches.around(int(random.integers(faces)), 1)
    yield "all but a patch", ~patch()
    if faces <= 6000:
        yield "a random half", random.random(faces) < 0.5


class _Patches:
    def __init__(self, polygons: Polygons, vertex_count: int) -> None:
        owner = np.repeat(np.arange(len(polygons.sizes)), polygons.sizes)
        keys = edge_keys(sides_of(polygons), vertex_count)
        order = np.argsort(keys, kind="stable")
        same = keys[order][1:] == keys[order][:-1]
        one, other = owner[order][:-1][same], owner[order][1:][same]
        self._near: list[list[int]] = [[] for _ in polygons.sizes]
        for a, b in zip(one.tolist(), other.tolist(), strict=True):
            self._near[a].append(b)
            self._near[b].append(a)

    def around(self, face: int, count: int) -> BoolArray:
        """So many faces, the nearest ones first."""
        found = dict.fromkeys([face])
        for each in (queue := [face]):
            for near in self._near[each]:
                if near not in found and len(found) < count:
                    found[near] = None
                    queue.append(near)
        part = np.zeros(len(self._near), np.bool_)
        part[list(found)] = True
        return part

    def smooth(self, part: BoolArray) -> BoolArray:
        """With the faces that have two neighbours in the part."""
        wider = part.copy()
        for face, near in enumerate(self._near):
            wider[face] |= sum(bool(part[each]) for each in near) > 1
        return wider


def run(vertices: FloatArray, polygons: Polygons, part: BoolArray, size: float | None, odd_border: str) -> list[str]:
    """What came of one choice."""
    ends = vertices[sides_of(polygons)]
    settings: dict[str, Any] = {}
    if size is not None:
        settings["edge_length"] = size * float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean())
    try:
        result = hybrid_quad.remesh_part(vertices, polygons, part, odd_border=odd_border, **settings)
    except hybrid_quad.InputError as error:
        return [error.code]
    outcome = ["joined" if is_joined(vertices, polygons, result) else "wrong"]
    outcome += ["cut"] * bool(result.report["part"]["cuts"])
    if size is None:
        outcome += ["own size"] + ["inverted"] * (result.report["scaled_jacobian"]["min"] < 0)
    return outcome


def is_joined(vertices: FloatArray, polygons: Polygons, result: PartRemesh) -> bool:
    """Whether the rest has its bits, and edges have as many faces as before."""
    same = np.array_equal(result.vertices[: len(result.kept_vertices)], vertices[result.kept_vertices])
    of_rest = np.isin(np.repeat(np.arange(len(polygons.sizes)), polygons.sizes), result.kept_faces)
    corners = result.faces.vertices[: int(of_rest.sum())]
    same &= np.array_equal(result.kept_vertices[corners], polygons.vertices[of_rest])
    _, before = np.unique(edge_keys(sides_of(polygons), len(vertices)), return_counts=True)
    _, after = np.unique(edge_keys(sides_of(result.faces), len(result.vertices)), return_counts=True)
    has_open = bool((before == 1).any())
    return bool(same and after.max() <= max(2, before.max()) and (has_open or after.min() == 2))


def table(counts: dict[str, Counter[str]]) -> str:
    """The outcomes as Markdown."""
    lines = [HEADER, "|---|--:|--:|--:|--:|---|"]
    for kind, count in counts.items():
        refused = {code: n for code, n in count.items() if code not in ("joined", "cut", "own size", "inverted")}
        runs = count["joined"] + sum(refused.values())
        why = ", ".join(f"{n} `{code}`" for code, n in sorted(refused.items())) or "-"
        lines.append(
            f"| {kind} | {runs} | {count['joined']} | {count['cut']} | {count['inverted']} of {count['own size']} | {why} |"
        )
    return "\n".join(lines)


if __name__ == "__main__":
    sys.exit(main())
