"""Corners of faces that lie across a cut belong to one side of it."""

from __future__ import annotations

import numpy as np
import pytest

from hybrid_quad.core.corner_fans import fans_of_corners
from hybrid_quad.core.influences import with_fewer_influences
from hybrid_quad.core.mesh_arrays import Polygons
from hybrid_quad.core.surface_places import Places, TriangleMesh, places_in, weights_in
from hybrid_quad.core.surface_points import nearest_on_surface
from hybrid_quad.core.surface_walk import SurfaceWalk

AROUND, ALONG = 24, 12


def tube(is_split: bool) -> tuple[TriangleMesh, np.ndarray]:
    """A tube around z, and a map of it (angle and height at every corner) that is cut once, at angle 0.

    With `is_split` the cut has vertices of its own on either side, as in models that come from games.
    """
    columns = AROUND + 1 if is_split else AROUND
    angle = 2 * np.pi * np.arange(columns) / AROUND
    angle[AROUND:] = 0.0  # exactly where the first column is
    height = np.linspace(0, 3, ALONG + 1)
    points = np.array([(np.cos(a), np.sin(a), z) for z in height for a in angle])
    triangles, corners = [], []
    for row in range(ALONG):
        for col in range(AROUND):
            a, b = row * columns + col, row * columns + (col + 1) % columns
            quad = (a, b, b + columns, a + columns)
            places = [(col, row), (col + 1, row), (col + 1, row + 1), (col, row + 1)]
            for pick in ((0, 1, 2), (0, 2, 3)):
                triangles.append([quad[i] for i in pick])
                corners += [places[i] for i in pick]
    count = len(triangles)
    mesh = TriangleMesh(points, np.array(triangles), np.arange(3 * count).reshape(-1, 3), np.arange(count))
    return mesh, np.array(corners, float) * (2 * np.pi / AROUND, 3 / ALONG)


def places_on(mesh: TriangleMesh, points: np.ndarray) -> Places:
    return places_in(points, mesh, nearest_on_surface(points, mesh.points, mesh.vertices).triangles)


def on_tube(angle, height) -> np.ndarray:
    return np.stack([np.cos(angle), np.sin(angle), np.broadcast_to(height, np.shape(angle))], axis=-1)


@pytest.mark.parametrize("is_split", [False, True])
def test_a_face_across_the_only_seam_of_an_island_stays_on_one_side(is_split):
    mesh, places = tube(is_split)
    walk = SurfaceWalk(mesh)
    walls = walk.walls(places, 1e-6)
    assert walls.sum() == 2 * ALONG
    for middle in (0.1, -0.1):
        angle = middle + np.array([-0.25, 0.25, 0.25, -0.25])
        points = on_tube(angle, np.array([1.0, 1.0, 1.5, 1.5]))
        corners = walk.corner_places(
            walls, places_on(mesh, on_tube([middle], 1.25)), points[None], np.arange(4)[None], places_on(mesh, points)
        )
        values = corners.values(mesh.corners, places, is_extended=True)
        expected = angle if middle > 0 else angle + 2 * np.pi
        assert np.allclose(values[:, 0], expected, atol=0.02)
        assert np.allclose(values[:, 1], [1.0, 1.0, 1.5, 1.5], atol=1e-6)
        inside = corners.values(mesh.corners, places, is_extended=False)
        assert inside[:, 0].min() > -1e-9 and inside[:, 0].max() < 2 * np.pi + 1e-9


def folded(angle: float) -> tuple[TriangleMesh, np.ndarray]:
    """Two squares that meet at a fold along y, each an island that is its own plane to scale."""
    away = np.array([-np.cos(angle), 0, np.sin(angle)])
    points = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), away, away + np.array([0, 1, 0])])
    triangles = np.array([(0, 1, 2), (0, 2, 3), (4, 0, 3), (4, 3, 5)])
    places = np.array(
        [(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1), (9, 0), (10, 0), (10, 1), (9, 0), (10, 1), (9, 1)], float
    )
    return TriangleMesh(points, triangles, np.arange(12).reshape(4, 3), np.arange(4)), places


@pytest.mark.parametrize("angle", [0.0, 1.0, 2.0, 3.0])
def test_beyond_a_fold_nothing_is_stretched(angle):
    """Neither a face whose corners lie across the fold, nor two that share them; and these do not come apart."""
    mesh, places = folded(angle)
    walk = SurfaceWalk(mesh)
    walls = walk.walls(places, 1e-6)
    assert walls.sum() == 2 and len(np.unique(walk.islands(walls))) == 2
    out = 0.2 * mesh.points[4]
    points = np.array(
        [
            (0.3, 0.2, 0),
            (0.3, 0.5, 0),
            *(out + np.array([(0, 0.5, 0), (0, 0.2, 0)])),
            (0.3, 0.8, 0),
            out + np.array([0, 0.8, 0]),
        ]
    )
    faces = np.array([(0, 1, 2, 3), (1, 4, 5, 2)])
    middles = places_on(mesh, np.array([(0.05, 0.35, 0), (0.05, 0.65, 0)]))
    unbounded = places_on(mesh, points)
    corners = walk.corner_places(walls, middles, points[faces], faces, unbounded.among(faces.ravel()))
    assert sorted(corners.beyond) == [2, 3, 6, 7]
    values = corners.values(mesh.corners, places, is_extended=True).reshape(2, 4, 2)
    assert np.allclose(values[0, 2], values[1, 3])
    assert np.allclose(values[0, 2], (out[0], 0.5))
    on_surface = np.linalg.norm(np.roll(points[faces], -1, axis=1) - points[faces], axis=2)
    assert (np.linalg.norm(np.roll(values, -1, axis=1) - values, axis=2) <= on_surface + 1e-12).all()


def test_a_narrow_face_along_a_bent_wall_stays_on_the_side_of_its_corners():
    """A disc and a ring around it, an island each: the middle of a narrow face of the ring is over the disc."""
    angle = 2 * np.pi * np.arange(AROUND) / AROUND
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(AROUND)], axis=1)
    points = np.concatenate([np.zeros((1, 3)), circle, 2 * circle])
    inner = 1 + np.arange(AROUND)
    following = 1 + (np.arange(AROUND) + 1) % AROUND
    disc = np.stack([np.zeros(AROUND, int), inner, following], axis=1)
    ring = np.concatenate(
        [
            np.stack([inner, inner + AROUND, following + AROUND], axis=1),
            np.stack([inner, following + AROUND, following], axis=1),
        ]
    )
    triangles = np.concatenate([disc, ring])
    mesh = TriangleMesh(points, triangles, np.arange(triangles.size).reshape(-1, 3), np.arange(len(triangles)))
    places = points[triangles][:, :, :2]
    places[AROUND:] += (9, 0)
    walk = SurfaceWalk(mesh)
    walls = walk.walls(places.reshape(-1, 2), 1e-6)
    assert walls.sum() == 2 * AROUND
    face = np.concatenate([circle[[0, 2]], 1.001 * circle[[2, 0]]])
    middle = places_on(mesh, face.mean(axis=0)[None])
    assert middle.triangles[0] < AROUND
    corners = walk.corner_places(walls, middle, face[None], np.arange(4)[None], places_on(mesh, face))
    assert np.allclose(corners.values(mesh.corners, places.reshape(-1, 2), is_extended=True), face[:, :2] + (9, 0))
    # One that lies across the wall goes where its middle is.
    across = np.concatenate([0.99 * circle[[0, 2]], 1.001 * circle[[2, 0]]])
    corners = walk.corner_places(walls, middle, across[None], np.arange(4)[None], places_on(mesh, across))
    assert np.allclose(corners.values(mesh.corners, places.reshape(-1, 2), is_extended=True), across[:, :2])


def test_on_the_border_the_value_is_that_of_the_border():
    mesh, places = folded(1.0)
    bent = places**2  # not linear, so that what goes on from the middle arrives elsewhere
    walk = SurfaceWalk(mesh)
    walls = walk.walls(places, 1e-6)
    points = np.array([(0.3, 0.25, 0), (0.3, 0.75, 0), (0, 0.75, 0), (0, 0.25, 0)])
    beyond = Places(np.full(4, 2), np.array([(0, 0.25, 0.75), (0, 0.25, 0.75), (0, 0.25, 0.75), (0, 0.75, 0.25)]))
    middle = places_on(mesh, np.array([(0.15, 0.5, 0)]))
    corners = walk.corner_places(walls, middle, points[None], np.arange(4)[None], beyond)
    values = corners.values(mesh.corners, bent, is_extended=True)
    assert np.allclose(values[2:], [(0, 0.75), (0, 0.25)])


@pytest.mark.parametrize("height", [0.1, 1e-6, 0.0])
def test_slopes_of_slivers_are_not_followed(height):
    points = np.array([(0, 0, 0), (1, 0, 0), (0.5, height, 0), (9, 9, 9), (9, 9, 8), (9, 8, 9)])
    mesh = TriangleMesh(points, np.array([(0, 1, 2), (3, 4, 5)]), np.arange(6).reshape(2, 3), np.array([0, 1]))
    places = np.array([(0, 0), (1, 0), (0.5, 0.2), (7, 7), (7, 8), (8, 7)])
    face = np.array([(0.4, -0.2, 0), (0.6, -0.2, 0), (0.6, 0.2, 0), (0.4, 0.2, 0)])
    elsewhere = Places(np.full(4, 1), np.full((4, 3), 1 / 3))
    middle = Places(np.array([0]), np.array([(0.5, 0.5, 0)]))
    corners = SurfaceWalk(mesh).corner_places(np.ones((2, 3), bool), middle, face[None], np.arange(4)[None], elsewhere)
    values = corners.values(mesh.corners, places, is_extended=True)
    if height == 0.1:
        assert np.allclose(values, face[:, :2] * (1, 2))
    else:
        assert (values >= 0).all() and (values <= (1, 0.2)).all()


def test_without_walls_nothing_lies_beyond_any():
    mesh, _ = tube(False)
    walk = SurfaceWalk(mesh)
    walls = walk.walls(mesh.points[mesh.vertices].reshape(-1, 3), 1e-6)
    assert not walls.any()
    points = on_tube(np.array([-0.25, 0.25, 0.25, -0.25]), np.array([1.0, 1.0, 1.5, 1.5]))
    unbounded = places_on(mesh, points)
    middle = places_on(mesh, on_tube([0.0], 1.25))
    corners = walk.corner_places(walls, middle, points[None], np.arange(4)[None], unbounded)
    assert len(corners.beyond) == 0
    assert np.array_equal(corners.places.weights, unbounded.weights)


def test_sheets_with_the_same_vertices_twice_are_no_neighbours():
    square = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], float)
    points = np.concatenate([square, square])
    triangles = np.array([(0, 1, 2), (0, 2, 3), (6, 5, 4), (7, 6, 4)])
    mesh = TriangleMesh(points, triangles, np.arange(12).reshape(4, 3), np.arange(4))
    # Every rim has two triangles of opposite orientation, which is how a closed pillow looks: these are neighbours.
    of_sheet = np.repeat([0.0, 1.0], 6)[:, None]
    assert SurfaceWalk(mesh).walls(of_sheet, 1e-6).sum() == 8


def test_weights_give_the_point_back():
    rng = np.random.default_rng(0)
    corners = rng.normal(size=(200, 3, 3))
    weights = rng.dirichlet((1, 1, 1), 200)
    weights[:50, 0] = 0
    weights /= weights.sum(axis=1, keepdims=True)
    points = np.einsum("ki,kid->kd", weights, corners)
    assert np.allclose(weights_in(points, corners), weights, atol=1e-9)
    # A triangle that is a line, and one that is a point.
    corners[0] = [(0, 0, 0), (4, 0, 0), (1, 0, 0)]
    corners[1] = 1.0
    found = weights_in(np.array([(3.0, 0, 0), (1, 1, 1)]), corners[:2])
    assert np.allclose(np.einsum("ki,kid->kd", found, corners[:2]), [(3, 0, 0), (1, 1, 1)])
    assert np.allclose(found.sum(axis=1), 1)


def test_fans_end_at_cuts():
    # Four quads around a vertex.
    quads = [(0, 1, 4, 3), (1, 2, 5, 4), (3, 4, 7, 6), (4, 5, 8, 7)]
    polygons = Polygons(np.full(4, 4, np.int32), np.array(quads, np.int32).ravel())
    corners = np.flatnonzero(polygons.vertices == 4)
    cuts = np.zeros(16, bool)
    assert len(np.unique(fans_of_corners(polygons, cuts)[corners])) == 1
    following = np.arange(16) - np.arange(16) % 4 + (np.arange(16) + 1) % 4
    ends = np.sort(np.stack([polygons.vertices, polygons.vertices[following]], axis=1), axis=1)
    cuts = ((ends == (1, 4)) | (ends == (4, 7))).all(axis=1)
    fans = fans_of_corners(polygons, cuts)[corners]
    assert fans[0] == fans[2] != fans[1] == fans[3]


def test_fewer_influences_keep_the_sum_and_the_largest():
    weights = np.random.default_rng(1).dirichlet(np.ones(6), 100)
    fewer = with_fewer_influences(weights, 3)
    assert ((fewer > 0).sum(axis=1) == 3).all()
    assert np.allclose(fewer.sum(axis=1), weights.sum(axis=1))
    assert (fewer.argmax(axis=1) == weights.argmax(axis=1)).all()
    assert np.array_equal(with_fewer_influences(weights, 6), weights)
