"""Guides from lines: where they act, in which direction, how strongly."""

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.core.mesh_arrays import as_polygons
from hybrid_quad.core.strokes import Stroke, checked_strokes, guides_from_strokes, stronger_of, vertex_normals
from hybrid_quad.core.surface_points import fan_triangles, nearest_on_surface, pairs_within
from support.surfaces import grid, sphere


def _degrees_to_cross(vectors, directions, normals):
    """Angle between crosses in the tangent planes."""
    cosine = np.abs((vectors * directions).sum(axis=1)) / np.linalg.norm(vectors, axis=1)
    sine = np.abs((np.cross(normals, directions) * vectors).sum(axis=1)) / np.linalg.norm(vectors, axis=1)
    return np.degrees(np.arctan2(np.minimum(cosine, sine), np.maximum(cosine, sine)))


def _circle(height: float, count: int = 60):
    angle = np.linspace(0, 2 * np.pi, count)
    radius = np.sqrt(1 - height**2)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.full(count, height)], axis=1)


def test_a_circle_of_latitude_guides_along_itself():
    vertices, faces = sphere(20)
    height = 0.3
    guides = guides_from_strokes(vertices, faces, [1.1 * _circle(height)], radius=0.2)
    length = np.linalg.norm(guides, axis=1)
    # Put onto the surface, the line is at the same angle from the axis.
    away = np.abs(np.arcsin(vertices[:, 2]) - np.arcsin(height))
    assert (length[away < 0.02] > 0.9).all() and not length[away > 0.2].any()
    inside = (away > 0.02) & (away < 0.17)
    order = np.argsort(away[inside])
    smooth = np.polyfit(away[inside][order], length[inside][order], 1)
    assert smooth[0] < -3, "weaker with the distance"
    on = length > 0
    normals = vertex_normals(vertices, as_polygons(faces))[on]
    assert np.abs((guides[on] * normals).sum(axis=1)).max() < 1e-9
    east = np.cross([0, 0, 1], vertices[on])
    east /= np.linalg.norm(east, axis=1, keepdims=True)
    assert _degrees_to_cross(guides[on], east, normals).max() < 3


def test_the_back_of_a_thin_sheet_is_left_alone():
    vertices, faces = grid(20, 20)
    back = vertices - [0, 0, 0.01]
    both = np.concatenate([vertices, back])
    sheets = np.concatenate([faces, faces[:, ::-1] + len(vertices)])
    line = [(0.2, 0.5, 0.005), (0.8, 0.5, 0.005)]
    length = np.linalg.norm(guides_from_strokes(both, sheets, [line], radius=0.2), axis=1)
    assert length[: len(vertices)].max() > 0.9
    assert not length[len(vertices) :].any()


def test_crossing_lines_agree_as_a_cross():
    vertices, faces = grid(20, 20)
    across = [(0.1, 0.5, 0), (0.9, 0.5, 0)], [(0.5, 0.1, 0), (0.5, 0.9, 0)]
    guides = guides_from_strokes(vertices, faces, across, radius=0.3)
    on = np.linalg.norm(guides, axis=1) > 0
    up = np.tile([0.0, 0.0, 1.0], (on.sum(), 1))
    assert _degrees_to_cross(guides[on], np.tile([1.0, 0.0, 0.0], (on.sum(), 1)), up).max() < 1e-6


def test_strength_scales_and_zero_says_nothing():
    vertices, faces = grid(20, 20)
    line = np.array([(0.1, 0.5, 0), (0.9, 0.5, 0)])
    full = guides_from_strokes(vertices, faces, [line], radius=0.1)
    half = guides_from_strokes(vertices, faces, [Stroke(line, 0.5)], radius=0.1)
    assert half == pytest.approx(0.5 * full, abs=1e-12)
    assert not guides_from_strokes(vertices, faces, [Stroke(line, 0.0)], radius=0.1).any()


def test_a_coarse_mesh_is_guided_where_the_line_passes():
    vertices, faces = grid(2, 2)
    line = [(0.6, 0.6, 0), (0.7, 0.7, 0)]
    guides = guides_from_strokes(vertices, faces, [line], radius=0.01)
    guided = np.flatnonzero(np.linalg.norm(guides, axis=1) > 0)
    assert len(guided) >= 3 and (vertices[guided, :2] >= 0.5 - 1e-9).all()
    assert np.abs(guides[guided, 0]) == pytest.approx(np.abs(guides[guided, 1]))


@pytest.mark.parametrize("strokes", [[], [np.zeros((0, 3))], [[(0, 0, 0)]], [[(1, 1, 1), (1, 1, 1)]]], ids=str)
def test_lines_without_length_guide_nothing(strokes):
    vertices, faces = grid(4, 4)
    assert not guides_from_strokes(vertices, faces, strokes, radius=1.0).any()


@pytest.mark.parametrize(
    ("stroke", "radius"),
    [
        ([(0, 0, 0), (1, 0, 0)], 0.0),
        ([(0, 0, 0), (1, 0, 0)], np.nan),
        ([(0, 0, np.inf), (1, 0, 0)], 1.0),
        (Stroke(np.zeros((2, 3)), 2.0), 1.0),
        ([(0, 0), (1, 0)], 1.0),
    ],
    ids=str,
)
def test_what_makes_no_sense_is_refused(stroke, radius):
    with pytest.raises(ValueError, match=r"radius|stroke|array"):
        hybrid_quad.guides_from_strokes(*grid(4, 4), [stroke], radius=radius)


@pytest.mark.parametrize("at", [1e18, 1e300])
def test_lines_so_far_off_that_all_is_as_near_are_refused(at):
    with pytest.raises(hybrid_quad.InputError) as caught:
        guides_from_strokes(*grid(4, 4), [[(0, 0, 0), (1, 0, 0)], [(at, 0, 0), (0, at, 0)]], radius=1.0)
    assert caught.value.code == "stroke_too_far"


@pytest.mark.parametrize("vertex", [-99, 99])
def test_faces_of_vertices_that_do_not_exist_are_named(vertex):
    vertices, faces = grid(4, 4)
    faces = np.concatenate([faces, [[0, 1, vertex]]])
    line = [(0, 0, 0), (1, 0, 0)]
    for run in (
        lambda: guides_from_strokes(vertices, faces, [line], 1.0),
        lambda: hybrid_quad.remesh(vertices, faces, strokes=[line]),
    ):
        with pytest.raises(hybrid_quad.InputError) as caught:
            run()
        assert (caught.value.code, caught.value.elements) == ("index_out_of_range", (len(faces) - 1,))


def test_vertices_that_are_nowhere_do_not_matter_unless_faces_have_them():
    vertices, faces = grid(4, 4)
    line = [(0, 0.5, 0), (1, 0.5, 0)]
    loose = guides_from_strokes(np.concatenate([vertices, [[np.nan, 0, 0]]]), faces, [line], 0.3)
    assert np.array_equal(loose[:-1], guides_from_strokes(vertices, faces, [line], 0.3))
    vertices[faces[0, 0]] = np.inf
    with pytest.raises(hybrid_quad.InputError) as caught:
        guides_from_strokes(vertices, faces, [line], 0.3)
    assert (caught.value.code, caught.value.elements) == ("non_finite_vertex", (faces[0, 0],))


def test_one_line_for_a_list_of_lines_is_told_as_such():
    with pytest.raises(ValueError, match="strokes"):
        checked_strokes([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])


def test_nearest_points_are_nearest():
    random = np.random.default_rng(0)
    vertices = random.normal(size=(60, 3))
    triangles = np.array([random.choice(60, 3, replace=False) for _ in range(150)])
    points = 2 * random.normal(size=(80, 3))
    found = nearest_on_surface(points, vertices, triangles)
    weights = random.dirichlet((0.7, 0.7, 0.7), 3000)
    samples = np.einsum("sk,tkd->tsd", weights, vertices[triangles]).reshape(-1, 3)
    for point, place, triangle in zip(points, found.positions, found.triangles, strict=True):
        distance = np.linalg.norm(point - place)
        sampled = np.linalg.norm(samples - point, axis=1).min()
        assert distance <= sampled + 1e-12 and sampled < distance + 0.1
        share, rest, *_ = np.linalg.lstsq(
            np.vstack([vertices[triangles[triangle]].T, np.ones(3)]), np.append(place, 1), rcond=None
        )
        assert share.min() > -1e-9 and (not len(rest) or rest[0] < 1e-18)


@pytest.mark.filterwarnings("error")
def test_a_radius_far_below_the_points_distances_finds_those_in_one_place():
    points = np.random.default_rng(1).random((50, 3))
    parts = [np.stack(part[:2], axis=1) for part in pairs_within(points[:3], points, 1e-300)]
    assert np.concatenate(parts).tolist() == [[0, 0], [1, 1], [2, 2]]


@pytest.mark.parametrize("radius", [0.05, 0.4, 10.0])
def test_pairs_within_a_distance_are_all_of_them(radius):
    random = np.random.default_rng(1)
    points, others = random.normal(size=(150, 3)), random.normal(size=(200, 3)) * [1, 1, 0.01]
    found = {}
    for first, second, distance in pairs_within(points, others, radius):
        for pair in zip(first.tolist(), second.tolist(), distance.tolist(), strict=True):
            assert pair[:2] not in found
            found[pair[:2]] = pair[2]
    distances = np.linalg.norm(points[:, None] - others, axis=2)
    assert set(found) == set(zip(*(index.tolist() for index in np.nonzero(distances < radius)), strict=True))
    assert all(abs(distances[pair] - distance) < 1e-12 for pair, distance in found.items())


def test_polygons_become_fans():
    assert fan_triangles(as_polygons([(0, 1, 2), (3, 4, 5, 6, 7), (8, 9)])).tolist() == [
        [0, 1, 2],
        [3, 4, 5],
        [3, 5, 6],
        [3, 6, 7],
    ]


def test_of_two_guides_the_stronger_counts():
    first, second = np.array([(1.0, 0, 0), (0, 0, 0)]), np.array([(0, 0.5, 0), (0, 0.1, 0)])
    assert stronger_of(first, second).tolist() == [[1, 0, 0], [0, 0.1, 0]]
    assert stronger_of(None, second) is second and stronger_of(first, None) is first
    assert stronger_of(None, None) is None
