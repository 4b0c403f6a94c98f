"""Subdivision surfaces: known limits, creases, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import hybrid_quad
from support import surfaces

CUBE = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
SIDES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
EDGES = [(a, b) for side in SIDES for a, b in zip(side, side[1:] + side[:1], strict=True) if a < b]


def test_a_step_splits_every_face_and_says_which_it_came_from():
    found = hybrid_quad.subdivide(CUBE, SIDES, levels=2, limit=False)
    assert len(found.quads) == 6 * 16
    assert np.bincount(found.faces).tolist() == [16] * 6
    assert len(found.vertices) == 6 * 16 + 2
    assert found.normals.shape == (0, 3)


def test_the_limit_of_a_cube_has_its_corners_where_the_masks_put_them():
    # A corner of three quads: 9/24 of itself and, for each face, 4/24 of the neighbour and 1/24 of the opposite corner.
    found = hybrid_quad.subdivide(CUBE, SIDES, levels=1)
    np.testing.assert_allclose(found.vertices[:8], 0.5 * CUBE, atol=1e-12)
    assert (np.einsum("ij,ij->i", found.normals, found.vertices) > 0).all()


def test_limit_points_do_not_depend_on_the_level():
    coarse = hybrid_quad.subdivide(CUBE, SIDES, levels=1).vertices
    fine = hybrid_quad.subdivide(CUBE, SIDES, levels=4).vertices
    apart = np.linalg.norm(coarse[:, None] - fine[None], axis=2).min(axis=1)
    assert apart.max() < 1e-12


def test_infinitely_sharp_creases_keep_a_cube_a_cube():
    found = hybrid_quad.subdivide(CUBE, SIDES, levels=3, crease_edges=EDGES, sharp_vertices=range(8))
    np.testing.assert_allclose(np.abs(found.vertices).max(axis=1), 1)
    rounder = hybrid_quad.subdivide(CUBE, SIDES, levels=3, crease_edges=EDGES, crease_sharpness=1.0)
    assert np.abs(rounder.vertices[:8]).max() < 0.9


def test_the_boundary_keeps_its_corners_only_where_asked():
    square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
    kept = hybrid_quad.subdivide(square, [(0, 1, 2, 3)], levels=3, keep_corners=True)
    np.testing.assert_allclose(kept.vertices[:4], square, atol=1e-12)
    assert hybrid_quad.subdivide(square, [(0, 1, 2, 3)], levels=3).vertices[:4, :2].min() > 0.05


def test_triangles_and_larger_faces_become_quads():
    found = hybrid_quad.subdivide(*surfaces.torus(around=12, across=8), levels=1)
    assert len(found.quads) == 3 * 12 * 8 * 2
    distances = hybrid_quad.surface_distances(found.vertices, *surfaces.torus(around=12, across=8))
    assert 0 < distances.max() < 0.2


def test_distances_are_those_to_the_nearest_point():
    found = hybrid_quad.surface_distances([(0, 0, 3), (0, 0, 0), (2, 2, 1), (0.3, -1, 0.2)], CUBE, SIDES)
    np.testing.assert_allclose(found, [2, 1, np.sqrt(2), 0], atol=1e-12)


def test_points_that_are_nowhere_have_no_distance():
    with pytest.raises(ValueError, match="row 1 "):
        hybrid_quad.surface_distances([(0, 0, 0), (0, np.nan, 0)], CUBE, SIDES)


@pytest.mark.parametrize(
    ("options", "code"),
    [({"crease_edges": [(0, 7)]}, "unknown_edge"), ({"sharp_vertices": [8]}, "index_out_of_range")],
)
def test_what_is_not_there_is_named(options, code):
    with pytest.raises(hybrid_quad.InputError) as caught:
        hybrid_quad.subdivide(CUBE, SIDES, **options)
    assert caught.value.code == code


def test_faces_that_are_none_are_named():
    for faces, code in (([(0, 1)], "malformed_faces"), ([(0, 1, 9)], "index_out_of_range")):
        with pytest.raises(hybrid_quad.InputError) as caught:
            hybrid_quad.subdivide(CUBE, faces)
        assert (caught.value.code, list(caught.value.elements)) == (code, [0])
    with pytest.raises(hybrid_quad.InputError, match="no faces"):
        hybrid_quad.subdivide([], [])


@pytest.mark.parametrize(
    "options", [{"levels": 0}, {"levels": 9}, {"crease_sharpness": [1, 2]}, {"crease_sharpness": -1.0}]
)
def test_options_that_make_no_sense_are_refused(options):
    with pytest.raises(ValueError, match=r"levels|crease_sharpness"):
        hybrid_quad.subdivide(CUBE, SIDES, **{"crease_edges": EDGES, **options})
