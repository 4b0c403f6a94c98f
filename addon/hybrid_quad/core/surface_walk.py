"""Walks over a triangle mesh that stop at walls, where what its corners carry is cut.

A face whose corners all lie on one side of the walls belongs there. The place nearest to its middle would not tell for a narrow
face along a bent wall: the middle is beside the surface, and can be across the wall from all the corners. It tells for faces that
lie across a wall. What corners beyond the wall get is looked for among the triangles that can be reached on the face's side
without crossing a wall, so that it comes from there even where one island of a UV map, say, has both sides of the seam.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .graph_components import component_labels
from .mesh_arrays import FloatArray
from .surface_places import Indices, Places, TriangleMesh, plane_weights, weights_in
from .surface_points import nearest_in_triangles, parts

BoolArray = npt.NDArray[np.bool_]

# What is looked at together: bounds the memory.
_FACES = 4000
_PAIRS = 500_000

# Triangles are reached when they come as near to a face's middle as its farthest corner, and a little more.
_REACH = 1.01

# Of a face's size: the distance up to which a corner lies on a side.
_NO_GAP = 1e-6

# Of a face's size: the slope of a value across a triangle less high than this is that of its rounding.
_THIN = 1e-4


class CornerPlaces(NamedTuple):
    """Places for the corners of some faces, all of a face on one side of the walls.

    Attributes
    ----------
    places : Places
        Of all corners, face by face.
    beyond : (k,) int64
        Corners that lie beyond a wall; their place is the nearest one on their face's side of it.
    kept : (k,) float64
        For these, how much of the value at their place counts where values go on beyond the walls; the farther out, the less.
    extended : Places
        The rest: what a corner differs by from its place, in the plane of the triangle at its face's middle. Shares may be negative.
    shared : (k,) int64
        Alike for those of one vertex that have the same place: where values go on beyond the walls, they get the mean.
    """

    places: Places
    beyond: Indices
    kept: FloatArray
    extended: Places
    shared: Indices

    def values(self, indices: Indices, values: FloatArray, *, is_extended: bool) -> FloatArray:
        """As :meth:`Places.values`; with `is_extended`, corners beyond a wall get what goes on linearly from the middle."""
        result = self.places.values(indices, values)
        if is_extended and len(self.beyond):
            extended = self.kept[:, None] * result[self.beyond] + self.extended.values(indices, values)
            total = np.zeros((self.shared.max() + 1, values.shape[1]))
            np.add.at(total, self.shared, extended)
            result[self.beyond] = (total / np.bincount(self.shared)[:, None])[self.shared]
        return result


class SurfaceWalk:
    """Which triangles of a mesh are neighbours.

    Triangles whose common edge has no other triangle are; so are triangles at the mesh's border that have edges with
    the same ends, as they are left where a mesh was split.
    """

    def __init__(self, mesh: TriangleMesh) -> None:
        self.mesh = mesh
        begin, end = mesh.vertices.ravel(), np.roll(mesh.vertices, -1, axis=1).ravel()
        self._opposite, uses = _opposite_sides(begin, end, np.arange(len(begin)))
        alone = np.flatnonzero(uses == 1)
        border = np.unique(np.concatenate([begin[alone], end[alone]]))
        _, spot_of_border = np.unique(mesh.points[border], axis=0, return_inverse=True)
        spot = np.zeros(len(mesh.points), np.int64)
        spot[border] = spot_of_border.reshape(-1)
        welded, _ = _opposite_sides(spot[begin[alone]], spot[end[alone]], alone)
        against = welded >= 0
        against[against] = spot[begin[alone[against]]] == spot[end[welded[against]]]
        self._opposite[alone[against]] = welded[against]
        self._is_crowded = uses > 2
        corners = mesh.points[mesh.vertices]
        self._low, self._high = corners.min(axis=1), corners.max(axis=1)

    def walls(self, values: FloatArray, tolerance: float) -> BoolArray:
        """(t, 3) sides, from each corner to the next, across which values of corners differ or more than two triangles meet.

        Parameters
        ----------
        values : (C, d) float
            For each of the polygons' corners.
        """
        corners, points = self.mesh.corners.ravel(), self.mesh.points
        vertices = self.mesh.vertices.ravel()
        side = np.flatnonzero(self._opposite >= 0)
        other = self._opposite[side]
        next_side, next_other = _next_side(side), _next_side(other)
        alike = (points[vertices[side]] == points[vertices[other]]).all(axis=1)
        at_begin = np.where(alike, other, next_other)
        at_end = np.where(alike, next_other, other)
        here, there = corners[side], corners[at_begin]
        next_here, next_there = corners[next_side], corners[at_end]
        differ = np.zeros(len(side), np.bool_)
        for column in values.T:  # several times as fast as all at once
            differ |= np.abs(column[here] - column[there]) > tolerance
            differ |= np.abs(column[next_here] - column[next_there]) > tolerance
        result: BoolArray = self._is_crowded.copy()
        result[side] |= differ
        return result.reshape(-1, 3)

    def wall_edges(self, walls: BoolArray) -> Indices:
        """(w, 2) vertices at the ends of the walls' sides."""
        side = np.flatnonzero(walls)
        vertices = self.mesh.vertices.ravel()
        return np.stack([vertices[side], vertices[_next_side(side)]], axis=1)

    def islands(self, walls: BoolArray) -> Indices:
        """(t,) alike for triangles that can be reached from each other without crossing a wall."""
        side = np.flatnonzero((self._opposite >= 0) & ~walls.ravel())
        return component_labels(len(self.mesh.vertices), side // 3, self._opposite[side] // 3)

    def corner_places(
        self, walls: BoolArray, middles: Places, points: FloatArray, vertices: Indices, unbounded: Places
    ) -> CornerPlaces:
        """Places for the corners of faces, all of a face on one side of the walls: where they all lie, or else where its middle is.

        Parameters
        ----------
        walls : (t, 3) bool
        middles : Places
            Of the f faces.
        points : (f, m, 3) float64
            Their corners; how far these are from the middle is how far is looked.
        vertices : (f, m) int64
            The vertex that each corner is.
        unbounded : Places
            Of the f * m corners, whatever the walls.
        """
        each = points.shape[1]
        places, beyond = self._bounded(walls, middles, points, unbounded)
        middles, moved = self._with_corners(walls, middles, points, unbounded, places, beyond)
        if moved:
            places, beyond = self._bounded(walls, middles, points, unbounded)
        face = beyond // each
        kept, extended = self._extended(
            points.reshape(-1, 3)[beyond],
            places.among(beyond),
            middles.among(face),
            self._reach(middles, points)[1][face],
        )
        keys = vertices.ravel()[beyond] * len(self.mesh.vertices) + places.triangles[beyond]
        return CornerPlaces(places, beyond, kept, extended, np.unique(keys, return_inverse=True)[1].reshape(-1))

    def _reach(self, middles: Places, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Centres (f, 3) and radii (f,) of what is looked at for faces with these corners (f, m, 3)."""
        centers = middles.values(self.mesh.vertices, self.mesh.points)
        radii = _REACH * np.linalg.norm(points - centers[:, None], axis=2).max(axis=1)
        return centers, radii

    def _bounded(
        self, walls: BoolArray, middles: Places, points: FloatArray, unbounded: Places
    ) -> tuple[Places, Indices]:
        """Places of corners on the sides of the walls where the faces' middles are; and the corners for which these are other ones."""
        count, each = points.shape[:2]
        places = Places(unbounded.triangles.copy(), unbounded.weights.copy())
        centers, radii = self._reach(middles, points)
        found = [np.zeros(0, np.int64)]
        for first in range(0, count, _FACES):
            part = slice(first, first + _FACES)
            owners, reached = self._reached(walls, middles.triangles[part], centers[part], radii[part])
            own = np.arange(first * each, min(first + _FACES, count) * each)
            wanted = (own // each - first) * len(self.mesh.vertices) + unbounded.triangles[own]
            own = own[~_is_in(wanted, owners * len(self.mesh.vertices) + reached)]
            inside = self._nearest_reached(points.reshape(-1, 3)[own], own // each - first, owners, reached)
            places.triangles[own], places.weights[own] = inside
            found.append(own)
        return places, np.concatenate(found)

    def _with_corners(
        self,
        walls: BoolArray,
        middles: Places,
        points: FloatArray,
        unbounded: Places,
        bounded: Places,
        beyond: Indices,
    ) -> tuple[Places, bool]:
        """The faces' middles, on the side of a corner `beyond` where all corners lie there and not on the middle's; and if any is."""
        count, each = points.shape[:2]
        triangles, weights = middles.triangles.copy(), middles.weights.copy()
        centers, radii = self._reach(middles, points)
        lies_aside = self._gaps(points.reshape(-1, 3), bounded).reshape(count, each) > _NO_GAP * radii[:, None]
        targets = np.concatenate([points, centers[:, None]], axis=1)
        moved = np.zeros(count, np.bool_)
        for corner in range(each):
            is_beyond = np.zeros(count, np.bool_)
            is_beyond[beyond[beyond % each == corner] // each] = True
            undecided = np.flatnonzero(is_beyond & lies_aside.any(axis=1) & ~moved)
            for first in range(0, len(undecided), _FACES):
                faces = undecided[first : first + _FACES]
                start = unbounded.triangles[faces * each + corner]
                owners, reached = self._reached(walls, start, centers[faces], radii[faces])
                own = np.repeat(np.arange(len(faces)), each + 1)
                found = self._nearest_reached(targets[faces].reshape(-1, 3), own, owners, reached)
                gaps = self._gaps(targets[faces].reshape(-1, 3), found).reshape(-1, each + 1)[:, :each]
                inside = np.flatnonzero((gaps <= _NO_GAP * radii[faces, None]).all(axis=1))
                moved[faces[inside]] = True
                triangles[faces[inside]], weights[faces[inside]] = found.among((each + 1) * inside + each)
        return Places(triangles, weights), bool(moved.any())

    def _gaps(self, points: FloatArray, places: Places) -> FloatArray:
        """(k,) distances of points from their places."""
        return np.asarray(np.linalg.norm(points - places.values(self.mesh.vertices, self.mesh.points), axis=1))

    def _extended(
        self, points: FloatArray, inside: Places, middles: Places, radii: FloatArray
    ) -> tuple[FloatArray, Places]:
        """What counts at points beyond a wall, of the values inside and of those of the triangles at the middles.

        On the border that is the value inside, as far out as from the middle it is linear from the middle. Either is right on a plane;
        where the surface bends, the former would stretch what is far out and the latter tear what is near.
        """
        corners = self.mesh.points[self.mesh.vertices[middles.triangles]]
        sides = np.roll(corners, -1, axis=1) - corners
        longest = np.linalg.norm(sides, axis=2).max(axis=1)
        area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
        has_slope = area > _THIN * radii * longest
        inside_points, centers = (each.values(self.mesh.vertices, self.mesh.points) for each in (inside, middles))
        out, away = (np.linalg.norm(points - each, axis=1) for each in (inside_points, centers))
        kept = np.where(has_slope, 1 - out / np.maximum(np.maximum(out, away), np.finfo(float).tiny), 1)
        weights = np.zeros((len(points), 3))
        at_points, at_places = (plane_weights(each[has_slope], corners[has_slope]) for each in (points, inside_points))
        weights[has_slope] = at_points - kept[has_slope, None] * at_places
        return kept, Places(middles.triangles, weights)

    def _reached(
        self, walls: BoolArray, starts: Indices, centers: FloatArray, radii: FloatArray
    ) -> tuple[Indices, Indices]:
        """Pairs of a start's number and a triangle that is reached from it, in order."""
        count = len(self.mesh.vertices)
        ways = np.where(walls.ravel(), -1, self._opposite).reshape(-1, 3)
        former, latest = np.zeros(0, np.int64), np.arange(len(starts)) * count + starts
        found = [latest]
        while len(latest):
            owner, triangle = latest // count, latest % count
            across = ways[triangle]
            keys = np.unique((owner[:, None] * count + across // 3)[across >= 0])
            # A walk by steps: what was there before was so in one of the last two.
            keys = keys[~_is_in(keys, former) & ~_is_in(keys, latest)]
            owner, triangle = keys // count, keys % count
            gap = np.maximum(self._low[triangle] - centers[owner], centers[owner] - self._high[triangle])
            near = (np.maximum(gap, 0) ** 2).sum(axis=1) <= radii[owner] ** 2
            former, latest = latest, keys[near]
            found.append(latest)
        pairs = np.sort(np.concatenate(found))
        return pairs // count, pairs % count

    def _nearest_reached(self, points: FloatArray, faces: Indices, owners: Indices, reached: Indices) -> Places:
        """For every point the nearest place in the triangles that its face reached."""
        triangles, weights = np.zeros(len(points), np.int64), np.zeros((len(points), 3))
        first, last = np.searchsorted(owners, faces, "left"), np.searchsorted(owners, faces, "right")
        for begin, end in parts(np.cumsum(last - first), _PAIRS):
            size = (last - first)[begin:end]
            starts = np.cumsum(size) - size
            which = np.repeat(np.arange(begin, end), size)
            candidates = reached[np.repeat(first[begin:end] - starts, size) + np.arange(len(which))]
            corners = self.mesh.points[self.mesh.vertices[candidates]]
            places = nearest_in_triangles(points[which], corners)
            squared = ((places - points[which]) ** 2).sum(axis=1)
            chosen = np.lexsort((squared, which))[starts]
            triangles[begin:end] = candidates[chosen]
            weights[begin:end] = weights_in(places[chosen], corners[chosen])
        return Places(triangles, weights)


def _opposite_sides(begin: Indices, end: Indices, names: Indices) -> tuple[Indices, Indices]:
    """For every side with these ends the name of the one other side with the same, or -1; and how many have the same."""
    pairs = np.sort(np.stack([begin, end], axis=1), axis=1)
    keys = pairs[:, 0] * (int(pairs.max(initial=0)) + 1) + pairs[:, 1]
    order = np.argsort(keys, kind="stable")
    _, inverse, counts = np.unique(keys, return_inverse=True, return_counts=True)
    uses = counts[inverse.reshape(-1)]
    paired = order[uses[order] == 2].reshape(-1, 2)
    opposite = np.full(len(keys), -1, np.int64)
    opposite[paired[:, 0]], opposite[paired[:, 1]] = names[paired[:, 1]], names[paired[:, 0]]
    return opposite, uses


def _next_side(side: Indices) -> Indices:
    following: Indices = side - side % 3 + (side + 1) % 3
    return following


def _is_in(values: Indices, ordered: Indices) -> BoolArray:
    if not len(ordered):
        return np.zeros(len(values), np.bool_)
    at = np.minimum(np.searchsorted(ordered, values), len(ordered) - 1)
    found: BoolArray = ordered[at] == values
    return found
