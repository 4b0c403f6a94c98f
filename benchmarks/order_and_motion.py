#!/usr/bin/env python3
"""Whether the order of a mesh's elements, and how it lies in space, make a difference, as Markdown.

Every model, with sharp edges and without, remeshed as it is and with its vertices, faces and first corners permuted, turned at
random, and moved by about its size. *Same*: the same quads, vertex by vertex. Broken models are permuted only. Exit status 1 if
a permuted mesh gives other bytes.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import hybrid_quad
from hybrid_quad.core.mesh_arrays import FloatArray, Polygons
from hybrid_quad.core.mesh_io import read_mesh
from runs import BAD, COLLECTION, ROOT

MODELS = (
    "dir_fertility_input", "c3d_stanford_bunny", "dir_elephant", "dir_botijo", "c3d_rocker_arm", "loopy_joint", "c3d_fandisk",
    "c3d_suzanne", "c3d_spot_triangulated", "dir_camelhead", "hexme_n11o_limit_cycle_g", "dir_bunny1k", "c3d_cheburashka",
    "loopy_mechanical05", "prusa_x_carriage", "fc_ex3d_19_t", "ml_casting", "dir_129110_sf", "c3d_igea", "loopy_hinge",
)  # fmt: skip
BROKEN = (
    "m01_nm_edge_fin", "m05_orient_random30", "m09_t_junctions", "m11_dup_faces",
    "m31_self_intersect_two_bodies", "m34_triangle_soup", "m35_soup_jitter", "r09_openscad_nonmanifold_crash", "r12_cube_with_fold",
    "r14_self_intersecta", "r31_mani_offset1", "r38_c3d_beetle",
)  # fmt: skip
SHARP_DEGREES = 40.0
Change = Callable[[FloatArray, Polygons], tuple[FloatArray, Polygons]]


@dataclass
class Tally:
    """What came of one kind of change."""

    same: int = 0
    cases: int = 0
    largest: float = 0.0  # difference of a coordinate where the quads are the same, in edge lengths
    others: list[str] = field(default_factory=list)


def main() -> int:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quads", type=int, default=1000, metavar="N")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--models", nargs="+", default=[*MODELS, *BROKEN])
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "order_and_motion", help="for order_and_motion.md")
    arguments = parser.parse_args()
    tallies: dict[str, Tally] = {}
    for name in arguments.models:
        is_clean = (COLLECTION / f"{name}.obj").exists()
        vertices, faces = read_mesh((COLLECTION if is_clean else BAD) / f"{name}.obj")
        for sharp_angle in (SHARP_DEGREES, None) if is_clean else (SHARP_DEGREES,):
            case = f"`{name}`" + ("" if sharp_angle is None else ", edges")
            look_at(
                case,
                vertices,
                faces,
                changes(vertices, arguments.seed, is_clean),
                arguments.quads,
                sharp_angle,
                tallies,
            )
    lines = [
        "| input | same | largest difference of a coordinate, in edges, where the same | others |",
        "|---|--:|--:|---|",
    ]
    for kind, tally in tallies.items():
        lines.append(
            f"| {kind} | {tally.same} of {tally.cases} | {tally.largest:.1g} | {'; '.join(tally.others) or '-'} |"
        )
    text = "\n".join(lines) + "\n"
    arguments.out.mkdir(parents=True, exist_ok=True)
    (arguments.out / "order_and_motion.md").write_text(text)
    print(text)
    permuted = [tally for kind, tally in tallies.items() if "permuted" in kind]
    return 0 if all(tally.same == tally.cases and tally.largest == 0 for tally in permuted) else 1


def changes(vertices: FloatArray, seed: int, is_clean: bool) -> dict[str, tuple[Change, Change]]:
    """What is done to a mesh, and what takes it back from the result's vertices."""
    random = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    shift = np.ptp(vertices, axis=0).max() * random.uniform(-1, 1, 3)
    if not is_clean:
        return {"broken models, permuted": (lambda v, f: permuted(v, f, random), lambda v, f: (v, f))}
    return {
        "vertices, faces and first corners permuted": (lambda v, f: permuted(v, f, random), lambda v, f: (v, f)),
        "turned at random": (lambda v, f: (v @ turn.T, f), lambda v, f: (v @ turn, f)),
        "moved by about its size": (lambda v, f: (v + shift, f), lambda v, f: (v - shift, f)),
    }


def permuted(vertices: FloatArray, faces: Polygons, random: np.random.Generator) -> tuple[FloatArray, Polygons]:
    """The same mesh in another order, each face beginning where it likes."""
    order = random.permutation(len(vertices))
    place = np.argsort(order)
    polygons = np.split(faces.vertices, np.cumsum(faces.sizes)[:-1])
    mixed = [np.roll(place[polygons[i]], random.integers(len(polygons[i]))) for i in random.permutation(len(polygons))]
    return vertices[order], Polygons(
        np.array([len(polygon) for polygon in mixed], faces.sizes.dtype), np.concatenate(mixed)
    )


def look_at(
    case: str,
    vertices: FloatArray,
    faces: Polygons,
    to_look_at: dict[str, tuple[Change, Change]],
    quads: int,
    sharp_angle: float | None,
    tallies: dict[str, Tally],
) -> None:
    """Remeshes a model as it is and changed, and counts what is the same."""
    usual = hybrid_quad.remesh(vertices, faces, quads=quads, sharp_angle=sharp_angle)
    edges = usual.vertices[usual.quads] - usual.vertices[np.roll(usual.quads, 1, axis=1)]
    edge = float(np.linalg.norm(edges, axis=2).mean())
    for kind, (change, back) in to_look_at.items():
        result = hybrid_quad.remesh(*change(vertices, faces), quads=quads, sharp_angle=sharp_angle)
        tally = tallies.setdefault(kind, Tally())
        tally.cases += 1
        if np.array_equal(result.quads, usual.quads):
            tally.same += 1
            difference = np.abs(back(result.vertices, faces)[0] - usual.vertices).max() / edge
            tally.largest = max(tally.largest, float(difference))
        else:
            tally.others.append(case)
        print(case, kind, "same" if case not in tally.others else "other", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
