"""What the first stages of a run say: the field's topology, its alignment, sizes, symmetry, and quads that are a mesh."""

from __future__ import annotations

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad import RemeshOptions
from hybrid_quad.core.validation import violations
from support import surfaces


@pytest.mark.parametrize(("surface", "euler"), [(surfaces.sphere(10), 2), (surfaces.torus(), 0)])
def test_singularities_add_up_to_the_euler_characteristic(surface, euler):
    found = hybrid_quad.preview(*surface, RemeshOptions(quads=600))
    assert found.singular_quarters.sum() == 4 * euler
    assert len(found.singular_points) == len(found.singular_quarters)


def test_frames_are_tangent_and_right_handed():
    found = hybrid_quad.preview(*surfaces.torus(), RemeshOptions(quads=600), with_quads=True)
    for edge in (found.u, found.v):
        along = np.abs(np.einsum("ij,ij->i", edge, found.normals)) / np.linalg.norm(edge, axis=1)
        assert along.max() < 1e-9
    assert np.einsum("ij,ij->i", np.cross(found.u, found.v), found.normals).min() > 0


@pytest.mark.parametrize("with_quads", [False, True])
def test_sizes_and_crosses_agree_with_the_number_of_quads(with_quads):
    found = hybrid_quad.preview(*surfaces.torus(), RemeshOptions(quads=800), with_quads=with_quads)
    area = 4 * np.pi**2 * 0.4
    assert np.median(found.sizes()) == pytest.approx(np.sqrt(area / 800), rel=0.15)
    assert 0.5 * 800 < len(found.spread) < 1.5 * 800
    assert found.crosses().shape == (2 * len(found.spread), 2, 3)
    assert found.report["wanted_quads"] == pytest.approx(800)


def test_points_that_are_drawn_keep_their_distance_and_leave_no_gap():
    found = hybrid_quad.preview(*surfaces.torus(), RemeshOptions(quads=500))
    drawn, size = found.points[found.spread], np.median(found.sizes())
    apart = np.linalg.norm(drawn[:, None] - drawn[None], axis=2)
    np.fill_diagonal(apart, np.inf)
    assert apart.min() > 0.7 * size
    assert np.linalg.norm(found.points[:, None] - drawn[None], axis=2).min(axis=1).max() < 1.2 * size


def test_features_are_the_edges_of_a_box_and_the_field_follows_them():
    found = hybrid_quad.preview(*surfaces.box(), RemeshOptions(quads=600))
    assert np.linalg.norm(np.diff(found.feature_lines, axis=1), axis=2).sum() == pytest.approx(12)
    directions = np.abs(found.u / np.linalg.norm(found.u, axis=1, keepdims=True))
    assert (directions.max(axis=1) > 0.99).mean() > 0.95
    assert len(found.singular_points) == 0


def test_the_quads_of_one_try_are_a_mesh_about_as_large_as_asked():
    found = hybrid_quad.preview(*surfaces.sphere(10), RemeshOptions(quads=700), with_quads=True)
    assert not violations(found.quad_vertices, found.quads)
    assert 500 < len(found.quads) < 950
    assert len(found.quad_lines()) == 2 * len(found.quads)
    assert not len(hybrid_quad.preview(*surfaces.sphere(10), RemeshOptions(quads=700)).quads)


def test_guides_turn_the_field():
    vertices, faces = surfaces.grid(20, 20)
    asked = np.tile([np.cos(0.5), np.sin(0.5), 0.0], (len(vertices), 1))
    found = hybrid_quad.preview(vertices, faces, RemeshOptions(quads=400), guides=asked)
    middle = (np.abs(found.points[:, :2] - 0.5) < 0.25).all(axis=1)
    angles = np.arctan2(found.u[middle, 1], found.u[middle, 0]) - 0.5
    assert np.abs((angles + np.pi / 4) % (np.pi / 2) - np.pi / 4).max() < 0.1


def test_symmetry_shows_the_whole():
    vertices, faces = surfaces.sphere(10)
    found = hybrid_quad.preview(vertices, faces, RemeshOptions(quads=600, symmetry="xy"), with_quads=True)
    rows = {tuple(np.round(point, 9)) for point in found.points}
    for axis in (0, 1):
        flip = np.ones(3)
        flip[axis] = -1
        assert rows == {tuple(np.round(np.array(row) * flip, 9)) for row in rows}
    assert found.singular_quarters.sum() <= 8
    assert not violations(found.quad_vertices, found.quads)


def test_the_preview_is_in_the_units_and_at_the_place_of_the_mesh():
    vertices, faces = surfaces.torus()
    here = hybrid_quad.preview(vertices, faces, RemeshOptions(quads=500), with_quads=True)
    larger = hybrid_quad.preview(64 * vertices, faces, RemeshOptions(quads=500), with_quads=True)
    for name in ("points", "singular_points", "quad_vertices", "u", "v"):
        np.testing.assert_allclose(getattr(larger, name), 64 * getattr(here, name), atol=1e-9)
    away = hybrid_quad.preview(vertices + np.array([8, 0, 0]), faces, RemeshOptions(quads=500), with_quads=True)
    assert hybrid_quad.surface_distances(away.points - [8, 0, 0], vertices, faces).max() < 0.05


def test_a_preview_can_be_cancelled_and_refuses_what_a_run_refuses():
    with pytest.raises(hybrid_quad.Cancelled):
        hybrid_quad.preview(*surfaces.sphere(20), RemeshOptions(quads=20_000), cancel=lambda: True)
    with pytest.raises(hybrid_quad.InputError) as caught:
        hybrid_quad.preview([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])
    assert caught.value.code == "no_area"


def test_settings_of_another_type_are_named():
    mesh = surfaces.grid(4, 4)
    with pytest.raises(TypeError, match="options must be RemeshOptions, not dict"):
        hybrid_quad.preview(*mesh, {"quads": 100})
