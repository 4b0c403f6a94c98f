"""Nearest triangles and triangles within a reach, against a look at all of them."""

import numpy as np
import pytest

from hybrid_quad.core.surface_points import BoxTree, nearest_in_triangles


@pytest.fixture(params=[1, 7, 300])
def cloud(request):
    """Triangles, some of them segments and points, and places near and far."""
    rng = np.random.default_rng(request.param)
    corners = rng.random((request.param, 1, 3)) + 0.1 * rng.standard_normal((request.param, 3, 3))
    corners[::3, 2] = corners[::3, 0]
    corners[::9] = corners[::9, :1]
    points = np.concatenate([rng.random((60, 3)), 5 * rng.standard_normal((20, 3)), corners[:5, 1]])
    distances = np.stack(
        [
            np.linalg.norm(nearest_in_triangles(np.repeat(p[None], len(corners), axis=0), corners) - p, axis=1)
            for p in points
        ]
    )
    return corners, points, distances


def test_nearest_is_the_nearest_of_all(cloud):
    corners, points, distances = cloud
    places, found = BoxTree(corners).nearest(points)
    assert np.allclose(np.linalg.norm(places - points, axis=1), distances.min(axis=1), rtol=0, atol=1e-12)
    assert np.allclose(distances[np.arange(len(points)), found], distances.min(axis=1), rtol=0, atol=1e-12)


def test_nothing_is_found_beyond_the_reach(cloud):
    corners, points, distances = cloud
    reach = np.linspace(0.01, 0.7, len(points))
    found = BoxTree(corners).nearest(points, reach)[1]
    assert np.array_equal(found >= 0, distances.min(axis=1) <= reach)


def test_all_pairs_within_the_reach_once(cloud):
    corners, points, distances = cloud
    reach = np.linspace(0.01, 0.7, len(points))
    parts = list(BoxTree(corners).within(points, reach))
    pairs = sorted((int(p), int(t)) for which, triangles, _ in parts for p, t in zip(which, triangles, strict=True))
    assert pairs == sorted(map(tuple, np.argwhere(distances <= reach[:, None]).tolist()))
