"""Places on a triangulated polygon mesh, and the values there of what its vertices and corners carry."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .mesh_arrays import FloatArray
from .surface_points import nearest_in_triangles

Indices = npt.NDArray[np.int64]


class TriangleMesh(NamedTuple):
    """The triangles of a polygon mesh.

    Attributes
    ----------
    points : (n, 3) float64
    vertices : (t, 3) int64
        Of each triangle.
    corners : (t, 3) int64
        The polygons' corners that they are, in the mesh's own numbers.
    polygons : (t,) int64
        The polygon that each triangle is part of.
    """

    points: FloatArray
    vertices: Indices
    corners: Indices
    polygons: Indices

    def normals(self) -> FloatArray:
        """(t, 3) of the length of twice the triangles' areas."""
        a, b, c = (self.points[self.vertices[:, i]] for i in range(3))
        normals: FloatArray = np.cross(b - a, c - a)
        return normals

    def of_polygons(self, chosen: npt.NDArray[np.bool_]) -> TriangleMesh:
        """The triangles of some of the polygons; numbers stay as they are."""
        own = chosen[self.polygons]
        return TriangleMesh(self.points, self.vertices[own], self.corners[own], self.polygons[own])


class Places(NamedTuple):
    """Places in triangles.

    Attributes
    ----------
    triangles : (k,) int64
    weights : (k, 3) float64
        Shares of the triangle's corners: none negative, 1 in sum.
    """

    triangles: Indices
    weights: FloatArray

    def values(self, indices: Indices, values: FloatArray) -> FloatArray:
        """(k, ...) what lies there, linear in each triangle, where `indices` (t, 3) says whose values its corners have."""
        own = values[indices[self.triangles]]
        mixed: FloatArray = np.einsum("ki,ki...->k...", self.weights, own)
        return mixed

    def nearest(self, indices: Indices) -> Indices:
        """(k,) of `indices` (t, 3) that of the corner with the largest share."""
        chosen: Indices = indices[self.triangles, self.weights.argmax(axis=1)]
        return chosen

    def among(self, chosen: npt.NDArray[np.bool_] | Indices) -> Places:
        """Some of the places."""
        return Places(self.triangles[chosen], self.weights[chosen])


def places_in(points: FloatArray, mesh: TriangleMesh, triangles: Indices) -> Places:
    """The nearest place to each point within a triangle given for each."""
    corners = mesh.points[mesh.vertices[triangles]]
    return Places(triangles, weights_in(nearest_in_triangles(points, corners), corners))


def weights_in(points: FloatArray, corners: FloatArray) -> FloatArray:
    """(k, 3) shares of the corners at points that lie in triangles, degenerate ones among them.

    Parameters
    ----------
    points : (k, 3) float64
    corners : (k, 3, 3) float64
    """
    weights = np.maximum(_areas_opposite(points, corners), 0)
    flat = ~(_squared_area(corners) > 0)
    if flat.any():
        weights[flat] = _weights_on_longest_side(points[flat], corners[flat])
    total = weights.sum(axis=1, keepdims=True)
    shares: FloatArray = np.divide(weights, total, out=np.full_like(weights, 1 / 3), where=total > 0)
    return shares


def plane_weights(points: FloatArray, corners: FloatArray) -> FloatArray:
    """(k, 3) shares of the corners, in sum 1, at the points' projections on the planes of triangles; not finite for flat ones.

    Parameters
    ----------
    points : (k, 3) float64
    corners : (k, 3, 3) float64
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        weights: FloatArray = _areas_opposite(points, corners) / _squared_area(corners)[:, None]
    return weights


def _areas_opposite(points: FloatArray, corners: FloatArray) -> FloatArray:
    """(k, 3) signed areas between a point's projection and the sides opposite to each corner, times the triangle's own."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    normal = np.cross(b - a, c - a)
    parts = [np.cross(end - begin, points - begin) for begin, end in ((b, c), (c, a), (a, b))]
    return np.stack([(part * normal).sum(axis=1) for part in parts], axis=1)


def _squared_area(corners: FloatArray) -> FloatArray:
    """(k,) as `_areas_opposite` counts them."""
    squared: FloatArray = (np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) ** 2).sum(axis=1)
    return squared


def _weights_on_longest_side(points: FloatArray, corners: FloatArray) -> FloatArray:
    sides = np.roll(corners, -1, axis=1) - corners
    longest = (sides**2).sum(axis=2).argmax(axis=1)
    row = np.arange(len(points))
    begin, along = corners[row, longest], sides[row, longest]
    length = (along**2).sum(axis=1)
    share = np.divide(((points - begin) * along).sum(axis=1), length, out=np.zeros(len(points)), where=length > 0)
    share = np.clip(share, 0, 1)
    weights = np.zeros((len(points), 3))
    weights[row, longest] = 1 - share
    weights[row, (longest + 1) % 3] += share
    return weights
