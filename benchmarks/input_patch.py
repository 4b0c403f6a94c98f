"""Parts of a triangle surface inside a ball: which faces hang together there, how they bend, and whether they form a disk."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from hybrid_quad.core.graph_components import component_labels
from hybrid_quad.core.mesh_arrays import FloatArray, IntArray
from hybrid_quad.core.surface_points import nearest_in_triangles

OUTLIERS = 0.02  # of a patch's area: slivers whose normals mean nothing


@dataclass(frozen=True)
class Ball:
    """Where one looks.

    Attributes
    ----------
    centre : (3,) float
    radius : float
    """

    centre: FloatArray
    radius: float


class InputSurface:
    """A triangle surface with its edges and neighbours.

    Parameters
    ----------
    points : (n, 3) float
    triangles : (t, 3) int
        An edge with more than two faces joins none of them.

    Attributes
    ----------
    normals : (t, 3) float
        Unit; zero for a triangle without area.
    area : (t,) float
    edges : (e, 2) int
        Vertices, ascending.
    edge_faces : (e, 2) int
        -1 where there is none.
    face_edges : (t, 3) int
    """

    def __init__(self, points: FloatArray, triangles: IntArray) -> None:
        self.points, self.triangles = points, np.asarray(triangles, np.int64)
        corners = points[self.triangles]
        self.corners = corners
        cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        length = np.linalg.norm(cross, axis=1)
        self.area = 0.5 * length
        self.normals = cross / np.maximum(length, np.finfo(float).tiny)[:, None]
        middles = corners.mean(axis=1)
        reach = np.linalg.norm(corners - middles[:, None], axis=2).max(axis=1)
        # Few large triangles do not make every search a wide one.
        self._small_reach = 4 * float(np.median(reach))
        self._small, self._large = np.flatnonzero(reach <= self._small_reach), np.flatnonzero(reach > self._small_reach)
        self._tree = cKDTree(middles[self._small])
        sides = np.sort(np.stack([self.triangles, np.roll(self.triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
        self.edges, edge_of_side, uses = np.unique(sides, axis=0, return_inverse=True, return_counts=True)
        self.face_edges = edge_of_side.reshape(-1, 3)
        order = np.argsort(edge_of_side.reshape(-1), kind="stable")
        first = np.cumsum(uses) - uses
        second = order[np.minimum(first + 1, len(order) - 1)] // 3
        self.edge_faces = np.stack([order[first] // 3, np.where(uses > 1, second, -1)], axis=1)
        self.is_boundary = uses == 1
        self.joins = uses == 2
        self._at_rim = np.zeros(len(points), bool)
        self._at_rim[self.edges[~self.joins].ravel()] = True

    def bend_degrees(self) -> FloatArray:
        """(e,) Angle between the normals of each edge's two faces; 180 on the boundary."""
        bend = np.full(len(self.edges), 180.0)
        pairs = self.edge_faces[self.joins]
        cosine = (self.normals[pairs[:, 0]] * self.normals[pairs[:, 1]]).sum(axis=1)
        bend[self.joins] = np.degrees(np.arccos(np.clip(cosine, -1, 1)))
        return bend

    def faces_in(self, ball: Ball) -> tuple[IntArray, FloatArray]:
        """Triangles that meet a ball, ascending, and how far each is from its centre."""
        close = self._tree.query_ball_point(ball.centre, ball.radius + self._small_reach)
        near = np.sort(np.concatenate([self._small[close], self._large]))
        place = nearest_in_triangles(np.broadcast_to(ball.centre, (len(near), 3)), self.corners[near])
        distance = np.linalg.norm(place - ball.centre, axis=1)
        inside = distance <= ball.radius
        return near[inside], distance[inside]

    def patch(self, ball: Ball, seed: int, barrier: np.ndarray | None = None) -> IntArray:
        """The triangles that are connected to triangle `seed` inside a ball, across edges that meet it too.

        Parameters
        ----------
        barrier : (e,) bool, optional
            Edges that end the patch.
        """
        faces, _ = self.faces_in(ball)
        if not (faces == seed).any():
            return np.array([seed])
        passed = self._edges_between(faces, ball)
        if barrier is not None:
            passed = passed[~barrier[passed]]
        pairs = np.searchsorted(faces, self.edge_faces[passed])
        label = component_labels(len(faces), pairs[:, 0], pairs[:, 1])
        connected: IntArray = faces[label == label[np.searchsorted(faces, seed)]]
        return connected

    def euler_number(self, ball: Ball, seed: int) -> int:
        """Of the connected part of the surface in a ball, cut off at its border: 1 for a disk, 0 for a ring, 2 for all of a sphere.

        Triangles cut by a ball are convex, so that it is faces - inner edges + inner vertices, of those that meet the ball.
        """
        faces = self.patch(ball, seed)
        inner = self._edges_between(faces, ball)
        vertices = np.unique(self.triangles[faces])
        within = np.linalg.norm(self.points[vertices] - ball.centre, axis=1) <= ball.radius
        return len(faces) - len(inner) + int((within & ~self._at_rim[vertices]).sum())

    def _edges_between(self, faces: IntArray, ball: Ball) -> IntArray:
        edges, uses = np.unique(self.face_edges[faces], return_counts=True)
        edges = edges[(uses == 2) & self.joins[edges]]
        begin, end = self.points[self.edges[edges, 0]], self.points[self.edges[edges, 1]]
        way = end - begin
        share = ((ball.centre - begin) * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), np.finfo(float).tiny)
        place = begin + np.clip(share, 0, 1)[:, None] * way
        meeting: IntArray = edges[np.linalg.norm(place - ball.centre, axis=1) <= ball.radius]
        return meeting

    def fold_degrees(self, faces: IntArray, radius: float) -> float:
        """The largest angle between normals of some faces, but for slivers with a small share of the area.

        Parameters
        ----------
        radius : float
            Of the ball that they meet: none counts with more area than that has.
        """
        weight = np.minimum(self.area[faces], radius**2)
        normals = self.normals[faces]
        mean = (weight[:, None] * normals).sum(axis=0)
        order = np.argsort(-(normals @ mean), kind="stable")
        kept = order[np.cumsum(weight[order]) <= (1 - OUTLIERS) * weight.sum() + 1e-12 * weight.sum()]
        chosen = normals[kept if len(kept) else order[:1]]
        return float(np.degrees(np.arccos(np.clip((chosen @ chosen.T).min(), -1, 1))))

    def sectors_degrees(self, vertex: int, is_line: np.ndarray) -> list[tuple[float, IntArray]]:
        """The parts of a vertex's fan of triangles between lines that end or pass there: angle and triangles of each.

        Parameters
        ----------
        is_line : (e,) bool
        """
        fan = np.flatnonzero((self.triangles == vertex).any(axis=1))
        edges, uses = np.unique(self.face_edges[fan], return_counts=True)
        inner = edges[(uses == 2) & self.joins[edges] & ~is_line[edges]]
        pairs = np.searchsorted(fan, self.edge_faces[inner])
        label = component_labels(len(fan), pairs[:, 0], pairs[:, 1])
        at = (self.triangles[fan] == vertex).argmax(axis=1)
        rows = np.arange(len(fan))
        forth = self.corners[fan][rows, (at + 1) % 3] - self.points[vertex]
        back = self.corners[fan][rows, (at + 2) % 3] - self.points[vertex]
        angle = np.degrees(np.arctan2(np.linalg.norm(np.cross(forth, back), axis=1), (forth * back).sum(axis=1)))
        return [(float(angle[label == own].sum()), fan[label == own]) for own in np.unique(label)]
