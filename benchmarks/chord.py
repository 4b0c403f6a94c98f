"""How far chords of a certain length are from a surface's feature curves."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable

import numpy as np

from hybrid_quad.core.mesh_arrays import Polygons

CORNER_DEGREES = 80.0  # a curve that turns by more has a corner, which chains of edges keep


def feature_curves(vertices: np.ndarray, faces: Polygons, angle: float) -> list[np.ndarray]:
    """(k, 3) points along each feature curve; a closed one repeats its first.

    Parameters
    ----------
    vertices : (n, 3) float
    angle : float
        Edges that bend by more degrees, and the boundary, are features.
    """
    return [vertices[path] for path in _paths(vertices, feature_edges(vertices, faces, angle))]


def chord_error(curves: Iterable[np.ndarray], length: float) -> float:
    """Largest distance from curves to polylines through points of theirs that are `length` apart.

    Parameters
    ----------
    curves : iterable of (k, 3) float
    length : float
        Of the chords: each curve gets the nearest whole number of equal ones.

    Returns
    -------
    float
        In the units of the curves; 0 without any.
    """
    return max((_sagitta(curve, length) for curve in curves), default=0.0)


def feature_edges(vertices: np.ndarray, faces: Polygons, angle: float) -> list[tuple[int, int]]:
    """Edges with one face, or whose two faces' normals differ by more than `angle` degrees."""
    corners = np.split(faces.vertices, np.cumsum(faces.sizes)[:-1])
    normals, faces_of = [], defaultdict(list)
    for face, corner in enumerate(corners):
        points = vertices[corner]
        normal = np.cross(points - points[0], np.roll(points, -1, axis=0) - points[0]).sum(axis=0)
        normals.append(normal / max(float(np.linalg.norm(normal)), 1e-300))
        for a, b in zip(corner.tolist(), np.roll(corner, -1).tolist(), strict=True):
            faces_of[min(a, b), max(a, b)].append(face)
    least = np.cos(np.radians(angle))
    return [
        edge
        for edge, sides in faces_of.items()
        if len(sides) == 1 or float(normals[sides[0]] @ normals[sides[1]]) < least
    ]


def _paths(vertices: np.ndarray, edges: list[tuple[int, int]]) -> list[list[int]]:
    """Paths of edges between forks, ends and corners; a closed one repeats its first vertex."""
    neighbours = defaultdict(list)
    for a, b in edges:
        neighbours[a].append(b)
        neighbours[b].append(a)
    nodes = {v for v, around in neighbours.items() if len(around) != 2 or _turns(vertices, around[0], v, around[1])}
    left = {frozenset(edge) for edge in edges}
    curves = []
    for start in [*sorted(nodes), *sorted(neighbours)]:
        for second in neighbours[start]:
            if frozenset((start, second)) not in left:
                continue
            path = [start, second]
            left.discard(frozenset(path))
            while path[-1] not in nodes and path[-1] != start:
                onward = [v for v in neighbours[path[-1]] if frozenset((path[-1], v)) in left]
                if not onward:
                    break
                left.discard(frozenset((path[-1], onward[0])))
                path.append(onward[0])
            curves.append(path)
    return curves


def _turns(vertices: np.ndarray, before: int, at: int, after: int) -> bool:
    forth, on = vertices[at] - vertices[before], vertices[after] - vertices[at]
    size = float(np.linalg.norm(forth) * np.linalg.norm(on))
    return size == 0 or float(forth @ on) / size < np.cos(np.radians(CORNER_DEGREES))


def _sagitta(points: np.ndarray, length: float) -> float:
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    places = np.concatenate([[0.0], np.cumsum(steps)])
    if places[-1] <= 0:
        return 0.0
    is_closed = bool((points[0] == points[-1]).all())
    count = max(4 if is_closed else 1, round(places[-1] / length))
    ends = np.linspace(0, places[-1], count + 1)
    nodes = np.stack([np.interp(ends, places, points[:, axis]) for axis in range(3)], axis=1)
    # A vertex of the curve belongs to the chord whose part of the curve it is on.
    chord = np.clip(np.searchsorted(ends, places, side="right") - 1, 0, count - 1)
    begin, way = nodes[chord], np.diff(nodes, axis=0)[chord]
    share = ((points - begin) * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), 1e-300)
    return float(np.linalg.norm(points - begin - np.clip(share, 0, 1)[:, None] * way, axis=1).max())
