"""A frame field as crosses and balls on a stage."""

from __future__ import annotations

import numpy as np
from stage import FEWER, MORE, Stage, unit

from hybrid_quad.core.snapshots import Snapshot

CROSS = (0.02, 0.10, 0.20)


def add_field(stage: Stage, field: Snapshot, edge: float) -> None:
    """Crosses about as far apart as the quads, whose edges are `edge` long; its singularities as balls."""
    corners = field.points[field.face_vertices.reshape(-1, 3)]
    middles = corners.mean(axis=1)
    normals = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    shown = spread(middles, 1.2 * edge)
    centre = middles[shown] + 0.03 * edge * normals[shown]
    for name in ("u direction", "v direction"):
        step = 0.5 * edge * unit(field.face_vectors[name][shown])
        ends = np.concatenate([centre - step, centre + step])
        pairs = np.stack([np.arange(len(shown)), np.arange(len(shown)) + len(shown)], axis=1)
        stage.add_wires(ends, pairs, CROSS, 0.05 * edge)
    index = field.vertex_values["cone index"]
    stage.add_balls(field.points[index > 0], FEWER, 0.22 * edge)
    stage.add_balls(field.points[index < 0], MORE, 0.22 * edge)


def spread(points: np.ndarray, distance: float) -> list[int]:
    """Indices of as many of the points as fit with no two closer than `distance`."""
    chosen: list[int] = []
    in_cell: dict[tuple[int, ...], list[int]] = {}
    for index, cell in enumerate(np.floor(points / distance).astype(int).tolist()):
        near = (
            other
            for offset in np.ndindex(3, 3, 3)
            for other in in_cell.get((cell[0] + offset[0] - 1, cell[1] + offset[1] - 1, cell[2] + offset[2] - 1), ())
        )
        if all(np.linalg.norm(points[other] - points[index]) >= distance for other in near):
            chosen.append(index)
            in_cell.setdefault(tuple(cell), []).append(index)
    return chosen
