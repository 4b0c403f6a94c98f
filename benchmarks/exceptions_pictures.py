"""What the pictures of docs/exceptions.md show, and the sheets that they are put on."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw

from hybrid_quad.core.mesh_arrays import FloatArray, IntArray
from input_patch import Ball, InputSurface
from kept_lines import KeptLines
from shape_causes import CAUSES, OPEN, Inspector, Measured

AROUND_QUAD = 1.4  # times its radius: what is to be seen
FRAME = (0.3, 1.6)  # edge lengths: the least and the most of it
BEYOND = 1.5  # times as much is drawn
COLUMNS = 3
CAPTION = 30  # pixels
MOST_BYTES = 400 << 10


def shown_causes(quads: Sequence[dict[str, Any]]) -> list[str]:
    """That of a run's worst quad, and "open" if any is: each gets a picture.

    Parameters
    ----------
    quads : list of dict
        Bad quads with their causes, the worst first.
    """
    causes = [str(quad["cause"]) for quad in quads]
    return list(dict.fromkeys([causes[0], *[cause for cause in causes if cause == OPEN]]))


def panel_name(run: str, cause: str) -> str:
    """Of the file that a picture is drawn from."""
    return f"{run}.{cause.replace(' ', '-')}.npz"


def scene(
    surface: InputSurface,
    lines: KeptLines,
    vertices: FloatArray,
    quads: IntArray,
    bad: IntArray,
    worst: int,
    length: float,
) -> dict[str, np.ndarray]:
    """Input, quads and lines around a quad, as far as they hang together, two rings of quads, seen from its side of the surface.

    Returns
    -------
    dict of arrays
        points (n, 3), triangles (t, 3), vertices (m, 3), quads (q, 4), is_bad (q,), lines (l, 2, 3), with the quad's middle at the
        origin, the surface's normal up, and `edges` () asked edge lengths as unit: half the width of what is to be seen.
    """
    corners = vertices[quads[worst]]
    middle = corners.mean(axis=0)
    reach = float(np.linalg.norm(corners - middle, axis=1).max())
    unit = float(np.clip(AROUND_QUAD * reach, *(length * limit for limit in FRAME)))
    ball = Ball(middle, BEYOND * max(unit, reach))
    seed = Inspector(surface, lines, vertices, quads, length).place_of(corners)[0]
    faces = surface.patch(ball, seed)
    close = surface.patch(Ball(middle, max(unit, reach)), seed)
    normals = surface.normals[close]
    weight = np.minimum(surface.area[close], unit**2) * (normals @ surface.normals[seed] > 0)
    turn = _upright((weight[:, None] * normals).sum(axis=0)) / unit
    shown = _rings(quads, worst)
    beside = lines.is_line & np.isin(surface.edge_faces, faces).any(axis=1)
    pieces = _cut(surface.points[surface.edges[beside]], middle, ball.radius)
    used, triangles = np.unique(surface.triangles[faces], return_inverse=True)
    kept, cells = np.unique(quads[shown], return_inverse=True)
    return {
        "points": (surface.points[used] - middle) @ turn.T,
        "triangles": triangles.reshape(-1, 3),
        "vertices": (vertices[kept] - middle) @ turn.T,
        "quads": cells.reshape(-1, 4),
        "is_bad": np.isin(shown, bad),
        "lines": (pieces - middle) @ turn.T,
        "edges": np.array(unit / length),
    }


def _rings(quads: IntArray, start: int) -> IntArray:
    """A quad and its neighbours across vertices, and theirs."""
    shown = np.array([start])
    for _ in range(2):
        shown = np.flatnonzero(np.isin(quads, quads[shown]).any(axis=1))
    return shown


def sheets(rows: Sequence[dict[str, Any]], panels: Path, folder: Path) -> dict[str, Path]:
    """Puts pictures in `panels` on one sheet for each cause, as JPEG files in `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    for old in folder.glob("*.jpg"):
        old.unlink()
    made = {}
    for cause in CAUSES:
        shown = [row for row in rows if cause in shown_causes(row["quads"])]
        if shown:
            made[cause] = folder / f"{cause.replace(' ', '-')}.jpg"
            _sheet([(panels / panel_name(row["name"], cause), _caption(row, cause)) for row in shown], made[cause])
    return made


def _caption(row: dict[str, Any], cause: str) -> str:
    worst = next(quad for quad in row["quads"] if quad["cause"] == cause)
    number = number_of(Measured.of_json(worst["at"]), cause)
    return f"{row['model']}, {row['asked']}, {row['setting'].replace('_', ' ')}\nSJ {worst['sj']:.2f}{number and ', ' + number}"


def number_of(at: Measured, cause: str) -> str:
    """What was measured for a cause, in words."""
    tip, lines, fold, neck, sheet, _ = CAUSES
    if cause == tip:
        return f"{at.tip:.1f}°"
    if cause == lines:
        nearest = min(at.gap, at.corners)
        return f"{'corners' if at.corners < at.gap else 'lines'} {nearest:.2f} edges apart"
    if cause == fold:
        return f"{at.fold:.0f}°"
    if cause == neck:
        return f"{at.around:.0f} edges around"
    if cause == sheet:
        return f"{at.sheet:.2f} edges thick"
    return f"{at.degrees_a_quad:.0f}° for one quad" if at.degrees_a_quad >= 180 else ""


def _sheet(pictures: Sequence[tuple[Path, str]], path: Path) -> None:
    images = [(Image.open(file.with_suffix(".png")).convert("RGB"), text) for file, text in pictures]
    width = max(image.width for image, _ in images)
    columns = min(COLUMNS, len(images))
    rows = [images[i : i + columns] for i in range(0, len(images), columns)]
    heights = [max(image.height for image, _ in row) + CAPTION for row in rows]
    sheet = Image.new("RGB", (columns * width, sum(heights)), "white")
    draw = ImageDraw.Draw(sheet)
    for number, row in enumerate(rows):
        for column, (image, text) in enumerate(row):
            corner = (column * width, sum(heights[:number]))
            draw.multiline_text((corner[0] + 6, corner[1] + 4), text, fill="black", spacing=2)
            sheet.paste(image, (corner[0], corner[1] + CAPTION))
    for quality in range(85, 10, -10):
        sheet.save(path, quality=quality, optimize=True)
        if path.stat().st_size <= MOST_BYTES:
            return


def _upright(normal: FloatArray) -> FloatArray:
    """(3, 3) The turn that takes a direction to +z."""
    up = normal / max(float(np.linalg.norm(normal)), 1e-300)
    side = np.cross(up, np.eye(3)[np.abs(up).argmin()])
    side /= np.linalg.norm(side)
    return np.stack([side, np.cross(up, side), up])


def _cut(ends: FloatArray, centre: FloatArray, radius: float) -> FloatArray:
    """(l, 2, 3) The parts of segments inside a ball."""
    begin, way = ends[:, 0], ends[:, 1] - ends[:, 0]
    squared = np.maximum((way * way).sum(axis=1), 1e-300)
    at = ((centre - begin) * way).sum(axis=1) / squared
    off = np.linalg.norm(begin + at[:, None] * way - centre, axis=1)
    half = np.sqrt(np.maximum(radius**2 - off**2, 0) / squared)
    low, high = np.clip(at - half, 0, 1), np.clip(at + half, 0, 1)
    kept = (off < radius) & (low < high)
    pieces: FloatArray = np.stack([begin + low[:, None] * way, begin + high[:, None] * way], axis=1)[kept]
    return pieces
