"""The size of a mesh and its place in space make no difference."""

from pathlib import Path

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.validation import topology, violations
from support import surfaces

QUADS = 250
MODELS = Path(__file__).parents[1] / "data" / "meshes"


def dyadic_torus():
    """A torus whose coordinates are short binary fractions: any power of two and any such offset is exact."""
    vertices, faces = surfaces.torus(20, 12)
    return np.round(vertices * 2**12) / 2**12, faces


@pytest.fixture(scope="module")
def usual():
    return hybrid_quad.remesh(*dyadic_torus(), quads=QUADS)


@pytest.mark.parametrize("exponent", [-900, -100, -20, 20])
def test_powers_of_two_give_the_same_bits(usual, exponent):
    vertices, faces = dyadic_torus()
    scale = 2.0**exponent
    result = hybrid_quad.remesh(vertices * scale, faces, quads=QUADS)
    assert np.array_equal(result.quads, usual.quads)
    assert np.array_equal(result.vertices, usual.vertices * scale)
    report, expected = dict(result.report), dict(usual.report)
    for numbers in (report, expected):
        del numbers["stages"]
    assert report == expected


@pytest.mark.parametrize("offset", [(2.0**20, 0.0, 0.0), (-(2.0**20), 2.0**19, 3.0), (1e4, 1e6, -1e6)])
def test_places_give_the_same_quads(usual, offset):
    vertices, faces = dyadic_torus()
    result = hybrid_quad.remesh(vertices + offset, faces, quads=QUADS)
    assert np.array_equal(result.quads, usual.quads)
    assert np.abs(result.vertices - offset - usual.vertices).max() < 1e-9


def test_single_precision_is_enough(usual):
    vertices, faces = dyadic_torus()
    result = hybrid_quad.remesh(vertices.astype(np.float32), faces, quads=QUADS)
    assert np.array_equal(result.vertices, usual.vertices)


def test_edge_lengths_scale_with_the_mesh():
    vertices, faces = dyadic_torus()
    expected = hybrid_quad.remesh(vertices, faces, edge_length=0.25)
    result = hybrid_quad.remesh(vertices * 2.0**-30, faces, edge_length=0.25 * 2.0**-30)
    assert np.array_equal(result.vertices, expected.vertices * 2.0**-30)


@pytest.mark.parametrize("symmetry", ["", "y"])
@pytest.mark.parametrize(("scale", "offset"), [(1e-30, 0.0), (1e6, 0.0), (1e-6, 0.0), (1.0, 1e6), (1e6, 1e6)])
def test_other_scales_and_places_give_as_good_a_mesh(scale, offset, symmetry):
    vertices, faces = surfaces.torus(20, 12)
    moved = (vertices + np.array([offset, 0.0, offset])) * scale  # rounds: single edges may run otherwise
    expected = hybrid_quad.remesh(vertices, faces, quads=QUADS, symmetry=symmetry)
    result = hybrid_quad.remesh(moved, faces, quads=QUADS, symmetry=symmetry)
    assert violations(result.vertices, result.quads) == []
    assert topology(result.quads) == topology(expected.quads)
    assert abs(len(result.quads) / len(expected.quads) - 1) < 0.1
    assert result.report["hausdorff_percent"] < 1.5 * expected.report["hausdorff_percent"] + 0.1


def test_corners_lie_where_the_input_has_them():
    vertices, faces = surfaces.box(4)
    moved = vertices / 3 + np.array([1e5, -7.1, 1 / 3])
    result = hybrid_quad.remesh(moved, faces, quads=QUADS)
    corners = result.vertices[result.vertex_kinds == 2]
    assert len(corners) == 8
    assert all((moved == corner).all(axis=1).any() for corner in corners)


def test_snapshots_are_in_the_units_of_the_caller():
    seen = []
    vertices, faces = surfaces.torus(20, 12)
    moved = 1e-3 * vertices + 5.0
    hybrid_quad.remesh(moved, faces, quads=QUADS, on_snapshot=seen.append)
    for snapshot in seen:
        assert (snapshot.points >= moved.min(axis=0) - 1e-4).all()
        assert (snapshot.points <= moved.max(axis=0) + 1e-4).all()
    lengths = next(s.face_values["target length"] for s in seen if "target length" in s.face_values)
    edge = np.sqrt(4 * np.pi**2 * 0.4 * 1e-6 / QUADS)
    assert edge / 4 < lengths.mean() < 4 * edge


def bumpy_torus():
    """Generic: no two places of it are alike, so that nothing hangs on how a tie is broken."""
    vertices, faces = surfaces.torus(36, 18)
    bumps = np.random.default_rng(5).normal(size=(6, 3))
    return vertices * (1 + 0.04 * np.sin(vertices @ bumps.T + bumps[:, 0]).sum(axis=1, keepdims=True)), faces


def rotation(seed):
    turned, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return turned * np.sign(np.linalg.det(turned))


def other_order(vertices, faces, seed):
    """The same surface with its vertices and faces in another order, each face beginning where it likes."""
    random = np.random.default_rng(seed)
    order = random.permutation(len(vertices))
    place = np.argsort(order)
    turned = np.stack([np.roll(face, random.integers(3)) for face in faces])
    return vertices[order], place[turned][random.permutation(len(faces))]


def distance_between(one, two):
    """Largest distance from a vertex of one to the nearest of the other."""
    gaps = np.linalg.norm(one[:, None] - two[None], axis=2)
    return max(gaps.min(axis=0).max(), gaps.min(axis=1).max())


@pytest.fixture(scope="module")
def usual_bumpy():
    return hybrid_quad.remesh(*bumpy_torus(), quads=QUADS)


@pytest.mark.parametrize("seed", [1, 2])
def test_a_rigid_motion_moves_the_result_along(usual_bumpy, seed):
    vertices, faces = bumpy_torus()
    turn, shift = rotation(seed), np.array([3.0, -2.0, 0.7])
    result = hybrid_quad.remesh(vertices @ turn.T + shift, faces, quads=QUADS)
    assert topology(result.quads) == topology(usual_bumpy.quads)
    assert len(result.quads) == len(usual_bumpy.quads)
    assert distance_between((result.vertices - shift) @ turn, usual_bumpy.vertices) < 1e-6


@pytest.mark.parametrize("seed", [1, 2])
def test_the_order_of_vertices_and_faces_makes_no_difference(usual_bumpy, seed):
    result = hybrid_quad.remesh(*other_order(*bumpy_torus(), seed), quads=QUADS)
    assert np.array_equal(result.quads, usual_bumpy.quads)
    assert np.array_equal(result.vertices, usual_bumpy.vertices)


def model(name):
    vertices, polygons = read_mesh(MODELS / f"{name}.obj")
    return vertices, np.asarray(polygons.vertices).reshape(-1, 3)


@pytest.mark.parametrize("sharp_angle", [40.0, None])
@pytest.mark.parametrize("name", ["c3d_spot_triangulated", "c3d_fandisk"])
def test_the_order_makes_no_difference_to_models(name, sharp_angle):
    vertices, faces = model(name)
    usual = hybrid_quad.remesh(vertices, faces, quads=600, sharp_angle=sharp_angle)
    result = hybrid_quad.remesh(*other_order(vertices, faces, 3), quads=600, sharp_angle=sharp_angle)
    assert np.array_equal(result.quads, usual.quads)
    assert np.array_equal(result.vertices, usual.vertices)


@pytest.mark.parametrize("sharp_angle", [40.0, None])
def test_a_model_turns_with_its_result(sharp_angle):
    vertices, faces = model("c3d_spot_triangulated")
    vertices = vertices * (1 + 0.03 * np.sin(vertices @ [3.0, 1.0, 2.0]))[:, None]  # its two halves are alike otherwise
    usual = hybrid_quad.remesh(vertices, faces, quads=1000, sharp_angle=sharp_angle)
    turn = rotation(4)
    result = hybrid_quad.remesh(vertices @ turn.T, faces, quads=1000, sharp_angle=sharp_angle)
    assert np.array_equal(result.quads, usual.quads)
    assert np.abs(result.vertices @ turn - usual.vertices).max() < 1e-7 * np.ptp(vertices)
    followed = usual.report["repairs"]["followed_creases"]
    assert followed > 0 if sharp_angle else followed == 0


def dirty_sheet():
    """Rectangles, of which either diagonal is as good, faces the wrong way round, a copy, a face without area."""
    n = 7
    x, y = np.meshgrid(np.arange(n + 1) / n, np.arange(n + 1) / n)
    vertices = np.stack([x.ravel(), 0.8 * y.ravel() ** 1.3, 0.2 * x.ravel() ** 2], axis=1)
    corners = [j * (n + 1) + i for j in range(n) for i in range(n)]
    faces = [[a, a + 1, a + n + 2, a + n + 1] for a in corners]
    faces[3], faces[9] = faces[3][::-1], faces[9][::-1]
    a, b, c, d = faces.pop(20)
    vertices = np.vstack([vertices, (vertices[a] + vertices[b]) / 2])
    middle = len(vertices) - 1
    faces += [[a, middle, c, d], [middle, b, c], [a, b, middle], list(faces[5])]
    return vertices, faces


def test_the_order_of_a_dirty_file_with_wishes_makes_no_difference():
    vertices, faces = dirty_sheet()
    density = np.exp(np.sin(vertices @ [5.0, 3.0, 2.0]))
    guides = np.cross(vertices - [0.5, 0.4, 0.1], [0.3, 0.2, 1.0])
    marks = [(faces[0][0], faces[0][1]), (faces[10][1], faces[10][2])]

    def remeshed(order, shuffled_faces):
        place = np.argsort(order)
        return hybrid_quad.remesh(
            vertices[order],
            shuffled_faces,
            quads=QUADS,
            density=density[order],
            guides=guides[order],
            sharp_edges=[(int(place[a]), int(place[b])) for a, b in marks],
        )

    usual = remeshed(np.arange(len(vertices)), faces)
    for seed in (1, 2):
        random = np.random.default_rng(seed)
        order = random.permutation(len(vertices))
        place = np.argsort(order)
        mixed = [np.roll(place[faces[i]], random.integers(4)).tolist() for i in random.permutation(len(faces))]
        result = remeshed(order, mixed)
        assert np.array_equal(result.quads, usual.quads)
        assert np.array_equal(result.vertices, usual.vertices)
