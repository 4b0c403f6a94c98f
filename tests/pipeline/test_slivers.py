"""Parts whose files have few digits: slivers that fold along creases and rounds are no features (docs/decisions/0055)."""

from __future__ import annotations

import numpy as np
import pytest

import hybrid_quad


def pipe(segments: int, step: float) -> tuple[np.ndarray, np.ndarray]:
    """A pipe of outer radius 1, in as many strips, with coordinates in steps (0: as they are)."""
    turn = 2 * np.pi * np.arange(segments) / segments
    ring = np.column_stack([np.cos(turn), np.sin(turn)])
    levels = [(1.0, 0.0), (1.0, 0.6), (0.7, 0.6), (0.7, 0.0)]
    vertices = np.concatenate(
        [np.column_stack([radius * ring, np.full(segments, height)]) for radius, height in levels]
    )
    if step > 0:
        vertices = np.round(vertices / step) * step
    at, after = np.arange(segments), np.roll(np.arange(segments), -1)
    faces = []
    for level in range(4):
        low, high = level * segments, (level + 1) % 4 * segments
        faces += [
            np.column_stack([low + at, low + after, high + after]),
            np.column_stack([low + at, high + after, high + at]),
        ]
    return vertices, np.concatenate(faces)


def bends(vertices: np.ndarray, faces: np.ndarray, degrees: float) -> int:
    """How many edges bend by more."""
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    order = np.lexsort(edges.T)
    pairs = np.tile(np.arange(len(faces)), 3)[order].reshape(-1, 2)
    return int(
        np.count_nonzero(np.sum(normals[pairs[:, 0]] * normals[pairs[:, 1]], axis=1) < np.cos(np.radians(degrees)))
    )


@pytest.mark.parametrize("quads", [300, 500])
def test_the_rims_of_a_pipe_are_all_that_is_kept(quads: int) -> None:
    vertices, faces = pipe(2400, 0.002)
    assert bends(vertices, faces, 40) > 4 * 2400 + 1000, "the strips fold, beside the rims"
    result = hybrid_quad.remesh(vertices, faces, quads=quads, sharp_angle=40)
    report = result.report
    assert report["irregular_vertices"] <= 4
    assert report["scaled_jacobian"]["mean"] > 0.97
    assert report["feature_hausdorff_percent"] < 0.5, "of all four rims"
    assert report["mean_distance_percent"] < 0.15


def test_a_pipe_with_all_digits_keeps_its_rims_however_narrow_its_strips() -> None:
    smooth = [hybrid_quad.remesh(*pipe(segments, 0), quads=500, sharp_angle=40).report for segments in (400, 2000)]
    for report in smooth:
        assert report["irregular_vertices"] == 0
        assert report["features_given_way"] == 0
