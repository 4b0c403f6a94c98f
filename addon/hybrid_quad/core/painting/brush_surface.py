"""A surface as brushes see it: places that carry values, which of them a brush touches, and which are neighbours."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ..edge_borders import edge_keys, following_corners, polygon_normals
from ..mesh_arrays import FloatArray, Polygons, unit_vectors
from ..strokes import vertex_normals
from ..surface_points import PointGrid

Indices = npt.NDArray[np.int64]

# Cosine between normals below which a place is on another side of the surface than the brush: a thin sheet's back.
_SAME_SIDE = 0.3


class Dabs(NamedTuple):
    """Touches of a brush, in their order.

    Attributes
    ----------
    positions : (k, 3) float64
        On the surface.
    tangents : (k, 3) float64
        Unit vectors along the stroke; zero where it has no direction.
    polygons : (k,) int64
        The one each lies in.
    strengths : (k,) float64
        0..1.
    sizes : (k,) float64
        Above 0, to 1: the part of the brush's radius that each reaches.
    """

    positions: FloatArray
    tangents: FloatArray
    polygons: Indices
    strengths: FloatArray
    sizes: FloatArray

    def among(self, chosen: npt.NDArray[np.bool_]) -> Dabs:
        """Some of the dabs."""
        return Dabs(
            self.positions[chosen],
            self.tangents[chosen],
            self.polygons[chosen],
            self.strengths[chosen],
            self.sizes[chosen],
        )


class Touches(NamedTuple):
    """Pairs of a dab and an element that it touches, dab by dab.

    Attributes
    ----------
    dabs, elements : (t,) int64
    distances : (t,) float64
        As parts of a dab's own radius, times the brush's: less than this.
    """

    dabs: Indices
    elements: Indices
    distances: FloatArray


class BrushSurface:
    """The vertices of a polygon mesh, or its polygons, as elements that carry a value each.

    Parameters
    ----------
    vertices : (n, 3) float64
    polygons : Polygons
    of_faces : bool
        Whether the elements are the polygons.
    """

    def __init__(self, vertices: FloatArray, polygons: Polygons, *, of_faces: bool = False) -> None:
        self.vertices, self.polygons, self.of_faces = vertices, polygons, of_faces
        self.polygon_normals = polygon_normals(vertices, polygons)
        self._starts = np.cumsum(polygons.sizes, dtype=np.int64) - polygons.sizes
        if of_faces:
            self.positions, self.normals = _polygon_middles(vertices, polygons), self.polygon_normals
        else:
            self.positions, self.normals = vertices, vertex_normals(vertices, polygons)
        self._grid: tuple[float, PointGrid] | None = None

    def touched(self, dabs: Dabs, radius: float) -> Touches:
        """The elements within `radius`, times its size, of each dab and on its side of the surface.

        So that a brush finer than the mesh touches something, the corners of the polygon it is in, or the polygon, count as no
        farther than half the radius. A pair may come twice, the nearer last.
        """
        if self._grid is None or self._grid[0] != radius:
            self._grid = (radius, PointGrid(self.positions, radius))
        parts = [(dab, element, away / dabs.sizes[dab]) for dab, element, away in self._grid[1].pairs(dabs.positions)]
        parts.append(self._of_touched_polygons(dabs, radius))
        dab, element, distance = (np.concatenate([part[i] for part in parts]) for i in range(3))
        normals = self.polygon_normals[dabs.polygons]
        near = (np.einsum("ij,ij->i", normals[dab], self.normals[element]) > _SAME_SIDE) & (distance < radius)
        order = np.flatnonzero(near)[np.argsort(dab[near], kind="stable")]
        return Touches(dab[order], element[order], distance[order])

    def _of_touched_polygons(self, dabs: Dabs, radius: float) -> tuple[Indices, Indices, FloatArray]:
        if self.of_faces:
            dab, element = np.arange(len(dabs.polygons)), dabs.polygons
        else:
            sizes = self.polygons.sizes[dabs.polygons].astype(np.int64)
            dab = np.repeat(np.arange(len(sizes)), sizes)
            within = np.arange(len(dab)) - np.repeat(np.cumsum(sizes) - sizes, sizes)
            corner = np.repeat(self._starts[dabs.polygons], sizes) + within
            element = self.polygons.vertices[corner].astype(np.int64)
        away = np.linalg.norm(dabs.positions[dab] - self.positions[element], axis=1)
        return dab, element, np.minimum(away / dabs.sizes[dab], 0.5 * radius)

    def towards(self, vectors: FloatArray, normals: FloatArray, elements: Indices) -> FloatArray:
        """(t, 3) tangents of a surface with `normals`, turned the shortest way into the elements' tangent planes."""
        own = self.normals[elements]
        both = normals + own
        cosine = np.einsum("ij,ij->i", normals, own)
        share = np.einsum("ij,ij->i", own, vectors) / np.maximum(1 + cosine, 1e-6)
        turned: FloatArray = vectors - share[:, None] * both
        return turned

    def crosses(self, vectors: FloatArray, elements: Indices) -> npt.NDArray[np.complex128]:
        """(t,) vectors as crosses: numbers of the same length, up to 1, whose angle is four times the vectors' in the plane."""
        x, y = self._frame(elements)
        along = np.einsum("ij,ij->i", vectors, x) + 1j * np.einsum("ij,ij->i", vectors, y)
        length = np.minimum(np.linalg.norm(vectors, axis=1), 1)
        size = np.abs(along)
        units = np.divide(along, size, out=np.zeros_like(along), where=size > 1e-12)
        result: npt.NDArray[np.complex128] = length * units**4
        return result

    def vectors(self, crosses: npt.NDArray[np.complex128], elements: Indices, like: FloatArray) -> FloatArray:
        """(t, 3) crosses as tangents, each along that one of its four arms that is nearest to the vector in `like`."""
        x, y = self._frame(elements)
        angle = np.angle(crosses) / 4
        wanted = np.arctan2(np.einsum("ij,ij->i", like, y), np.einsum("ij,ij->i", like, x))
        angle += np.round((wanted - angle) / (np.pi / 2)) * (np.pi / 2)
        result: FloatArray = np.abs(crosses)[:, None] * (np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * y)
        return result

    def _frame(self, elements: Indices) -> tuple[FloatArray, FloatArray]:
        normals = self.normals[elements]
        x = unit_vectors(np.cross(normals, np.eye(3)[np.abs(normals).argmin(axis=1)]))
        return x, np.cross(normals, x)

    @cached_property
    def neighbors(self) -> tuple[Indices, Indices]:
        """Elements that share an edge: where those of each begin, (elements + 1,), and all of them, one after the other."""
        sides = np.stack([self.polygons.vertices, self.polygons.vertices[following_corners(self.polygons)]], axis=1)
        keys = edge_keys(sides, len(self.vertices))
        if self.of_faces:
            order = np.argsort(keys, kind="stable")
            owner = np.repeat(np.arange(len(self.polygons.sizes)), self.polygons.sizes)[order]
            same = np.flatnonzero(keys[order][1:] == keys[order][:-1])
            pairs = np.stack([owner[same], owner[same + 1]], axis=1)
        else:
            _, first = np.unique(keys, return_index=True)
            pairs = sides[first].astype(np.int64)
        both = np.concatenate([pairs, pairs[:, ::-1]])
        both = both[np.argsort(both[:, 0], kind="stable")]
        starts = np.searchsorted(both[:, 0], np.arange(len(self.positions) + 1))
        return starts.astype(np.int64), both[:, 1]

    def neighbor_pairs(self, elements: Indices) -> tuple[Indices, Indices]:
        """For each pair of one of `elements` and a neighbour: the number of the one in `elements`, and the neighbour."""
        starts, others = self.neighbors
        count = starts[elements + 1] - starts[elements]
        which = np.repeat(np.arange(len(elements)), count)
        within = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
        return which, others[np.repeat(starts[elements], count) + within]

    @cached_property
    def spacing(self) -> float:
        """A usual distance between neighbours."""
        starts, others = self.neighbors
        first = np.repeat(np.arange(len(self.positions)), np.diff(starts))
        lengths = np.linalg.norm(self.positions[first] - self.positions[others], axis=1)
        return float(np.median(lengths)) if len(lengths) else 0.0


def _polygon_middles(vertices: FloatArray, polygons: Polygons) -> FloatArray:
    owner = np.repeat(np.arange(len(polygons.sizes)), polygons.sizes)
    own = vertices[polygons.vertices]
    sums = np.stack([np.bincount(owner, own[:, i], len(polygons.sizes)) for i in range(3)], axis=1)
    middles: FloatArray = sums / np.maximum(polygons.sizes, 1)[:, None]
    return middles
