"""Lines drawn on a surface: made even and smooth, and partly erased or smoothed by a brush."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..mesh_arrays import FloatArray
from .falloff import falloff_at
from .value_strokes import Brush

_ROUNDS = 2  # of smoothing a drawn line, each over three points
# A line whose ends are within the radius of each other is closed where it is this many radii long.
_SHORTEST_LOOP = 4.0


class Line(NamedTuple):
    """A line on a surface.

    Attributes
    ----------
    points : (k, 3) float64
        Of a closed line every one once.
    is_closed : bool
    """

    points: FloatArray
    is_closed: bool


def drawn_line(points: FloatArray, spacing: float, radius: float) -> Line | None:
    """What a pen drew, as points `spacing` apart, without its trembling; None where it did not move.

    Parameters
    ----------
    points : (k, 3) float64
    spacing : float
    radius : float
        Ends as near as this are joined.
    """
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    length = float(steps.sum())
    if length < spacing:
        return None
    gap = float(np.linalg.norm(points[-1] - points[0]))
    is_closed = gap <= radius and length >= _SHORTEST_LOOP * radius
    if is_closed:
        points, length = np.concatenate([points, points[:1]]), length + gap
    count = max(3 if is_closed else 1, round(length / spacing))
    along = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    wanted = np.linspace(0, along[-1], count + 1)
    even = np.stack([np.interp(wanted, along, points[:, i]) for i in range(3)], axis=1)
    line = Line(even[:-1] if is_closed else even, is_closed)
    for _ in range(_ROUNDS):
        line = line._replace(points=0.5 * (line.points + _neighbor_means(line)))
    return line


def erased(lines: list[Line], centers: FloatArray, radius: float) -> list[list[Line]]:
    """What is left of each line where a brush took everything within `radius` of its centers: a list of pieces.

    A line that was not touched is its own only piece, the same object.
    """
    return [_pieces(line, _distance_to(line.points, centers) >= radius) for line in lines]


def smoothed(line: Line, centers: FloatArray, brush: Brush, strength: float) -> Line:
    """A line whose points near the centers are nearer to the middle of their neighbours; the same object if there are none."""
    weight = 0.5 * strength * falloff_at(_distance_to(line.points, centers), *brush)
    if not weight.any():
        return line
    return line._replace(points=line.points + weight[:, None] * (_neighbor_means(line) - line.points))


def _pieces(line: Line, kept: npt.NDArray[np.bool_]) -> list[Line]:
    if kept.all():
        return [line]
    points = line.points
    if line.is_closed:  # begin where something was taken
        shift = int(np.flatnonzero(~kept)[0])
        points, kept = np.roll(points, -shift, axis=0), np.roll(kept, -shift)
    runs = np.split(np.arange(len(points)), np.flatnonzero(np.diff(kept)) + 1)
    return [Line(points[run], False) for run in runs if kept[run[0]] and len(run) > 1]


def _neighbor_means(line: Line) -> FloatArray:
    """(k, 3) the middle of both neighbours of each point; the ends of an open line themselves."""
    means: FloatArray = 0.5 * (np.roll(line.points, 1, axis=0) + np.roll(line.points, -1, axis=0))
    if not line.is_closed:
        means[[0, -1]] = line.points[[0, -1]]
    return means


def _distance_to(points: FloatArray, centers: FloatArray) -> FloatArray:
    """(k,) from each point to the nearest center."""
    if not len(centers):
        return np.full(len(points), np.inf)
    distances: FloatArray = np.linalg.norm(points[:, None] - centers[None], axis=2).min(axis=1)
    return distances
