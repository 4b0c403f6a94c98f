"""The lines of an input that a result keeps: its boundary and, with sharp edges, its features, where the quads' edges follow them."""

from __future__ import annotations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import cKDTree

from hybrid_quad.core.graph_components import component_labels
from hybrid_quad.core.mesh_arrays import FloatArray, IntArray
from input_patch import InputSurface

WEAK_DEGREES = 20.0  # a chain of weaker edges goes on where it joins strong ones, as in the method
FOLLOWED = 0.15  # edge lengths: as far as an edge cuts short the bends of a line that it follows
ON_LINE = 1e-3  # edge lengths: vertices that follow a line lie on it
CORNER_DEGREES = 80.0  # a line that turns by more has a corner, as in the method
SPACING = 0.1  # edge lengths between the points that stand for a line
LOOK_AROUND = 2.5  # edge lengths: farther along a line, two parts of it are two lines
BESIDE = 4.0  # times as far along a line as straight: two parts of it lie beside each other, not around a corner


def line_edges(surface: InputSurface, sharp_degrees: float | None) -> np.ndarray:
    """(e,) bool: edges of the boundary and those that bend by more than an angle, with weaker ones that join them."""
    if sharp_degrees is None:
        return surface.is_boundary.copy()
    bend = surface.bend_degrees()
    weak = np.flatnonzero(bend > WEAK_DEGREES)
    ends = surface.edges[weak]
    label = component_labels(len(surface.points), ends[:, 0], ends[:, 1])
    strong = np.unique(label[ends[bend[weak] > sharp_degrees][:, 0]])
    chosen = np.zeros(len(surface.edges), bool)
    chosen[weak[np.isin(label[ends[:, 0]], strong)]] = True
    return chosen


class KeptLines:
    """Points along the lines that the quads' edges follow, and which of them are neighbours along a line.

    Parameters
    ----------
    surface : InputSurface
    candidates : (e,) bool
        The input's edges on lines.
    vertices : (n, 3) float
        Of the result.
    quads : (m, 4) int
    length : float
        Of the asked edges.

    Attributes
    ----------
    points : (k, 3) float
    edge : (k,) int
        The edge of the input that each is on.
    is_line : (e,) bool
        Edges of the input that are followed all along.
    corners : (c,) int
        Vertices of the input where such edges end, fork, or turn.
    """

    def __init__(
        self, surface: InputSurface, candidates: np.ndarray, vertices: FloatArray, quads: IntArray, length: float
    ) -> None:
        self._length = length
        chosen = np.flatnonzero(candidates)
        ends = surface.edges[chosen]
        begin, end = surface.points[ends[:, 0]], surface.points[ends[:, 1]]
        points, owner, links = _sampled(begin, end, SPACING * length)
        followed = self._are_followed(points, owner, begin, end, vertices, quads)
        # The first and last point of an edge are the input's vertices, which the next edge of the line has too.
        node = np.arange(len(points))
        first = np.flatnonzero(np.diff(owner, prepend=-1))
        last = np.append(first[1:], len(points)) - 1
        at_ends = np.concatenate([first, last]) if len(chosen) else np.zeros(0, int)
        _, lowest, inverse = np.unique(ends.T.reshape(-1), return_index=True, return_inverse=True)
        node[at_ends] = at_ends[lowest][inverse.reshape(-1)] if len(chosen) else at_ends
        links = node[links[followed[links].all(axis=1)]]
        self.is_line = np.zeros(len(surface.edges), bool)
        self.is_line[chosen] = np.bincount(owner, ~followed, minlength=len(chosen)) == 0
        self.corners = _corners(surface.points, surface.edges[self.is_line])
        used = np.unique(links)
        self.points, self.edge = points[used], chosen[owner[used]] if len(chosen) else used
        self._links = np.searchsorted(used, links)
        self._tree = cKDTree(self.points) if len(used) else None

    def _are_followed(
        self,
        points: FloatArray,
        owner: IntArray,
        begin: FloatArray,
        end: FloatArray,
        vertices: FloatArray,
        quads: IntArray,
    ) -> np.ndarray:
        """(k,) Whether an edge of the quads that has both ends on lines runs along each point."""
        if not len(points):
            return np.zeros(0, bool)
        _, nearest = cKDTree(points).query(vertices, k=min(4, len(points)))
        on_line = np.zeros(len(vertices), bool)
        for segment in owner[nearest].reshape(len(vertices), -1).T:
            way = end[segment] - begin[segment]
            share = ((vertices - begin[segment]) * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), 1e-300)
            place = begin[segment] + np.clip(share, 0, 1)[:, None] * way
            on_line |= np.linalg.norm(place - vertices, axis=1) <= ON_LINE * self._length
        sides = np.unique(np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2), axis=1), axis=0)
        sides = sides[on_line[sides].all(axis=1)]
        if not len(sides):
            return np.zeros(len(points), bool)
        spacing = 0.5 * FOLLOWED * self._length
        along, _, _ = _sampled(vertices[sides[:, 0]], vertices[sides[:, 1]], spacing)
        is_near: np.ndarray = cKDTree(along).query(points)[0] <= FOLLOWED * self._length
        return is_near

    def near(self, centre: FloatArray, radius: float) -> IntArray:
        """Which points are in a ball."""
        found = [] if self._tree is None else sorted(self._tree.query_ball_point(centre, radius))
        return np.array(found, np.int64)

    def gap(self, centre: FloatArray, chosen: IntArray) -> float:
        """Smallest distance, in edge lengths, of points among `chosen` on two lines, or on parts of one that lie beside each other.

        Infinite where there are none. Lines that join farther than LOOK_AROUND edges from `centre` count as two.
        """
        if len(chosen) < 2:
            return np.inf
        around = self.near(centre, LOOK_AROUND * self._length)
        around = np.union1d(around, chosen)
        place = np.full(len(self.points), -1)
        place[around] = np.arange(len(around))
        links = place[self._links]
        links = links[(links >= 0).all(axis=1)]
        steps = np.linalg.norm(self.points[around[links[:, 0]]] - self.points[around[links[:, 1]]], axis=1)
        graph = coo_matrix((np.maximum(steps, 1e-300), (links[:, 0], links[:, 1])), shape=(len(around), len(around)))
        along = dijkstra(graph.tocsr(), directed=False, indices=place[chosen])[:, place[chosen]]
        straight = np.linalg.norm(self.points[chosen][:, None] - self.points[chosen][None], axis=2)
        beside = along >= np.maximum(BESIDE * straight, self._length)
        return float(straight[beside].min() / self._length) if beside.any() else np.inf


def _sampled(begin: FloatArray, end: FloatArray, spacing: float) -> tuple[FloatArray, IntArray, IntArray]:
    """Points along segments, both ends among them, the segment of each, and pairs of neighbours."""
    counts = np.maximum(1, np.ceil(np.linalg.norm(end - begin, axis=1) / spacing)).astype(np.int64)
    owner = np.repeat(np.arange(len(begin)), counts + 1)
    start = np.cumsum(counts + 1) - counts - 1
    within = np.arange(len(owner)) - start[owner]
    share = (within / counts[owner])[:, None]
    points = (1 - share) * begin[owner] + share * end[owner]
    ahead = np.flatnonzero(within < counts[owner])
    return points, owner, np.stack([ahead, ahead + 1], axis=1)


def _corners(points: FloatArray, edges: IntArray) -> IntArray:
    if not len(edges):
        return np.zeros(0, np.int64)
    here, there = edges.ravel(), edges[:, ::-1].ravel()
    order = np.argsort(here, kind="stable")
    vertices, first, uses = np.unique(here[order], return_index=True, return_counts=True)
    away = points[there[order]] - points[here[order]]
    away /= np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-300)
    second = np.minimum(first + 1, len(away) - 1)
    straight = -(away[first] * away[second]).sum(axis=1)
    corners: IntArray = vertices[(uses != 2) | (straight < np.cos(np.radians(CORNER_DEGREES)))]
    return corners
