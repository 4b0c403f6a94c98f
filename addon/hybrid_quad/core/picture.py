"""A small picture of a quad mesh, drawn without a window or 3D hardware: edges, and irregular vertices in colour.

Needs Pillow (the package's extra ``pictures``).
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .mesh_arrays import FloatArray, IntArray
from .mesh_io import replacing

if TYPE_CHECKING:
    from PIL import Image

WIDTH, HEIGHT = 360, 270
_SCALE = 2  # drawn larger by this and then reduced, for smooth lines
_MARGIN = 0.06
_VIEW = np.array([0.45, -0.8, 0.4])  # towards the eye
_LIGHT = np.array([0.1, -0.75, 0.65])
_BACKGROUND, _EDGE = (255, 255, 255), (38, 50, 66)
_FACE = np.array([176, 200, 226], float)
_FEW, _MANY = (240, 120, 0), (20, 70, 230)  # three quads or fewer, five or more
_MOST_POLYGONS = 40_000  # of more quads an edge would be seen nowhere: they are drawn as dots
_MOST_DOTS = 12_000_000
_PALETTE = 64


def can_draw() -> bool:
    """Whether Pillow is there."""
    from importlib.util import find_spec

    return find_spec("PIL") is not None


def write_picture(path: str | Path, vertices: FloatArray, quads: IntArray) -> None:
    """Writes a PNG picture of a mesh as seen from its front, right and above (Blender's axes: z up).

    Parameters
    ----------
    path : path
    vertices : (n, 3) float64
    quads : (m, 4) int32

    Raises
    ------
    ImportError
        Without Pillow.
    MeshFileError
        If the file cannot be written.
    """
    from PIL import Image

    image = draw(vertices, quads).resize((WIDTH, HEIGHT), Image.Resampling.LANCZOS)
    # Few colours, so that a page of many pictures stays small.
    image = image.quantize(_PALETTE, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    with replacing(path) as file:
        image.save(file, format="PNG", optimize=True)


def draw(vertices: FloatArray, quads: IntArray) -> Image.Image:
    """The picture, `_SCALE` times as large as it is written: painted from back to front."""
    size = np.array([WIDTH, HEIGHT]) * _SCALE
    screen, depth = _projected(vertices, size)
    shades, facing = _shades(vertices[quads])
    if len(quads) > _MOST_POLYGONS:
        return _dots(screen, depth, quads, shades, size)
    return _painted(screen, depth, quads, shades, facing, size)


def _projected(vertices: FloatArray, size: npt.NDArray[Any]) -> tuple[FloatArray, FloatArray]:
    """Places in the picture (n, 2), and how near the eye they are (n,)."""
    towards = _VIEW / np.linalg.norm(_VIEW)
    right = np.cross([0.0, 0.0, 1.0], towards)
    right /= np.linalg.norm(right)
    flat = vertices @ np.stack([right, np.cross(towards, right)], axis=1)
    low, high = flat.min(axis=0), flat.max(axis=0)
    room = size * (1 - 2 * _MARGIN)
    scale = float((room / np.maximum(high - low, 1e-30)).min())
    flat = (flat - 0.5 * (low + high)) * scale * np.array([1.0, -1.0]) + 0.5 * size
    return flat, vertices @ towards


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


def _painted(
    screen: FloatArray,
    depth: FloatArray,
    quads: IntArray,
    shades: npt.NDArray[np.uint8],
    facing: npt.NDArray[np.bool_],
    size: npt.NDArray[Any],
) -> Image.Image:
    from PIL import Image, ImageDraw

    image = Image.new("RGB", (int(size[0]), int(size[1])), _BACKGROUND)
    painter = ImageDraw.Draw(image)
    order = np.argsort(depth[quads].mean(axis=1), kind="stable")
    dots = _irregular_after(quads, order, facing, len(screen))
    sides = np.linalg.norm(screen[quads] - screen[np.roll(quads, -1, axis=1)], axis=2)
    usual = float(np.median(sides))
    # Edges thin out where quads are small, so that they do not hide the surface.
    strength = float(np.clip(usual / (6 * _SCALE), 0.25, 1))
    width = _SCALE if usual > 5 * _SCALE else 1
    radius = float(np.clip(0.3 * usual, 1.6 * _SCALE, 3.5 * _SCALE))
    for quad in order.tolist():
        points = [tuple(point) for point in screen[quads[quad]].tolist()]
        fill = tuple(shades[quad].tolist())
        edge = tuple(int(strength * e + (1 - strength) * f) for e, f in zip(_EDGE, fill, strict=True))
        painter.polygon(points, fill=fill)
        painter.line([*points, points[0]], fill=edge, width=width)
        for vertex, colour in dots.get(quad, ()):
            x, y = screen[vertex].tolist()
            painter.ellipse((x - radius, y - radius, x + radius, y + radius), fill=colour)
    return image


def _irregular_after(
    quads: IntArray, order: npt.NDArray[np.intp], facing: npt.NDArray[np.bool_], vertex_count: int
) -> dict[int, list[tuple[int, tuple[int, int, int]]]]:
    """Irregular vertices and their colours, by the quad after which they are drawn: the last around them."""
    valence = np.bincount(quads.reshape(-1), minlength=vertex_count)
    inner = np.ones(vertex_count, bool)
    sides = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    edges, uses = np.unique(sides, axis=0, return_counts=True)
    inner[edges[uses == 1].reshape(-1)] = False
    seen = np.zeros(vertex_count, bool)
    seen[quads[facing].reshape(-1)] = True
    rank = np.empty(len(quads), np.int64)
    rank[order] = np.arange(len(quads))
    last = np.full(vertex_count, -1)
    np.maximum.at(last, quads.reshape(-1), np.repeat(rank, 4))
    found: dict[int, list[tuple[int, tuple[int, int, int]]]] = {}
    for vertex in np.flatnonzero((valence != 4) & (valence > 0) & inner & seen).tolist():
        colour = _FEW if valence[vertex] < 4 else _MANY
        found.setdefault(int(order[last[vertex]]), []).append((vertex, colour))
    return found


def _dots(
    screen: FloatArray, depth: FloatArray, quads: IntArray, shades: npt.NDArray[np.uint8], size: npt.NDArray[Any]
) -> Image.Image:
    """Quads as grids of dots closer than pixels, the nearest of which is seen."""
    from PIL import Image

    sides = np.linalg.norm(screen[quads] - screen[np.roll(quads, -1, axis=1)], axis=2).max(axis=1)
    steps = int(np.clip(np.ceil(1.5 * np.percentile(sides, 99)), 1, max(1.0, (_MOST_DOTS / len(quads)) ** 0.5)))
    nearest = np.full(int(size[0] * size[1]), -np.inf)
    seen = np.full(len(nearest), -1)
    for u in (np.arange(steps) + 0.5) / steps:
        for v in (np.arange(steps) + 0.5) / steps:
            weights = np.array([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v])
            place = np.einsum("qci,c->qi", screen[quads], weights).astype(np.int64)
            near = depth[quads] @ weights
            pixel = np.clip(place[:, 1], 0, size[1] - 1) * size[0] + np.clip(place[:, 0], 0, size[0] - 1)
            np.maximum.at(nearest, pixel, near)
            foremost = near >= nearest[pixel]
            seen[pixel[foremost]] = np.flatnonzero(foremost)
    pixels = np.full((len(nearest), 3), 255, np.uint8)
    pixels[seen >= 0] = shades[seen[seen >= 0]]
    return Image.fromarray(pixels.reshape(int(size[1]), int(size[0]), 3))
