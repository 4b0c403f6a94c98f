import numpy as np
import pytest

from hybrid_quad.core.guide_values import guides_of_vertices, sound_density, transformed_guides
from hybrid_quad.core.mesh_arrays import as_polygons


def test_directions_follow_the_surface_and_strengths_stay():
    random = np.random.default_rng(2)
    linear = random.normal(size=(3, 3))
    vectors = random.normal(size=(50, 3)) * 0.3
    moved = transformed_guides(vectors, linear)
    assert np.linalg.norm(moved, axis=1) == pytest.approx(np.minimum(np.linalg.norm(vectors, axis=1), 1))
    directions = vectors @ linear.T
    assert np.linalg.norm(np.cross(moved, directions), axis=1).max() < 1e-12
    assert ((moved * directions).sum(axis=1) > 0).all()


def test_free_and_broken_guides_are_free():
    moved = transformed_guides([(0, 0, 0), (np.nan, 1, 0), (np.inf, 0, 0), (9, 0, 0)], np.eye(3))
    assert moved.tolist() == [[0, 0, 0], [0, 0, 0], [0, 0, 0], [1, 0, 0]]


def test_density_without_meaning_is_neutral():
    assert sound_density([2, 0, -1, np.nan, np.inf, 0.5]).tolist() == [2, 1, 1, 1, 1, 0.5]


def test_guides_of_faces_reach_their_vertices_strongest_first():
    polygons = as_polygons([(0, 1, 2), (2, 1, 3)])
    of_faces = np.array([(0.5, 0, 0), (0, 1, 0)])
    guides = guides_of_vertices(of_faces, polygons, 5)
    assert guides.tolist() == [[0.5, 0, 0], [0, 1, 0], [0, 1, 0], [0, 1, 0], [0, 0, 0]]
