"""Results that are exactly their own mirror images."""

from pathlib import Path

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.validation import scaled_jacobian, topology, violations
from support import surfaces
from support.mirroring import assert_mirrored, assert_seam
from support.results import assert_sound

HERE = Path(__file__).resolve().parents[1] / "data" / "meshes"
COLLECTION = Path(__file__).resolve().parents[3] / "shared" / "meshes" / "dev"


def centred(surface):
    vertices, faces = surface
    return vertices - 0.5 * (vertices.min(axis=0) + vertices.max(axis=0)), faces


SURFACES = {
    "sphere": surfaces.sphere(10),
    "torus": surfaces.torus(),
    "box": centred(surfaces.box(8)),
    "flat_box": centred(surfaces.box(8, (3.0, 2.0, 0.2))),
    "grid": centred(surfaces.grid(20, 15, 2.0, 1.5)),
    "annulus": surfaces.annulus(),
    "cylinder": centred(surfaces.cylinder()),
    "mirrored_bodies": surfaces.together(surfaces.sphere(6), surfaces.sphere(6), gap=3.0),
}
SURFACES["mirrored_bodies"] = centred(SURFACES["mirrored_bodies"])


@pytest.mark.parametrize("planes", ["x", "xy"])
@pytest.mark.parametrize("name", SURFACES)
def test_every_topology_is_mirrored_exactly(name, planes):
    vertices, faces = SURFACES[name]
    result = hybrid_quad.remesh(vertices, faces, quads=400, symmetry=planes)
    assert_sound(result, faces)
    for letter in planes:
        assert_mirrored(result.vertices, result.quads, "xyz".index(letter))
        assert_seam(result.vertices, result.quads, "xyz".index(letter))
    assert result.report["symmetry"]["planes"] == planes
    assert max(result.report["symmetry"]["deviation_percent"][letter]["max"] for letter in planes) < 1
    assert scaled_jacobian(result.vertices, result.quads).mean() > 0.8


@pytest.mark.parametrize("name", ["sphere", "torus", "flat_box"])
def test_three_planes(name):
    vertices, faces = SURFACES[name]
    result = hybrid_quad.remesh(vertices, faces, quads=800, symmetry="auto")
    assert_sound(result, faces)
    assert result.report["symmetry"]["planes"] == "xyz"
    for axis in range(3):
        assert_mirrored(result.vertices, result.quads, axis)
        assert assert_seam(result.vertices, result.quads, axis) >= 8


@pytest.mark.parametrize("sharp_angle", [40.0, None], ids=["sharp", "no_sharp"])
@pytest.mark.parametrize("quads", [500, 2000])
def test_spot(quads, sharp_angle):
    vertices, faces = read_mesh(HERE / "c3d_spot_triangulated.obj")
    result = hybrid_quad.remesh(vertices, faces, quads=quads, sharp_angle=sharp_angle, symmetry="auto")
    assert_sound(result, faces)
    assert result.report["symmetry"]["planes"] == "x"
    assert_mirrored(result.vertices, result.quads, 0)
    assert assert_seam(result.vertices, result.quads, 0) > 20
    assert abs(len(result.quads) / quads - 1) <= 0.1


@pytest.mark.parametrize("sharp_angle", [40.0, None], ids=["sharp", "no_sharp"])
def test_suzanne_about_the_middle_of_her_box(sharp_angle):
    vertices, faces = read_mesh(HERE / "c3d_suzanne.obj")
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    result = hybrid_quad.remesh(vertices - middle, faces, quads=1000, sharp_angle=sharp_angle, symmetry="auto")
    assert violations(result.vertices, result.quads) == []
    assert result.report["symmetry"]["planes"] == "x"
    assert_mirrored(result.vertices, result.quads, 0)
    assert assert_seam(result.vertices, result.quads, 0) > 20
    # The same without moving her first, rounded once.
    moved = hybrid_quad.remesh(
        vertices, faces, quads=1000, sharp_angle=sharp_angle, symmetry="x", symmetry_center="bounds"
    )
    assert np.array_equal(moved.quads, result.quads)
    assert np.array_equal(moved.vertices, result.vertices + middle)


@pytest.mark.skipif(not COLLECTION.exists(), reason="no collection of meshes beside the repository")
@pytest.mark.parametrize("sharp_angle", [40.0, None], ids=["sharp", "no_sharp"])
def test_a_scan_that_is_only_nearly_symmetric(sharp_angle):
    vertices, faces = read_mesh(COLLECTION / "dir_camelhead.obj")
    result = hybrid_quad.remesh(vertices, faces, quads=2000, sharp_angle=sharp_angle, symmetry="x")
    assert_sound(result, faces)
    assert_mirrored(result.vertices, result.quads, 0)
    assert_seam(result.vertices, result.quads, 0)
    assert 0.5 < result.report["symmetry"]["deviation_percent"]["x"]["max"] < 3
    assert hybrid_quad.remesh(vertices, faces, quads=500, symmetry="auto").report["symmetry"]["planes"] == ""


def test_auto_changes_nothing_where_nothing_is_symmetric():
    vertices, faces = read_mesh(HERE / "c3d_fandisk.obj")
    vertices = vertices - vertices.mean(axis=0)
    usual = hybrid_quad.remesh(vertices, faces, quads=500)
    result = hybrid_quad.remesh(vertices, faces, quads=500, symmetry="auto")
    assert result.report["symmetry"]["planes"] == ""
    assert min(plane["max"] for plane in result.report["symmetry"]["deviation_percent"].values()) > 1
    assert np.array_equal(result.vertices, usual.vertices)
    assert usual.report["symmetry"] == {"planes": "", "deviation_percent": {}}


def test_half_a_surface_becomes_a_whole_one():
    vertices, faces = surfaces.cylinder()
    vertices -= [0, 0, vertices[:, 2].min()]  # stands on z = 0 with an open end
    result = hybrid_quad.remesh(vertices, faces, quads=400, symmetry="z")
    assert violations(result.vertices, result.quads) == []
    assert_mirrored(result.vertices, result.quads, 2)
    assert topology(result.quads) == topology(faces)
    assert result.vertices[:, 2].min() == pytest.approx(-3)


@pytest.mark.parametrize(("shift", "code"), [((3, 0, 0), "symmetry_plane_missed"), ((-3, 0, 0), "symmetry_side_empty")])
def test_a_plane_beside_the_surface_is_refused(shift, code):
    vertices, faces = surfaces.torus()
    with pytest.raises(hybrid_quad.InputError) as caught:
        hybrid_quad.remesh(vertices + np.array(shift, float), faces, quads=200, symmetry="x")
    assert caught.value.code == code


def test_marked_edges_are_mirrored():
    vertices, faces = surfaces.grid(20, 20, 2.0, 2.0)
    vertices -= [1.0, 0.0, 0.0]
    positive = [(21 * row + 15, 21 * (row + 1) + 15) for row in range(20)]  # x = 0.5, and across it y = 1
    across = [(21 * 10 + column, 21 * 10 + column + 1) for column in range(20)]
    result = hybrid_quad.remesh(
        vertices, faces, quads=300, sharp_angle=None, sharp_edges=positive + across, symmetry="x"
    )
    assert_sound(result, faces)
    assert_mirrored(result.vertices, result.quads, 0)
    middles = result.vertices[result.feature_edges].mean(axis=1)
    inner = middles[(abs(abs(middles) - 1) > 1e-9)[:, 0] & (abs(middles[:, 1] - 1) < 0.999)]
    on_lines = (abs(abs(inner[:, 0]) - 0.5) < 1e-9) | (abs(inner[:, 1] - 1) < 1e-9)
    assert on_lines.all(), "the smooth seam is no feature"
    assert {0.5, -0.5} <= set(np.round(inner[:, 0], 9))


def test_density_comes_along():
    vertices, faces = surfaces.sphere(12)
    density = np.where(vertices[:, 2] > 0, 2.0, 1.0)
    result = hybrid_quad.remesh(vertices, faces, quads=1200, density=density, symmetry="x")
    assert_sound(result, faces)
    assert_mirrored(result.vertices, result.quads, 0)
    corners = result.vertices[result.quads]
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean(axis=1)
    high, low = corners[:, :, 2].mean(axis=1) > 0.5, corners[:, :, 2].mean(axis=1) < -0.5
    assert lengths[low].mean() / lengths[high].mean() == pytest.approx(2, rel=0.25)


@pytest.mark.parametrize("of_faces", [False, True])
def test_guides_come_along(of_faces):
    # The border and the seam ask for edges along the axes; a spot on the positive side asks for them turned by 30 degrees.
    vertices, faces = surfaces.grid(40, 40, 4.0, 4.0)
    vertices -= [2.0, 2.0, 0.0]
    places = vertices[faces].mean(axis=1) if of_faces else vertices
    in_spot = np.linalg.norm(places[:, :2] - [1.0, 0.0], axis=1, keepdims=True) < 0.5
    guides = np.where(in_spot, [np.cos(np.radians(30)), np.sin(np.radians(30)), 0.0], 0.0)
    result = hybrid_quad.remesh(vertices, faces, quads=2000, guides=guides, symmetry="x")
    assert_sound(result, faces)
    assert_mirrored(result.vertices, result.quads, 0)
    corners = result.vertices[result.quads]
    middles, sides = corners.mean(axis=1), corners - np.roll(corners, 1, axis=1)
    angles = np.degrees(np.arctan2(sides[..., 1], sides[..., 0])) % 90
    for x, angle in ((1.0, 30), (-1.0, 60)):
        inside = np.linalg.norm(middles[:, :2] - [x, 0.0], axis=1) < 0.3
        assert inside.sum() > 10
        assert abs(np.median(angles[inside]) - angle) < 10
