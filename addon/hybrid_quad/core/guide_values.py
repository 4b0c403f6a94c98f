"""What painted guides and densities mean, whatever they were painted with."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .mesh_arrays import FloatArray, Polygons, unit_vectors


def transformed_guides(vectors: npt.ArrayLike, linear: FloatArray) -> FloatArray:
    """Guides of one space in another.

    Parameters
    ----------
    vectors : (k, 3) float
        Directions; the length, cut at 1, is the strength. Those with a number that is not finite count as zero: free.
    linear : (3, 3) float
        From the one space to the other, without translation. It moves the directions as it moves the surface; the
        strengths stay.

    Returns
    -------
    (k, 3) float64
    """
    given = np.asarray(vectors, np.float64).reshape(-1, 3)
    given = np.where(np.isfinite(given).all(axis=1, keepdims=True), given, 0.0)
    strength = np.minimum(np.linalg.norm(given, axis=1, keepdims=True), 1.0)
    guides: FloatArray = strength * unit_vectors(given @ np.asarray(linear, np.float64).T)
    return guides


def sound_density(values: npt.ArrayLike) -> FloatArray:
    """(n,) float64 densities; what is no number above zero, as in an attribute never painted, is neutral: 1."""
    given = np.asarray(values, np.float64).reshape(-1)
    return np.where(np.isfinite(given) & (given > 0), given, 1.0)


def guides_of_vertices(of_faces: FloatArray, polygons: Polygons, vertex_count: int) -> FloatArray:
    """(n, 3) for every vertex the strongest of the guides of its polygons, the first of equals."""
    owner = np.repeat(np.arange(len(polygons.sizes)), polygons.sizes)
    strength = (of_faces**2).sum(axis=1)[owner]
    order = np.lexsort((owner, -strength, polygons.vertices))
    vertices, first = np.unique(polygons.vertices[order], return_index=True)
    guides = np.zeros((vertex_count, 3))
    guides[vertices] = of_faces[owner[order[first]]]
    return guides
