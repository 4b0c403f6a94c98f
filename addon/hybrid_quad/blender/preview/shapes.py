"""Things to draw, as arrays in the space of an object; nothing here needs a window."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

Color = tuple[float, float, float, float]
Floats = npt.NDArray[np.float32]


@dataclass
class Shape:
    """Lines or triangles in one draw call.

    Attributes
    ----------
    kind : {"LINES", "TRIS"}
    points, colors : (n, 3) and (n, 4) float32
        Of every vertex.
    indices : (m, 3) int32 or None
        Triangles; where there are none, lines have two points each.
    width : float
        Of lines, in pixels.
    lift : float
        How much nearer than it is it counts as, as a part of its distance from the eye: more than what is to be hidden by
        it is in front of it.
    gap : float
        The same as a length in the space of the object, to be added.
    batch : object
        What the graphics card has of it, once it was drawn.
    """

    kind: str
    points: Floats
    colors: Floats
    indices: npt.NDArray[np.int32] | None = None
    width: float = 1.0
    lift: float = 0.002
    gap: float = 0.0
    batch: Any = field(default=None, repr=False)


def lines(ends: npt.NDArray[Any], colors: Color | Floats, width: float, lift: float = 0.002) -> Shape:
    """Lines in one color, or one each.

    Parameters
    ----------
    ends : (k, 2, 3) float
    colors : Color or (k, 4) float
    """
    count = len(ends)
    each = np.broadcast_to(np.asarray(colors, np.float32).reshape(-1, 4), (count, 4))
    points = np.ascontiguousarray(ends, np.float32).reshape(-1, 3)
    return Shape("LINES", points, np.repeat(each, 2, axis=0), width=width, lift=lift)


def solids(middles: npt.NDArray[Any], sizes: npt.NDArray[Any], colors: npt.NDArray[Any], *, is_round: bool) -> Shape:
    """A small ball or cube at each of some points, shaded so that it looks solid.

    Parameters
    ----------
    middles : (k, 3) float
    sizes : (k,) float
        Half their widths.
    colors : (k, 4) float
    """
    corners, triangles = _BALL if is_round else _CUBE
    points = middles[:, None, :] + np.asarray(sizes)[:, None, None] * corners[None]
    shade = 0.65 + 0.35 * corners[:, 2] / np.abs(corners[:, 2]).max()
    rgba = np.repeat(np.asarray(colors, np.float32)[:, None, :], len(corners), axis=1)
    rgba[:, :, :3] *= shade[None, :, None].astype(np.float32)
    indices = (triangles[None] + len(corners) * np.arange(len(middles))[:, None, None]).reshape(-1, 3)
    return Shape(
        "TRIS",
        points.reshape(-1, 3).astype(np.float32),
        rgba.reshape(-1, 4),
        indices.astype(np.int32),
        lift=0.004,
    )


def ramp(values: npt.NDArray[Any], stops: npt.ArrayLike) -> Floats:
    """(k, 4) colors between evenly spaced stops, (s, 3), for values from 0 to 1."""
    table = np.asarray(stops, np.float64)
    at = np.clip(np.asarray(values, np.float64), 0.0, 1.0) * (len(table) - 1)
    colors = np.ones((len(at), 4), np.float32)
    for channel in range(3):
        colors[:, channel] = np.interp(at, np.arange(len(table)), table[:, channel])
    return colors


def _ball() -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]:
    """A unit sphere of 8 by 5 points and the poles."""
    around, rings = 8, 5
    angle = 2 * np.pi * np.arange(around) / around
    points = [np.array([[0.0, 0.0, -1.0]])]
    for ring in range(1, rings + 1):
        tilt = np.pi * ring / (rings + 1)
        height = np.full(around, -np.cos(tilt))
        points.append(np.stack([np.sin(tilt) * np.cos(angle), np.sin(tilt) * np.sin(angle), height], axis=1))
    points.append(np.array([[0.0, 0.0, 1.0]]))
    triangles = []
    last = 1 + around * rings
    for i in range(around):
        j = (i + 1) % around
        triangles += [(0, 1 + j, 1 + i), (last, last - around + i, last - around + j)]
        for ring in range(rings - 1):
            a, b = 1 + ring * around, 1 + (ring + 1) * around
            triangles += [(a + i, a + j, b + j), (a + i, b + j, b + i)]
    return np.concatenate(points), np.array(triangles, np.int32)


def _cube() -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]:
    points = 0.8 * np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float64)
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return points, np.array([t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))], np.int32)


_BALL, _CUBE = _ball(), _cube()
