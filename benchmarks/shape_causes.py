"""Why a quad is badly shaped: what the input's surface and lines are like where it lies, and the cause that follows from it.

All lengths are in asked edge lengths: the side of a square with the area that each of the asked quads gets.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np

from hybrid_quad.core.mesh_arrays import FloatArray, IntArray
from hybrid_quad.core.surface_points import nearest_in_triangles
from input_patch import Ball, InputSurface
from kept_lines import ON_LINE, KeptLines

ACUTE_DEGREES = 30.0
NEAR_LINES = 0.5
FOLD_DEGREES = 100.0  # more than a right-angled edge or corner has
THIN = 0.5
AROUND = 4.0
QUAD_RADIUS = math.sqrt(0.5)  # half the diagonal of an even quad
OPPOSITE = -0.7  # cosine
SAME = 0.1  # sine: a quad without width has several worst corners

TIP, LINES, FOLD, NECK, SHEET, OPEN = "acute tip", "lines closer than a quad", "fold", "neck", "thin sheet", "open"
CAUSES = (TIP, LINES, FOLD, NECK, SHEET, OPEN)  # the first that holds is named


@dataclass(frozen=True)
class Measured:
    """What the input is like at a quad.

    Attributes
    ----------
    tip : float
        Degrees between the lines, on the quad's side, at the sharpest of its worst corners that lie on lines; infinite elsewhere.
    gap : float
        Edge lengths between two lines, or parts of one that lie beside each other, both within half an edge of the quad.
    corners : float
        Edge lengths between two corners of lines within half an edge of the quad.
    fold : float
        Degrees that the surface's normals differ by within the radius of a quad, on this side of lines.
    around : float
        Edges that fit around the thinnest tube, hole, finger or pit that the quad lies at; infinite above 4.
    sheet : float
        Edge lengths to the surface's other side, where that is reached around a rim within an edge length; infinite above a half.
    degrees_a_quad : float
        The most that one quad has to fill at the quad's vertices that lie on lines: from 180 on it cannot be convex.
    """

    tip: float = math.inf
    gap: float = math.inf
    corners: float = math.inf
    fold: float = 0.0
    around: float = math.inf
    sheet: float = math.inf
    degrees_a_quad: float = 0.0

    @property
    def holds(self) -> dict[str, bool]:
        """Which causes apply."""
        return {
            TIP: self.tip < ACUTE_DEGREES,
            LINES: min(self.gap, self.corners) < NEAR_LINES,
            FOLD: self.fold > FOLD_DEGREES,
            NECK: self.around < AROUND,
            SHEET: self.sheet < THIN,
        }

    @property
    def cause(self) -> str:
        """The first that applies, or "open"."""
        return next((cause for cause, applies in self.holds.items() if applies), OPEN)

    def as_json(self) -> dict[str, float | None]:
        """Numbers, None for infinite."""
        return {name: None if math.isinf(value) else round(value, 3) for name, value in asdict(self).items()}

    @classmethod
    def of_json(cls, row: dict[str, float | None]) -> Measured:
        """What `as_json` gave."""
        return cls(**{name: math.inf if value is None else value for name, value in row.items()})


class Inspector:
    """Measures the input at quads of a result.

    Parameters
    ----------
    surface : InputSurface
    lines : KeptLines
    vertices : (n, 3) float
    quads : (m, 4) int
    length : float
        Of the asked edges.
    """

    def __init__(
        self, surface: InputSurface, lines: KeptLines, vertices: FloatArray, quads: IntArray, length: float
    ) -> None:
        self._surface, self._lines, self._length = surface, lines, length
        self._vertices, self._quads = vertices, quads

    def measure(self, quad: int) -> Measured:
        """Of one quad by its number."""
        surface, length = self._surface, self._length
        corners = self._vertices[self._quads[quad]]
        seed, middle = self.place_of(corners)
        ball = Ball(middle, QUAD_RADIUS * length)
        patch = surface.patch(ball, seed, self._lines.is_line)
        tip, degrees_a_quad = self._at_corners(quad)
        gap, corner_gap = self._gaps(corners, middle, seed)
        return Measured(
            tip=tip,
            gap=gap,
            corners=corner_gap,
            fold=surface.fold_degrees(patch, ball.radius),
            around=self._around(middle, seed),
            sheet=self._sheet(middle, seed),
            degrees_a_quad=degrees_a_quad,
        )

    def place_of(self, corners: FloatArray) -> tuple[int, FloatArray]:
        """The input's triangle at the quad's middle, and the point there: on the side that the quad is turned to."""
        middle = corners.mean(axis=0)
        radius = float(np.linalg.norm(corners - middle, axis=1).max())
        faces, distance = self._surface.faces_in(Ball(middle, radius))
        normal = np.cross(corners[2] - corners[0], corners[3] - corners[1])
        agrees = self._surface.normals[faces] @ normal > 0
        if agrees.any():
            faces, distance = faces[agrees], distance[agrees]
        if not len(faces):
            raise ValueError("the quad is not on the surface")
        seed = int(faces[distance.argmin()])
        return seed, nearest_in_triangles(middle[None], self._surface.corners[[seed]])[0]

    def _at_corners(self, quad: int) -> tuple[float, float]:
        """Degrees of the sharpest sector at the quad's worst corners, and the most for one quad at any of its vertices on lines."""
        sines = corner_sines(self._vertices[self._quads[quad]])
        tip, most = math.inf, 0.0
        for vertex, is_worst in zip(self._quads[quad], sines <= sines.min() + SAME, strict=True):
            here = self._vertices[vertex]
            for corner in np.flatnonzero(np.linalg.norm(self._surface.points - here, axis=1) <= ON_LINE * self._length):
                ends = (self._surface.edges == corner).any(axis=1)
                if not self._lines.is_line[ends].any():
                    continue
                sectors = self._surface.sectors_degrees(int(corner), self._lines.is_line)
                own = self._sector_of(quad, here, sectors)
                around = np.flatnonzero((self._quads == vertex).any(axis=1))
                sharing = sum(self._sector_of(int(q), here, sectors) == own for q in around)
                most = max(most, sectors[own][0] / sharing)
                if is_worst:
                    tip = min(tip, sectors[own][0])
        return tip, most

    def _sector_of(self, quad: int, here: FloatArray, sectors: list[tuple[float, IntArray]]) -> int:
        """Which sector a quad lies in: a little way from the corner to where it goes."""
        away = self._vertices[self._quads[quad]].mean(axis=0) - here
        step = min(0.05 * self._length, float(np.linalg.norm(away)))
        point = here + step * away / max(float(np.linalg.norm(away)), np.finfo(float).tiny)
        distances = [
            np.linalg.norm(
                nearest_in_triangles(np.broadcast_to(point, (len(faces), 3)), self._surface.corners[faces]) - point,
                axis=1,
            ).min()
            for _, faces in sectors
        ]
        return int(np.argmin(distances))

    def _gaps(self, corners: FloatArray, middle: FloatArray, seed: int) -> tuple[float, float]:
        """Between lines, and between corners of lines."""
        reach = float(np.linalg.norm(corners - middle, axis=1).max()) + NEAR_LINES * self._length
        patch = self._surface.patch(Ball(middle, reach), seed)
        chosen = self._lines.near(middle, reach)
        chosen = chosen[self._is_beside(corners, self._lines.points[chosen])]
        beside = self._surface.edge_faces[self._lines.edge[chosen]]
        chosen = chosen[np.isin(beside, patch).any(axis=1)]
        nodes = np.intersect1d(self._lines.corners, self._surface.triangles[patch])
        places = self._surface.points[nodes]
        places = places[self._is_beside(corners, places)]
        apart = np.linalg.norm(places[:, None] - places[None], axis=2)[np.triu_indices(len(places), 1)]
        return self._lines.gap(middle, chosen), float(apart.min(initial=math.inf) / self._length)

    def _is_beside(self, corners: FloatArray, points: FloatArray) -> np.ndarray:
        """(k,) Points within half an edge of a quad."""
        is_near = np.zeros(len(points), bool)
        for half in (corners[[0, 1, 2]], corners[[0, 2, 3]]):
            place = nearest_in_triangles(points, np.broadcast_to(half, (len(points), 3, 3)))
            is_near |= np.linalg.norm(place - points, axis=1) <= NEAR_LINES * self._length
        return is_near

    def _around(self, middle: FloatArray, seed: int) -> float:
        """A ball around a point of a tube holds all of its section from a radius of the tube's width on."""
        for edges in (1.0, 2.0, 3.0, AROUND - 0.01):
            if self._surface.euler_number(Ball(middle, edges / math.pi * self._length), seed) != 1:
                return edges
        return math.inf

    def _sheet(self, middle: FloatArray, seed: int) -> float:
        around = self._surface.patch(Ball(middle, self._length), seed)
        faces, distance = self._surface.faces_in(Ball(middle, THIN * self._length))
        opposite = self._surface.normals[faces] @ self._surface.normals[seed] < OPPOSITE
        return float(distance[opposite & np.isin(faces, around)].min(initial=math.inf) / self._length)


def corner_sines(corners: FloatArray) -> FloatArray:
    """(4,) Sine of the angle at each corner of a quad, signed by its normal; the least is the scaled Jacobian."""
    forth, back = np.roll(corners, -1, axis=0) - corners, np.roll(corners, 1, axis=0) - corners
    normal = np.cross(corners[2] - corners[0], corners[3] - corners[1])
    size = np.linalg.norm(forth, axis=1) * np.linalg.norm(back, axis=1) * np.linalg.norm(normal)
    sines: FloatArray = (np.cross(forth, back) @ normal) / np.maximum(size, np.finfo(float).tiny)
    return sines
