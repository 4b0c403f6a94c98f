#!/usr/bin/env python3
"""What the field, the quad lines and the quads cost again after a change, with a StageCache and without: a Markdown table.

    .venv/bin/python benchmarks/changes.py [--model FILE] [--quads N] [--rounds N]

Without a model, a bumpy torus of 51 200 triangles. Medians of the rounds, seconds by the clock, on all cores.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

import hybrid_quad
from hybrid_quad.core.mesh_io import read_mesh

SIDE = 160  # points around the torus, either way


def main() -> None:
    """Measures and prints."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--model", type=Path, help="a mesh file")
    parser.add_argument("--quads", type=int, default=3000)
    parser.add_argument("--rounds", type=int, default=5)
    arguments = parser.parse_args()
    points, faces = read_mesh(arguments.model) if arguments.model else torus()
    combed = np.where((points[:, 2] > np.median(points[:, 2]))[:, None], [1.0, 0.2, 0.0], 0.0)

    def field(quads: int = arguments.quads, **more: Any) -> None:
        hybrid_quad.preview(points, faces, hybrid_quad.RemeshOptions(quads=quads), **more)

    def quad_mesh(quads: int = arguments.quads, **more: Any) -> None:
        hybrid_quad.remesh(points, faces, quads=quads, **more)

    other_number = round(1.1 * arguments.quads)
    # What is known, and what is asked for then.
    rows: dict[str, tuple[Callable[..., None], Callable[..., None]]] = {
        "field, nothing known": (lambda **_: None, field),
        "field, another guide": (
            lambda **known: field(guides=combed, **known),
            lambda **known: field(guides=0.5 * combed, **known),
        ),
        "field, another number": (field, lambda **known: field(quads=other_number, **known)),
        "field, another density": (field, lambda **known: field(density=np.where(combed[:, 0] > 0, 1.5, 1.0), **known)),
        "quad lines, after the field": (field, lambda **known: field(with_quads=True, **known)),
        "quads, nothing known": (lambda **_: None, quad_mesh),
        "quads, after the field": (field, quad_mesh),
        "quads, another guide": (
            lambda **known: quad_mesh(guides=combed, **known),
            lambda **known: quad_mesh(guides=0.5 * combed, **known),
        ),
        "quads, another number": (quad_mesh, lambda **known: quad_mesh(quads=other_number, **known)),
    }
    print(f"{len(points)} vertices, {arguments.quads} quads\n")
    print("| asked for | by itself, s | with the cache, s | known |\n|---|--:|--:|---|")
    for name, (before, asked) in rows.items():
        alone = [seconds_of(asked) for _ in range(arguments.rounds)]
        known = []
        for _ in range(arguments.rounds):
            cache = hybrid_quad.StageCache()
            before(cache=cache)
            known.append(seconds_of(lambda asked=asked, cache=cache: asked(cache=cache)))
        stages = ", ".join(sorted(cache.recalled)) or "-"
        print(f"| {name} | {median(alone):.2f} | {median(known):.2f} | {stages} |", flush=True)


def seconds_of(call: Callable[[], None]) -> float:
    """By the clock."""
    began = time.perf_counter()
    call()
    return time.perf_counter() - began


def torus() -> tuple[np.ndarray, np.ndarray]:
    """A torus with bumps, of two triangles for each point."""
    angles = np.linspace(0, 2 * np.pi, SIDE, endpoint=False)
    around, across = np.meshgrid(angles, angles, indexing="ij")
    radius = 0.5 + 0.06 * np.sin(3 * around) * np.cos(2 * across)
    out = 1.3 + radius * np.cos(across)
    points = np.stack([out * np.cos(around), out * np.sin(around), radius * np.sin(across)], axis=-1).reshape(-1, 3)
    a = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    b, d = np.roll(a, -1, axis=0), np.roll(a, -1, axis=1)
    c = np.roll(b, -1, axis=1)
    return points, np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)


if __name__ == "__main__":
    main()
