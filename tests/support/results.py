"""What every result must satisfy, whatever it was made of."""

from __future__ import annotations

import numpy as np

from hybrid_quad import RemeshResult
from hybrid_quad.core.mesh_arrays import FacesLike
from hybrid_quad.core.validation import topology, violations


def assert_sound(result: RemeshResult, faces: FacesLike) -> None:
    """Valid quads of the same topology as `faces`, and arrays that agree with each other."""
    assert violations(result.vertices, result.quads) == []
    assert topology(result.quads) == topology(faces)
    assert (result.vertices.dtype, result.quads.dtype) == (np.float64, np.int32)
    assert result.report["quads"] == len(result.quads)
    assert result.report["vertices"] == len(result.vertices)
    assert result.vertex_kinds.shape == (len(result.vertices),)
    assert result.vertex_kinds.max(initial=0) <= 2
    assert result.feature_edges.shape == (len(result.feature_curves), 2)
    edges = np.sort(np.stack([result.quads, np.roll(result.quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    known = {tuple(edge) for edge in edges.tolist()}
    assert all(tuple(edge) in known for edge in np.sort(result.feature_edges, axis=1).tolist())


def distance_to_edges(points: np.ndarray, result: RemeshResult) -> np.ndarray:
    """Distance of each point to the nearest of the result's feature edges."""
    start = result.vertices[result.feature_edges[:, 0]]
    along = result.vertices[result.feature_edges[:, 1]] - start
    squared = np.maximum((along**2).sum(1), np.finfo(float).tiny)
    t = np.clip(((points[:, None] - start) * along).sum(-1) / squared, 0, 1)
    return np.linalg.norm(points[:, None] - start - t[..., None] * along, axis=-1).min(axis=1)
