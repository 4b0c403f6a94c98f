"""Guides from strokes: lines drawn on or near a surface give the direction of the quads around them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .edge_borders import polygon_normals
from .errors import InputError
from .mesh_arrays import FacesLike, FloatArray, Polygons, as_polygons, as_vertices, require_indices, unit_vectors
from .options import STROKE_KINDS
from .surface_points import fan_triangles, nearest_on_surface, pairs_within

RADIUS_IN_EDGES = 2.0  # how far directions act where nobody says

_SAMPLES_PER_RADIUS = 4
# Of the radius: the deviation of the bell over which the directions of a stroke are averaged, by default 0.3 edge lengths.
# What it does within less is not for the quads to follow.
_BLUR = 0.14
_MOST_SAMPLES = 4000
_FARTHEST = 1e15  # of the surface's size: from farther away all places of it are as near
# Cosine between normals below which a place is on another side of the surface than the stroke: a thin sheet's back.
_SAME_SIDE = 0.3


class Stroke(NamedTuple):
    """A line that quads should follow, or cross.

    Attributes
    ----------
    points : (k, 3) float64
        Its corners in order; a closed one repeats the first.
    strength : float
        0..1, of a direction.
    kind : {"direction", "loop", "ring"}
        ``"direction"``: quads near it are turned along it, as :func:`guides_from_strokes` says. ``"loop"``: it becomes a
        connected chain of edges. ``"ring"``: it crosses edges at right angles through their middles. A loop or ring ends
        where it is drawn to end; its ends are joined where they are within half an edge length of each other.
    """

    points: FloatArray
    strength: float = 1.0
    kind: str = "direction"


def guides_from_strokes(
    vertices: npt.ArrayLike,
    faces: FacesLike,
    strokes: Iterable[Stroke | npt.ArrayLike],
    radius: float,
) -> FloatArray:
    """Directions for the vertices near some strokes, as :func:`~hybrid_quad.remesh` takes them as `guides`.

    Every stroke is put onto the nearest surface. It acts on vertices within `radius` that lie on the same side of the
    surface, with all its strength within half of that and the less the farther away beyond, and on the corners of the
    triangles it passes however far. Where strokes meet, they act as crosses: one direction and its normal say the same.

    Parameters
    ----------
    vertices : (n, 3) float
    faces : (m, k) int, or a sequence of sequences of int
    strokes : iterable of Stroke or (k, 3) float
        Plain points count as a stroke of strength 1. Of every kind only the direction is used.
    radius : float
        In the units of `vertices`.

    Returns
    -------
    (n, 3) float64
        Tangents of the surface as long as the guide is strong; zero where none is.

    Raises
    ------
    InputError
        If a face has a vertex that is not there or not finite (``index_out_of_range``, ``non_finite_vertex``), or a
        stroke is more than 1e15 times as far from the surface as this is large (``stroke_too_far``).
    ValueError, TypeError
        If `radius` or a stroke makes no sense, or an array has the wrong shape or type.
    """
    if not (math.isfinite(radius) and radius > 0):
        raise ValueError(f"radius must be > 0, not {radius!r}")
    polygons = as_polygons(faces)
    points = _with_faces(as_vertices(vertices), polygons)
    triangles = fan_triangles(polygons)
    lines = [_as_stroke(stroke) for stroke in strokes]
    _require_near(lines, points)
    segments = np.concatenate([np.stack([s.points[:-1], s.points[1:]], axis=1) for s in lines] or [np.zeros((0, 2, 3))])
    strengths = np.concatenate([np.full(max(0, len(s.points) - 1), s.strength) for s in lines] or [np.zeros(0)])
    normals = vertex_normals(points, polygons)
    result = np.zeros((len(points), 3))
    segments, strengths = _without_points(segments, strengths)
    if not len(segments) or not len(triangles):
        return result
    places, tangents, owner = _samples(segments, radius / _SAMPLES_PER_RADIUS)
    on_surface = nearest_on_surface(places, points, triangles)
    corner = points[triangles[on_surface.triangles]]
    normal = unit_vectors(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]))
    tangents = unit_vectors(tangents - (tangents * normal).sum(axis=1)[:, None] * normal)
    crosses = _Crosses(points, normals)
    for sample, vertex, distance in pairs_within(on_surface.positions, points, radius):
        part = distance / radius
        share = np.exp(-0.5 * (part / _BLUR) ** 2)
        crosses.add(vertex, sample, (1 - part**4) ** 2, share, strengths[owner], tangents, normal)
    # The triangles passed, so that a stroke also acts on a mesh coarser than its radius.
    passed = np.repeat(np.arange(len(places)), 3)
    vertex = triangles[on_surface.triangles].ravel().astype(np.int64)
    away = np.linalg.norm(points[vertex] - on_surface.positions[passed], axis=1)
    longest = np.linalg.norm(corner - np.roll(corner, 1, axis=1), axis=2).max(axis=1)[passed]
    falloff = np.where(away < radius, 0, 0.5 * np.maximum(1 - away / np.maximum(longest, 1e-300), 0.1))
    crosses.add(vertex, passed, falloff, np.ones(len(passed)), strengths[owner], tangents, normal)
    return crosses.directions()


def kind_of_name(name: str, usual: str) -> str:
    """The kind that the name of an object or line begins with, as in ``"loop_eye"``; `usual` where it names none."""
    first, underscore, _ = name.lower().partition("_")
    return first if underscore and first in STROKE_KINDS else usual


def checked_strokes(strokes: Iterable[Stroke | npt.ArrayLike] | None) -> list[Stroke]:
    """Strokes with their points as arrays.

    Raises
    ------
    ValueError
        If a stroke is no list of finite points, or has another kind or strength than there are.
    """
    return [] if strokes is None else [_as_stroke(stroke) for stroke in strokes]


def native_strokes(strokes: list[Stroke], origin: FloatArray | None = None) -> dict[str, Any]:
    """Loops and rings as keyword arguments of the compiled module's ``remesh``.

    Parameters
    ----------
    origin : (3,) float64, optional
        Subtracted from the points.
    """
    hard = [stroke for stroke in strokes if stroke.kind != "direction"]
    points = np.concatenate([stroke.points for stroke in hard] or [np.zeros((0, 3))])
    return {
        "stroke_points": points if origin is None else points - origin,
        "stroke_sizes": np.array([len(stroke.points) for stroke in hard], np.int32),
        "stroke_rings": np.array([stroke.kind == "ring" for stroke in hard], np.int32),
    }


def joined_lines(lines: list[FloatArray]) -> list[FloatArray]:
    """Lines put together where exactly two of them end at the same point, as the edges of a mesh do."""
    ends: dict[bytes, list[int]] = {}
    for index, line in enumerate(lines):
        for end in (line[0], line[-1]):
            ends.setdefault(end.tobytes(), []).append(index)
    used = [False] * len(lines)
    result = []
    # Lines with a free end first, so that only closed chains begin anywhere.
    free = [any(len(ends[end.tobytes()]) != 2 for end in (line[0], line[-1])) for line in lines]
    for start in sorted(range(len(lines)), key=lambda index: not free[index]):
        if used[start]:
            continue
        used[start] = True
        line = lines[start]
        chain = [line[::-1] if len(ends[line[0].tobytes()]) == 2 and len(ends[line[-1].tobytes()]) != 2 else line]
        while len(at_end := ends[chain[-1][-1].tobytes()]) == 2:
            following = at_end[0] if used[at_end[1]] else at_end[1]
            if used[following]:
                break
            used[following] = True
            line = lines[following]
            chain.append(line if (line[0] == chain[-1][-1]).all() else line[::-1])
        result.append(np.concatenate([chain[0], *(part[1:] for part in chain[1:])]))
    return result


def strokes_of_segments(segments: FloatArray, strength: float) -> list[Stroke]:
    """(s, 2, 3) segments as strokes of two points each."""
    return [Stroke(segment, strength) for segment in segments]


def vertex_normals(vertices: FloatArray, polygons: Polygons) -> FloatArray:
    """(n, 3) Unit means of the normals of each vertex's polygons; zero where there are none."""
    of_corner = np.repeat(polygon_normals(vertices, polygons), polygons.sizes, axis=0)
    sums: FloatArray = np.stack(
        [np.bincount(polygons.vertices, of_corner[:, i], len(vertices)) for i in range(3)], axis=1
    )
    return unit_vectors(sums)


def stronger_of(first: FloatArray | None, second: FloatArray | None) -> FloatArray | None:
    """Of two lists of guides, row by row the longer."""
    if first is None or second is None:
        return second if first is None else first
    lengths = (first**2).sum(axis=1), (second**2).sum(axis=1)
    return np.where((lengths[0] >= lengths[1])[:, None], first, second)


class _Crosses:
    """Weighted means of crosses at the vertices: angles are counted four times, so that quarter turns are alike."""

    def __init__(self, vertices: FloatArray, normals: FloatArray) -> None:
        self._normals = normals
        axis = np.eye(3)[np.abs(normals).argmin(axis=1)]
        self._x = unit_vectors(np.cross(normals, axis))
        self._y = np.cross(normals, self._x)
        self._sum = np.zeros(len(vertices), np.complex128)
        self._strength = np.zeros(len(vertices))

    def add(
        self,
        vertex: npt.NDArray[np.int64],
        sample: npt.NDArray[np.int64],
        falloff: FloatArray,
        share: FloatArray,
        strengths: FloatArray,
        tangents: FloatArray,
        normals: FloatArray,
    ) -> None:
        """Sample `sample[i]`, one of those with `strengths`, `tangents` and `normals`, acts on `vertex[i]`.

        `falloff` of its strength is left there; beside other samples its direction counts as much as its `share`, too.
        """
        weight = falloff * strengths[sample]
        near = (self._normals[vertex] * normals[sample]).sum(axis=1) > _SAME_SIDE
        near &= weight > 0
        vertex, sample, weight, share = vertex[near], sample[near], weight[near], share[near]
        direction = tangents[sample]
        angle = np.arctan2((direction * self._y[vertex]).sum(axis=1), (direction * self._x[vertex]).sum(axis=1))
        # Squared, so that of two strokes the nearer decides.
        np.add.at(self._sum, vertex, weight**2 * share * np.exp(4j * angle))
        np.maximum.at(self._strength, vertex, weight)

    def directions(self) -> FloatArray:
        angle = np.angle(self._sum)[:, None] / 4
        strength = np.clip(self._strength, 0, 1)[:, None]
        directions: FloatArray = strength * (np.cos(angle) * self._x + np.sin(angle) * self._y)
        return directions


def _as_stroke(stroke: Stroke | npt.ArrayLike) -> Stroke:
    points, strength, kind = stroke if isinstance(stroke, Stroke) else (stroke, 1.0, "direction")
    try:
        points = as_vertices(points)
    except ValueError as error:
        raise ValueError(f"strokes must be lines of points, (k, 3) each: {error}") from None
    if kind not in STROKE_KINDS:
        raise ValueError(f"a stroke's kind must be one of {', '.join(STROKE_KINDS)}, not {kind!r}")
    if not np.isfinite(points).all():
        raise ValueError("a stroke has points that are not finite")
    if not 0 <= strength <= 1:
        raise ValueError(f"a stroke's strength must be between 0 and 1, not {strength!r}")
    return Stroke(points, float(strength), kind)


def _with_faces(points: FloatArray, polygons: Polygons) -> FloatArray:
    """Vertices; those without a face, on which no stroke acts, in the place of one that has some: they may be anywhere.

    Raises
    ------
    InputError
        If a face has a vertex that is not there, or whose coordinates are not finite.
    """
    require_indices(polygons, len(points))
    used = np.unique(polygons.vertices)
    bad = used[~np.isfinite(points[used]).all(axis=1)]
    if len(bad):
        raise InputError(
            "non_finite_vertex", "Vertices have coordinates that are no finite numbers.", "vertex", bad.tolist()
        )
    if not len(used):
        return np.zeros_like(points)
    placed: FloatArray = np.broadcast_to(points[used[0]], points.shape).copy()
    placed[used] = points[used]
    return placed


def _require_near(strokes: list[Stroke], vertices: FloatArray) -> None:
    """Raises InputError where a stroke is so far off that no digits are left to tell which vertex is nearest."""
    if not len(vertices):
        return
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    size = float((high - low).max())
    for stroke in strokes:
        away = float(np.maximum(low - stroke.points, stroke.points - high).max(initial=0.0))
        if away / _FARTHEST > size:
            raise InputError(
                "stroke_too_far",
                f"A stroke is more than {_FARTHEST:g} times as far from the surface as this is large.",
            )


def _without_points(segments: FloatArray, strengths: FloatArray) -> tuple[FloatArray, FloatArray]:
    has_length = (segments[:, 0] != segments[:, 1]).any(axis=1) & (strengths > 0)
    return segments[has_length], strengths[has_length]


def _samples(segments: FloatArray, spacing: float) -> tuple[FloatArray, FloatArray, npt.NDArray[np.int64]]:
    """Places along segments, at most `spacing` apart unless that were too many; their directions and segments."""
    along = segments[:, 1] - segments[:, 0]
    length = np.linalg.norm(along, axis=1)
    spacing = max(spacing, float(length.sum()) / _MOST_SAMPLES)
    count = np.maximum(1, np.ceil(length / spacing)).astype(np.int64)
    owner = np.repeat(np.arange(len(segments)), count)
    within = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
    share = ((within + 0.5) / count[owner])[:, None]
    return segments[owner, 0] + share * along[owner], unit_vectors(along)[owner], owner
