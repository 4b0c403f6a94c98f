"""Small surfaces made on the spot: (vertices, faces), faces as an array or, where sizes differ, a list of lists."""

from __future__ import annotations

import numpy as np


def grid(columns: int, rows: int, width: float = 1.0, height: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """Flat rectangle of triangles, open."""
    x, y = np.meshgrid(np.linspace(0, width, columns + 1), np.linspace(0, height, rows + 1))
    vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    return vertices, _triangles_of(_lattice(columns, rows))


def wavy_grid(count: int = 20) -> tuple[np.ndarray, np.ndarray]:
    """Open height field without sharp edges."""
    vertices, faces = grid(count, count)
    vertices[:, 2] = 0.15 * np.sin(4 * vertices[:, 0]) * np.cos(3 * vertices[:, 1])
    return vertices, faces


def annulus(around: int = 40, across: int = 6) -> tuple[np.ndarray, np.ndarray]:
    """Flat ring: two boundary loops."""
    lattice, faces = grid(around, across)
    angle, radius = 2 * np.pi * lattice[:, 0], 0.5 + lattice[:, 1]
    vertices = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(len(angle))])
    return _glue_columns(vertices, faces[:, ::-1], around)


def cylinder(around: int = 32, along: int = 12) -> tuple[np.ndarray, np.ndarray]:
    """Open tube."""
    lattice, faces = grid(around, along)
    angle = 2 * np.pi * lattice[:, 0]
    vertices = np.column_stack([np.cos(angle), np.sin(angle), 3 * lattice[:, 1]])
    return _glue_columns(vertices, faces, around)


def torus(around: int = 40, across: int = 20, tube: float = 0.4) -> tuple[np.ndarray, np.ndarray]:
    """Closed, genus 1."""
    i, j = np.divmod(np.arange(around * across), across)
    u, v = 2 * np.pi * i / around, 2 * np.pi * j / across
    ring = 1 + tube * np.cos(v)
    vertices = np.column_stack([ring * np.cos(u), ring * np.sin(u), tube * np.sin(v)])
    right, up = (i + 1) % around * across, (j + 1) % across
    corners = np.column_stack([i * across + j, right + j, right + up, i * across + up])
    return vertices, _triangles_of(corners)


def box(n: int = 6, size: tuple[float, float, float] = (1.0, 1.0, 1.0)) -> tuple[np.ndarray, np.ndarray]:
    """Closed box of n x n quads a side, each split in two: twelve sharp edges, eight corners."""
    vertices, quads = quad_box(n)
    return vertices * size, _triangles_of(quads)


def sphere(n: int = 8) -> tuple[np.ndarray, np.ndarray]:
    """Closed, genus 0, smooth: a box blown up."""
    vertices, faces = box(n)
    vertices = 2 * vertices - 1
    return vertices / np.linalg.norm(vertices, axis=1, keepdims=True), faces


def wire(course: np.ndarray, radius: float, sides: int = 8) -> tuple[np.ndarray, np.ndarray]:
    """A closed tube of triangles along a polyline (#points x 3), flat at both ends."""
    along = np.gradient(course, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    turn = 2 * np.pi * np.arange(sides) / sides
    across = np.cross(along[0], [0.3, 0.5, 0.8])
    rings = []
    for point, direction in zip(course, along, strict=True):
        across = across - direction * (across @ direction)
        across = across / np.linalg.norm(across)
        rings.append(
            point + radius * (np.outer(np.cos(turn), across) + np.outer(np.sin(turn), np.cross(direction, across)))
        )
    next_one = np.roll(np.arange(sides), -1)
    faces = []
    for first in range(0, (len(course) - 1) * sides, sides):
        a, b = first + np.arange(sides), first + next_one
        faces += [np.stack([a, b, b + sides], axis=1), np.stack([a, b + sides, a + sides], axis=1)]
    ends, last = len(course) * sides, (len(course) - 1) * sides
    faces += [np.stack([np.full(sides, ends), next_one, np.arange(sides)], axis=1)]
    faces += [np.stack([np.full(sides, ends + 1), last + np.arange(sides), last + next_one], axis=1)]
    return np.concatenate([*rings, course[[0, -1]]]), np.concatenate(faces)


def unrolled_sphere(around: int = 32, along: int = 16, *, single: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """As programs make it from angles: quads, with a vertex for each meridian at the poles and the last meridian beside the first."""
    kind = np.float32 if single else np.float64
    turn, height = np.meshgrid(
        np.linspace(0, 2 * np.pi, around + 1, dtype=kind), np.linspace(0, np.pi, along + 1, dtype=kind)
    )
    vertices = np.stack([np.cos(turn) * np.sin(height), np.sin(turn) * np.sin(height), np.cos(height)], axis=2)
    first = (np.arange(along)[:, None] * (around + 1) + np.arange(around)).ravel()
    faces = np.stack([first, first + around + 1, first + around + 2, first + 1], axis=1)
    return vertices.reshape(-1, 3).astype(np.float64), faces


def horned_sphere(length: float, radius: float, around: int = 32, along: int = 140) -> tuple[np.ndarray, np.ndarray]:
    """Unit sphere, of genus 0, with a round horn on its top that gets thinner from `radius` to two fifths of it."""
    arc = np.pi - np.arcsin(radius)
    s = np.arange(1, along) / along * (arc + length)
    beyond = np.maximum(s - arc, 0)
    width = np.where(s < arc, np.sin(s), radius * (1 - 0.6 * beyond / length))
    height = np.where(s < arc, -np.cos(s), np.cos(arc - np.pi) + beyond)
    angle = 2 * np.pi * np.arange(around) / around
    rings = np.stack(
        [np.outer(width, np.cos(angle)), np.outer(width, np.sin(angle)), np.outer(height, np.ones(around))], -1
    )
    vertices = np.concatenate([[[0, 0, -1]], rings.reshape(-1, 3), [[0, 0, height[-1]]]])
    i, j = np.divmod(np.arange((along - 2) * around), around)
    this, right = 1 + i * around + j, 1 + i * around + (j + 1) % around
    side = _triangles_of(np.column_stack([this, right, right + around, this + around]))
    ring, top = np.arange(around), len(vertices) - 1
    foot = np.column_stack([np.zeros(around, int), 1 + (ring + 1) % around, 1 + ring])
    cap = np.column_stack([top - around + ring, top - around + (ring + 1) % around, np.full(around, top)])
    return vertices, np.concatenate([foot, side, cap])


def quad_box(n: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """The unit cube's surface as n x n quads a side."""
    vertices: dict[tuple[int, int, int], int] = {}
    faces = []

    def number(point: tuple[int, int, int]) -> int:
        return vertices.setdefault(point, len(vertices))

    for axis in range(3):
        for side in (0, n):
            for i in range(n):
                for j in range(n):
                    ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                    points = [_insert(a, b, axis, side) for a, b in (ring if side else ring[::-1])]
                    faces.append([number(point) for point in points])
    return np.array(list(vertices), float) / n, np.array(faces)


def grille(
    bars: int, bar: float, gap: float, height: float, length: float = 40.0, frame: float = 10.0
) -> tuple[np.ndarray, np.ndarray]:
    """A plate with a row of slots and bars between them: a frame that wide, bars that long, everything `height` thick."""
    across = np.concatenate(
        [[0, frame], frame + gap + np.repeat(np.arange(bars) * (gap + bar), 2) + np.tile([0, bar], bars)]
    )
    across = np.concatenate([across, across[-1] + gap + np.array([0, frame])])
    along = np.array([0, frame, frame + length, 2 * frame + length])
    is_solid = np.pad(np.ones((len(across) - 1, 3), bool), 1)
    is_solid[2:-2:2, 2] = False
    number: dict[tuple[int, int, int], int] = {}
    quads = []
    for i, j in np.argwhere(is_solid) - 1:
        (a, b), (c, d) = ((i, j), (i + 1, j)), ((i + 1, j + 1), (i, j + 1))
        sides = [[(*a, 1), (*b, 1), (*c, 1), (*d, 1)], [(*a, 0), (*d, 0), (*c, 0), (*b, 0)]]
        for (di, dj), (p, q) in {(0, -1): (a, b), (1, 0): (b, c), (0, 1): (c, d), (-1, 0): (d, a)}.items():
            if not is_solid[i + 1 + di, j + 1 + dj]:
                sides.append([(*p, 0), (*q, 0), (*q, 1), (*p, 1)])
        quads += [[number.setdefault(corner, len(number)) for corner in side] for side in sides]
    vertices = np.array([(across[i], along[j], k * height) for i, j, k in number])
    return vertices, _triangles_of(np.array(quads))


def mixed_polygons() -> tuple[np.ndarray, list[list[int]]]:
    """A prism over an L: two concave hexagons and six quads, closed."""
    outline = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    vertices = np.array([(*point, z) for z in (0, 1) for point in outline], float)
    sides = [[i, (i + 1) % 6, 6 + (i + 1) % 6, 6 + i] for i in range(6)]
    return vertices, [[5, 4, 3, 2, 1, 0], [6, 7, 8, 9, 10, 11], *sides]


def moebius(around: int = 40, across: int = 4) -> tuple[np.ndarray, np.ndarray]:
    """Strip with one side: no consistent orientation exists."""
    i, j = np.divmod(np.arange(around * (across + 1)), across + 1)
    angle, offset = 2 * np.pi * i / around, (j / across - 0.5) * 0.6
    ring = 1 + offset * np.cos(angle / 2)
    vertices = np.column_stack([ring * np.cos(angle), ring * np.sin(angle), offset * np.sin(angle / 2)])

    def at(column: int, row: int) -> int:
        return column * (across + 1) + row if column < around else across - row

    quads = [[at(c, r), at(c + 1, r), at(c + 1, r + 1), at(c, r + 1)] for c in range(around) for r in range(across)]
    return vertices, _triangles_of(np.array(quads))


def together(*parts: tuple[np.ndarray, np.ndarray], gap: float = 5.0) -> tuple[np.ndarray, np.ndarray]:
    """Several surfaces side by side in one mesh."""
    vertices, faces, count = [], [], 0
    for index, (points, triangles) in enumerate(parts):
        vertices.append(points + np.array([gap * index, 0, 0]))
        faces.append(triangles + count)
        count += len(points)
    return np.concatenate(vertices), np.concatenate(faces)


def _lattice(columns: int, rows: int) -> np.ndarray:
    j, i = np.divmod(np.arange(columns * rows), columns)
    first = j * (columns + 1) + i
    return np.column_stack([first, first + 1, first + columns + 2, first + columns + 1])


def _triangles_of(quads: np.ndarray) -> np.ndarray:
    """Split by alternating diagonals, so that no direction is favoured."""
    flip = (np.arange(len(quads)) % 2).astype(bool)
    turned = np.where(flip[:, None], np.roll(quads, 1, axis=1), quads)
    return np.concatenate([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])


def _glue_columns(vertices: np.ndarray, faces: np.ndarray, columns: int) -> tuple[np.ndarray, np.ndarray]:
    """Identifies the last column of a lattice with the first."""
    column = np.arange(len(vertices)) % (columns + 1)
    kept = column < columns
    number = np.cumsum(kept) - 1
    number[~kept] = number[np.flatnonzero(~kept) - columns]
    return vertices[kept], number[faces]


def _insert(a: int, b: int, axis: int, value: int) -> tuple[int, int, int]:
    """Coordinates a, b in the two directions after `axis` and `value` along it."""
    point = [0, 0, 0]
    point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3] = value, a, b
    return point[0], point[1], point[2]
