"""A small picture of a quad mesh, drawn without a window or 3D hardware: edges, and irregular vertices in colour.

Quads are drawn as dots closer than pixels, the nearest of which is seen.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .file_places import FilesTogether, replacing
from .mesh_arrays import FloatArray, IntArray
from .png_file import Pixels, png_of

WIDTH, HEIGHT = 360, 270
_SCALE = 2  # drawn larger by this and then reduced, for smooth lines
_MARGIN = 0.06
_VIEW = np.array([0.45, -0.8, 0.4])  # towards the eye
_LIGHT = np.array([0.1, -0.75, 0.65])
_BACKGROUND, _EDGE = (255, 255, 255), (38, 50, 66)
_FACE = np.array([176, 200, 226], float)
_FEW, _MANY = (240, 120, 0), (20, 70, 230)  # three quads or fewer, five or more
_PALETTE = 64
_DOTS_IN_A_PIXEL = 1.2  # along each side of a quad
_DOTS_AT_ONCE = 1_000_000
_LEVELS = 1 << 28  # of nearness


def write_picture(
    path: str | Path, vertices: FloatArray, quads: IntArray, together: FilesTogether | None = None
) -> None:
    """Writes a PNG picture of a mesh as seen from its front, right and above (Blender's axes: z up).

    Parameters
    ----------
    path : path
    vertices : (n, 3) float64
    quads : (m, 4) int32
    together : FilesTogether, optional
        Files with which it takes its place.

    Raises
    ------
    MeshFileError
        If the file cannot be written.
    """
    large = draw(vertices, quads).reshape(HEIGHT, _SCALE, WIDTH, _SCALE, 3)
    pixels = np.rint(large.mean(axis=(1, 3))).astype(np.uint8)
    # Few colours, so that a page of many pictures stays small.
    with together.replacing(path) if together else replacing(path) as file:
        file.write(png_of(pixels, _PALETTE, kept=(_BACKGROUND, _FEW, _MANY)))


def draw(vertices: FloatArray, quads: IntArray) -> Pixels:
    """The picture's pixels from the top, `_SCALE` times as many along each side as are written: (height, width, 3) uint8."""
    size = np.array([WIDTH, HEIGHT]) * _SCALE
    placed = _projected(vertices, size)
    shades, facing = _shades(vertices[quads])
    sides = _sides(placed[quads, :2])
    usual = float(np.median(sides.lengths)) if len(quads) else 0.0
    # Edges thin out where quads are small, so that they do not hide the surface.
    strength = float(np.clip((usual - 2) / (5 * _SCALE), 0, 1))
    half_width = 0.4 * (_SCALE if usual > 5 * _SCALE else 1)
    edges = np.rint(strength * np.array(_EDGE) + (1 - strength) * shades).astype(np.uint8)
    radius = float(np.clip(0.3 * usual, 1.6 * _SCALE, 3.5 * _SCALE))
    colours = np.concatenate([shades, edges, np.array([_FEW, _MANY], np.uint8)])
    canvas = _Canvas(size, colours, (placed[:, 2].min(), placed[:, 2].max() + 2 * radius))
    for some, u, v in _grids(sides):
        weights = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1)
        dots = np.matmul(weights, placed[quads[some]])
        from_edge = np.minimum([u, v], [1 - u, 1 - v]).T * sides.widths[some, None]
        is_edge = from_edge.min(axis=2) < half_width
        canvas.put(dots.reshape(-1, 3), (some[:, None] + len(quads) * is_edge).reshape(-1))
    vertex, is_many = _irregular(quads, facing, len(vertices))
    reach = np.arange(-int(radius), int(radius) + 1)
    disc = np.stack(np.meshgrid(reach, reach, 2 * radius), axis=-1).reshape(-1, 3)
    disc = disc[(disc[:, :2] ** 2).sum(axis=1) <= radius**2]
    # In front of the surface that they are on, and behind what is nearer than that.
    canvas.put((placed[vertex, None] + disc).reshape(-1, 3), np.repeat(2 * len(quads) + is_many, len(disc)))
    return canvas.pixels()


def _irregular(
    quads: IntArray, facing: npt.NDArray[np.bool_], vertex_count: int
) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.bool_]]:
    """Irregular vertices off the boundary, the front of a quad around which is seen, and whether five or more meet there."""
    valence = np.bincount(quads.reshape(-1), minlength=vertex_count)
    inner, front = np.ones(vertex_count, bool), np.zeros(vertex_count, bool)
    sides = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, uses = np.unique(sides, axis=0, return_counts=True)
    inner[edges[uses == 1].reshape(-1)] = False
    front[quads[facing].reshape(-1)] = True
    vertex = np.flatnonzero((valence != 4) & (valence > 0) & inner & front)
    return vertex, valence[vertex] > 4


def _projected(vertices: FloatArray, size: npt.NDArray[Any]) -> FloatArray:
    """Columns and rows in the picture, and how near the eye they are, in pixels: (n, 3)."""
    towards = _VIEW / np.linalg.norm(_VIEW)
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    flat = vertices @ np.stack([right, np.cross(towards, right)], axis=1)
    low, high = flat.min(axis=0), flat.max(axis=0)
    room = size * (1 - 2 * _MARGIN)
    scale = float((room / np.maximum(high - low, 1e-30)).min())
    flat = (flat - 0.5 * (low + high)) * scale * np.array([1.0, -1.0]) + 0.5 * size
    return np.column_stack([flat, scale * (vertices @ towards)])


def _shades(corners: FloatArray) -> tuple[npt.NDArray[np.uint8], npt.NDArray[np.bool_]]:
    """(m, 3) colours of quads, the same seen from both sides, and whether their front is seen."""
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    facing = normals @ _VIEW > 0
    light = np.where(facing, 1.0, -1.0) * (normals @ (_LIGHT / np.linalg.norm(_LIGHT)))
    bright = 0.55 + 0.45 * np.clip(light, -0.5, 1)[:, None]
    # Backs are seen through openings, or where a mesh is inside out; a warmer grey tells them apart.
    base = np.where(facing[:, None], _FACE, _FACE[[2, 1, 0]])
    colours: npt.NDArray[np.uint8] = np.clip(base * bright + 12, 0, 255).astype(np.uint8)
    return colours, facing


class _Canvas:
    """Pixels: what is nearest in each, and its colour, as one number that is the greater the nearer it is."""

    def __init__(self, size: npt.NDArray[np.int64], colours: Pixels, nearness: tuple[float, float]) -> None:
        """Nothing yet; `nearness` says between what values that of all dots is."""
        self._size, self._colours = size, np.concatenate([colours, np.array([_BACKGROUND], np.uint8)])
        self._seen = np.full(int(size.prod()), -1, np.int64)
        self._least, self._unit = nearness[0], _LEVELS / max(nearness[1] - nearness[0], 1e-30)

    def put(self, dots: FloatArray, colours: npt.NDArray[np.int64]) -> None:
        """Dots (n, 3), column, row and nearness, with the numbers of their colours; each is seen where nothing nearer is."""
        column, row = np.clip(dots[:, :2].astype(np.int64), 0, self._size - 1).T
        level = ((dots[:, 2] - self._least) * self._unit).astype(np.int64)
        np.maximum.at(self._seen, row * self._size[0] + column, (level << 32) + colours)

    def pixels(self) -> Pixels:
        """(height, width, 3) uint8."""
        colour = np.where(self._seen < 0, len(self._colours) - 1, self._seen & 0xFFFFFFFF)
        return self._colours[colour].reshape(int(self._size[1]), int(self._size[0]), 3)


class _Sides(NamedTuple):
    """Of quads in the picture, in pixels: (m, 2) lengths along u and v, and (m, 2) widths across, of the same area."""

    lengths: FloatArray
    widths: FloatArray


def _sides(corners: FloatArray) -> _Sides:
    around = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
    lengths = np.maximum(around[:, :2], around[:, 2:])
    first, second = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
    area = 0.5 * np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    return _Sides(lengths, area[:, None] / np.maximum(lengths[:, ::-1], 1e-9))


def _grids(sides: _Sides) -> Iterator[tuple[npt.NDArray[np.intp], FloatArray, FloatArray]]:
    """Quads of about the same size, some at a time, with the u and v of dots on each."""
    level = np.ceil(2 * np.log2(np.maximum(_DOTS_IN_A_PIXEL * sides.lengths, 1)))
    steps = np.ceil(2 ** (0.5 * level)).astype(np.int64)
    kinds, kind_of = np.unique(steps, axis=0, return_inverse=True)
    for number, (along, across) in enumerate(kinds.tolist()):
        u, v = np.meshgrid((np.arange(along) + 0.5) / along, (np.arange(across) + 0.5) / across)
        chosen = np.flatnonzero(kind_of.reshape(-1) == number)
        for some in np.array_split(chosen, 1 + len(chosen) * u.size // _DOTS_AT_ONCE):
            yield some, u.reshape(-1), v.reshape(-1)
