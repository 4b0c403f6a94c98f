"""Strokes over surfaces: directions, numbers and lines, by what holds for any of them."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from hybrid_quad.core.mesh_arrays import Polygons, as_polygons
from hybrid_quad.core.painting.brush_surface import BrushSurface
from hybrid_quad.core.painting.density_values import LOG_BOUNDS, brightness, density_between, log_density
from hybrid_quad.core.painting.drawn_lines import Line, drawn_line, erased, smoothed
from hybrid_quad.core.painting.falloff import FALLOFFS, falloff_at
from hybrid_quad.core.painting.stroke_path import PenPlace, StrokePath
from hybrid_quad.core.painting.value_strokes import (
    Brush,
    Comb,
    Erase,
    Shift,
    SmoothDirections,
    SmoothNumbers,
)
from hybrid_quad.core.strokes import guides_from_strokes
from hybrid_quad.core.surface_points import fan_triangles, nearest_on_surface
from support.surfaces import grid, torus


def surface_of(mesh, of_faces: bool = False) -> BrushSurface:
    vertices, faces = mesh
    return BrushSurface(np.asarray(vertices, float), as_polygons(faces), of_faces=of_faces)


def draw(stroke, points, pressure: float = 1.0, radius: float | None = None, size: float = 1.0):
    """Leads the pen over the surface along a polyline."""
    surface, radius = stroke.surface, radius or stroke.brush.radius
    path = StrokePath(radius / 4)
    near = nearest_on_surface(np.asarray(points, float), surface.vertices, fan_triangles(surface.polygons))
    sizes = surface.polygons.sizes
    polygon_of = np.repeat(np.arange(len(sizes)), np.maximum(sizes - 2, 0))
    for position, triangle in zip(near.positions, near.triangles, strict=True):
        polygon = int(polygon_of[triangle])
        stroke.add(path.add(PenPlace(position, surface.polygon_normals[polygon], polygon, pressure, size)))
    stroke.add(path.lift())
    return stroke.values


def line_to(begin, end, count: int = 200) -> np.ndarray:
    share = np.linspace(0, 1, count)[:, None]
    return (1 - share) * np.asarray(begin, float) + share * np.asarray(end, float)


def none_on(surface: BrushSurface) -> np.ndarray:
    return np.zeros((len(surface.positions), 3))


def degrees_between_crosses(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    cosine = np.einsum("ij,ij->i", first, second) / np.linalg.norm(first, axis=1) / np.linalg.norm(second, axis=1)
    angle = np.degrees(np.arccos(np.clip(np.abs(cosine), 0, 1)))
    return np.minimum(angle, 90 - angle)


@pytest.mark.parametrize("of_faces", [False, True])
def test_a_brush_of_half_the_size_paints_as_one_of_half_the_radius(of_faces):
    surface, way = surface_of(grid(40, 40), of_faces), line_to((0.2, 0.3, 0), (0.7, 0.8, 0))
    small = draw(Comb(surface, none_on(surface), Brush(0.2)), way, size=0.5)
    fine = draw(Comb(surface, none_on(surface), Brush(0.1)), way)
    full = draw(Comb(surface, none_on(surface), Brush(0.2)), way)
    assert np.array_equal(small.any(axis=1), fine.any(axis=1)) and small == pytest.approx(fine, abs=1e-9)
    assert small.any(axis=1).sum() < 0.7 * full.any(axis=1).sum()


@pytest.mark.parametrize("name", sorted(FALLOFFS))
def test_falloffs_go_from_one_to_zero_and_never_up(name):
    values = falloff_at(np.linspace(0, 3, 50), 2.0, name)
    assert values[0] == 1 and (np.diff(values) <= 0).all()
    assert not falloff_at(np.array([2.0, 5.0]), 2.0, name).any()


@pytest.mark.parametrize("of_faces", [False, True])
def test_a_straight_stroke_turns_directions_along_it_within_its_radius(of_faces):
    surface = surface_of(grid(40, 40), of_faces)
    begin, end, radius = np.array([0.2, 0.2, 0]), np.array([0.8, 0.6, 0]), 0.1
    guides = draw(Comb(surface, none_on(surface), Brush(radius)), line_to(begin, end))
    along = (end - begin) / np.linalg.norm(end - begin)
    away = np.linalg.norm(np.cross(surface.positions - begin, along), axis=1)
    beside = ((surface.positions - begin) @ along > 0.05) & ((surface.positions - end) @ along < -0.05)
    strength = np.linalg.norm(guides, axis=1)
    assert not strength[away > radius].any()
    assert strength[(away < 0.2 * radius) & beside].min() > 0.8
    painted = strength > 0
    assert degrees_between_crosses(guides[painted], np.tile(along, (painted.sum(), 1))).max() < 1e-3
    assert (guides[painted] @ along > 0).all()  # the arm that runs the stroke's way


def test_combing_follows_a_bent_stroke_as_a_drawn_line_does():
    vertices, faces = torus(120, 60)
    surface = surface_of((vertices, faces))
    turn = np.linspace(0, 2, 400)
    tube = np.sin(2 * turn)
    around = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=1)
    drawn = around * (1 + 0.4 * np.cos(tube))[:, None] + np.array([0, 0, 0.4]) * np.sin(tube)[:, None]
    guides = draw(Comb(surface, none_on(surface), Brush(0.2)), drawn)
    drawn_guides = guides_from_strokes(vertices, faces, [drawn], 0.2)
    both = (np.linalg.norm(guides, axis=1) > 0.3) & (np.linalg.norm(drawn_guides, axis=1) > 0.3)
    assert both.sum() > 100
    off = degrees_between_crosses(guides[both], drawn_guides[both])
    assert np.median(off) < 1 and np.percentile(off, 95) < 5
    assert np.abs(np.einsum("ij,ij->i", guides, surface.normals)).max() < 1e-9


def test_closer_dabs_and_going_over_it_again_make_a_stroke_no_stronger():
    surface = surface_of(grid(30, 30))
    way = line_to((0.2, 0.5, 0), (0.8, 0.5, 0))
    once = draw(Comb(surface, none_on(surface), Brush(0.15)), way, pressure=0.5)
    twice = draw(Comb(surface, none_on(surface), Brush(0.15)), np.concatenate([way, way[::-1]]), pressure=0.5)
    dense = draw(Comb(surface, none_on(surface), Brush(0.15)), way, pressure=0.5, radius=0.05)
    inside = np.abs(surface.positions[:, 0] - 0.5) < 0.25  # where the ends' dabs lie is another matter
    for other in (twice, dense):
        strengths = np.linalg.norm(other, axis=1), np.linalg.norm(once, axis=1)
        assert strengths[0][inside] == pytest.approx(strengths[1][inside], abs=0.03)
    assert np.linalg.norm(once, axis=1).max() == pytest.approx(0.5, abs=0.01)


def test_a_new_stroke_over_an_old_one_replaces_it_as_far_as_it_is_strong():
    surface = surface_of(grid(30, 30))
    old = np.tile([np.cos(0.3), np.sin(0.3), 0], (len(surface.positions), 1))
    guides = draw(Comb(surface, old, Brush(0.2)), line_to((0.1, 0.5, 0), (0.9, 0.5, 0)))
    x, y = surface.positions[:, 0], surface.positions[:, 1]
    on = (np.abs(y - 0.5) < 0.02) & (x > 0.2) & (x < 0.8)
    angle = np.degrees(np.arctan2(guides[:, 1], guides[:, 0]))
    assert np.abs(angle[on]).max() < 2
    assert (guides[np.abs(y - 0.5) > 0.2] == old[np.abs(y - 0.5) > 0.2]).all()
    across = (x > 0.45) & (x < 0.55)
    order = np.argsort(np.abs(y[across] - 0.5))
    assert (np.diff(angle[across][order]) > -1).all()  # from the stroke's direction to the old one, without a detour


def test_quarter_turns_of_what_was_there_make_no_difference():
    surface = surface_of(grid(20, 20))
    old = np.tile([np.cos(0.3), np.sin(0.3), 0], (len(surface.positions), 1))
    turned = np.stack([-old[:, 1], old[:, 0], old[:, 2]], axis=1)
    way = line_to((0.1, 0.5, 0), (0.9, 0.5, 0))
    first = draw(Comb(surface, old, Brush(0.3)), way, pressure=0.6)
    second = draw(Comb(surface, turned, Brush(0.3)), way, pressure=0.6)
    touched = (first != old).any(axis=1)
    assert touched.sum() > 50 and first[touched] == pytest.approx(second[touched])


def test_both_sides_of_a_thin_sheet_are_painted_apart():
    vertices, faces = grid(20, 20)
    count = len(vertices)
    both = np.concatenate([vertices, vertices - [0, 0, 0.02]]), np.concatenate([faces, faces[:, ::-1] + count])
    surface = surface_of(both)
    guides = draw(Comb(surface, none_on(surface), Brush(0.2)), line_to((0.2, 0.5, 0.01), (0.8, 0.5, 0.01)))
    assert guides[:count].any() and not guides[count:].any()


@pytest.mark.parametrize("of_faces", [False, True])
def test_a_brush_finer_than_the_mesh_still_acts_where_it_passes(of_faces):
    surface = surface_of(grid(4, 4), of_faces)
    guides = draw(Comb(surface, none_on(surface), Brush(0.01)), line_to((0.3, 0.4, 0), (0.7, 0.4, 0), 500))
    strength = np.linalg.norm(guides, axis=1)
    assert 2 <= (strength > 0.1).sum() < len(strength) / 2
    assert (strength[np.abs(surface.positions[:, 1] - 0.4) > 0.26] == 0).all()


def test_erasing_takes_away_and_nothing_else():
    surface = surface_of(grid(30, 30))
    old = np.tile([0.6, 0.0, 0.0], (len(surface.positions), 1))
    way = line_to((0.1, 0.5, 0), (0.9, 0.5, 0))
    away = np.abs(surface.positions[:, 1] - 0.5)
    inside = (surface.positions[:, 0] > 0.2) & (surface.positions[:, 0] < 0.8)
    left = draw(Erase(surface, old, Brush(0.2, "constant")), way)
    assert not left[(away < 0.19) & inside].any() and (left[away > 0.2] == old[away > 0.2]).all()
    half = draw(Erase(surface, old, Brush(0.2, "constant")), way, pressure=0.5)
    assert half[(away < 0.19) & inside] == pytest.approx(0.5 * old[(away < 0.19) & inside])


def test_a_click_without_a_way_erases_but_combs_nothing():
    surface = surface_of(grid(30, 30))
    old = np.tile([0.6, 0.0, 0.0], (len(surface.positions), 1))
    assert not draw(Erase(surface, old, Brush(0.2)), [(0.5, 0.5, 0)]).all()
    assert not draw(Comb(surface, none_on(surface), Brush(0.2)), [(0.5, 0.5, 0)]).any()


@pytest.mark.parametrize("of_faces", [False, True])
def test_smoothing_evens_directions_out_and_keeps_their_strength(of_faces):
    surface = surface_of(torus(60, 30), of_faces)
    around = np.cross([0, 0, 1], surface.positions)
    around /= np.linalg.norm(around, axis=1)[:, None]
    random = np.random.default_rng(4)
    angle = random.normal(0, 0.25, len(around))[:, None]
    noisy = np.cos(angle) * around + np.sin(angle) * np.cross(surface.normals, around)
    turn = np.linspace(0, 2 * np.pi, 400)
    ring = 1.4 * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    even = draw(SmoothDirections(surface, noisy, Brush(0.3)), ring)
    outside = np.linalg.norm(surface.positions[:, :2], axis=1) > 1.35
    before, after = (degrees_between_crosses(field[outside], around[outside]) for field in (noisy, even))
    assert np.median(after) < 0.35 * np.median(before)
    assert np.linalg.norm(even[outside], axis=1) == pytest.approx(1, abs=1e-3)
    inside = np.linalg.norm(surface.positions[:, :2], axis=1) < 1.0
    assert (even[inside] == noisy[inside]).all()


def test_densities_are_multiplied_and_divided_within_bounds():
    surface = surface_of(grid(20, 20))
    way = line_to((0.2, 0.5, 0), (0.8, 0.5, 0))
    denser = draw(Shift(surface, np.zeros(len(surface.positions)), Brush(0.2), np.log(2), LOG_BOUNDS), way)
    assert np.exp(denser.max()) == pytest.approx(2, rel=0.01) and denser.min() == 0
    back = draw(Shift(surface, denser, Brush(0.2), -np.log(2), LOG_BOUNDS), way)
    assert back == pytest.approx(0, abs=1e-12)
    for _ in range(9):
        denser = draw(Shift(surface, denser, Brush(0.2), np.log(2), LOG_BOUNDS), way)
    assert np.exp(denser.max()) == pytest.approx(10)


def test_smoothing_numbers_lowers_steps_and_keeps_what_is_even():
    surface = surface_of(grid(30, 30))
    step = (surface.positions[:, 0] > 0.5).astype(float)
    even = draw(SmoothNumbers(surface, step, Brush(0.3)), line_to((0.5, 0.2, 0), (0.5, 0.8, 0)))
    starts, others = surface.neighbors
    first = np.repeat(np.arange(len(step)), np.diff(starts))
    middle = np.abs(surface.positions[first, 1] - 0.5) < 0.1
    assert np.abs(even[first] - even[others])[middle].max() < 0.5
    assert even.min() >= 0 and even.max() <= 1
    flat = draw(SmoothNumbers(surface, np.full(len(step), 0.7), Brush(0.3)), line_to((0.5, 0.2, 0), (0.5, 0.8, 0)))
    assert flat == pytest.approx(0.7)


def test_neighbors_are_those_across_edges_of_polygons_of_any_size():
    polygons = as_polygons([(0, 1, 2, 3), (3, 2, 4)])
    vertices = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 2, 0)], float)
    starts, others = BrushSurface(vertices, polygons).neighbors
    assert [sorted(others[a:b]) for a, b in itertools.pairwise(starts)] == [
        [1, 3],
        [0, 2],
        [1, 3, 4],
        [0, 2, 4],
        [2, 3],
    ]
    starts, others = BrushSurface(vertices, polygons, of_faces=True).neighbors
    assert starts.tolist() == [0, 1, 2] and others.tolist() == [1, 0]


def test_a_drawn_line_is_even_smooth_and_closed_where_its_ends_meet():
    turn = np.linspace(0, 2 * np.pi - 0.05, 700)
    random = np.random.default_rng(1)
    circle = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1) + random.normal(0, 0.003, (700, 3))
    line = drawn_line(circle, 0.05, 0.1)
    assert line.is_closed
    steps = np.linalg.norm(line.points - np.roll(line.points, -1, axis=0), axis=1)
    assert steps.max() < 2 * steps.min()
    assert np.abs(np.linalg.norm(line.points, axis=1) - 1).max() < 0.01
    half = drawn_line(circle[:350], 0.05, 0.1)
    assert not half.is_closed and half.points[[0, -1]] == pytest.approx(circle[[0, 349]])
    assert drawn_line(circle[:3], 0.05, 0.1) is None


def test_erasing_cuts_lines():
    line = Line(line_to((0, 0, 0), (1, 0, 0), 101), False)
    center = np.array([[0.5, 0, 0]])
    left, right = erased([line], center, 0.105)[0]
    assert left.points[-1, 0] == pytest.approx(0.39) and right.points[0, 0] == pytest.approx(0.61)
    assert erased([line], center + 5, 0.1)[0] == [line]
    turn = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    circle = Line(np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1), True)
    (opened,) = erased([circle], np.array([[0, 1, 0]]), 0.2)[0]
    assert not opened.is_closed and np.linalg.norm(opened.points - (0, 1, 0), axis=1).min() >= 0.2
    assert np.linalg.norm(np.diff(opened.points, axis=0), axis=1).max() < 0.07
    assert erased([circle], np.zeros((1, 3)), 2)[0] == []


def test_smoothing_straightens_lines_near_the_brush():
    points = line_to((0, 0, 0), (1, 0, 0), 51)
    points[:, 1] += 0.02 * (-1) ** np.arange(51)
    even = smoothed(Line(points, False), np.array([[0.5, 0, 0]]), Brush(0.2), 1.0)
    assert np.abs(even.points[24:27, 1]).max() < 0.005
    assert (even.points[[0, -1]] == points[[0, -1]]).all() and (even.points[:10] == points[:10]).all()
    line = Line(points, False)
    assert smoothed(line, np.array([[5.0, 0, 0]]), Brush(0.2), 1.0) is line


def test_density_from_layers_is_even_in_factors_and_in_what_is_seen():
    assert density_between(0.5, 2.0, np.array([0, 0.5, 1.0, 7])) == pytest.approx([0.5, 1, 2, 2])
    grey = np.repeat([[0.0], [0.2140], [1.0]], 3, axis=1)
    assert brightness(grey) == pytest.approx([0, 0.5, 1], abs=1e-3)
    assert log_density(np.array([0.0, 1, np.nan, 1e9])) == pytest.approx([0, 0, 0, np.log(10)])


def test_polygons_without_area_do_no_harm():
    vertices, faces = grid(10, 10)
    polygons = as_polygons(np.concatenate([faces, [[0, 0, 1]]]))
    surface = BrushSurface(vertices, Polygons(*polygons))
    guides = draw(Comb(surface, none_on(surface), Brush(0.2)), line_to((0, 0.05, 0), (0.8, 0.05, 0)))
    assert np.isfinite(guides).all() and guides.any()
