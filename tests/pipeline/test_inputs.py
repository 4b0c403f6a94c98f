"""Meshes that are no surface, and those that only look like none."""

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.core.validation import violations
from support import surfaces
from support.results import assert_sound

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def with_vertex(value):
    vertices, faces = surfaces.torus(12, 8)
    vertices = vertices.copy()
    vertices[17, 1] = value
    return vertices, faces


REFUSED = {
    "empty_mesh": ([], []),
    "empty_mesh (points only)": (TRIANGLE, []),
    "index_out_of_range": (TRIANGLE, [[0, 1, 7]]),
    "index_out_of_range (negative)": (TRIANGLE, [[0, 1, -1]]),
    "non_finite_vertex": with_vertex(np.nan),
    "non_finite_vertex (infinite)": with_vertex(np.inf),
    "no_area": (np.zeros((4, 3)), [[0, 1, 2], [0, 2, 3]]),
    "non_orientable": surfaces.moebius(),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_remeshed_is_refused_by_code(name):
    with pytest.raises(hybrid_quad.InputError) as caught:
        hybrid_quad.remesh(*REFUSED[name], quads=100)
    assert caught.value.code == name.split(" ")[0]
    assert str(caught.value)


def test_the_offending_elements_are_named():
    vertices, faces = with_vertex(np.nan)
    with pytest.raises(hybrid_quad.InputError) as caught:
        hybrid_quad.remesh(vertices, faces)
    assert (caught.value.element_kind, caught.value.elements) == ("vertex", (17,))


def test_a_marked_pair_that_is_no_edge():
    vertices, faces = surfaces.grid(5, 5)
    with pytest.raises(hybrid_quad.InputError) as caught:
        hybrid_quad.remesh(vertices, faces, sharp_edges=[[0, 20]])
    assert caught.value.code == "unknown_edge"
    assert (caught.value.element_kind, caught.value.elements) == ("edge", (0, 20))


@pytest.mark.parametrize("edges", [[[0, 10**6]], [[-1, 0]]])
def test_marked_pairs_of_vertices_that_do_not_exist(edges):
    vertices, faces = surfaces.grid(5, 5)
    with pytest.raises(hybrid_quad.InputError, match="no edge"):
        hybrid_quad.remesh(vertices, faces, sharp_edges=edges)


def test_a_length_that_would_take_too_many_quads():
    with pytest.raises(hybrid_quad.InputError) as caught:
        hybrid_quad.remesh(*surfaces.torus(), edge_length=1e-6)
    assert caught.value.code == "too_many_quads"


def test_lengths_at_the_ends_of_what_numbers_can_be():
    with pytest.raises(hybrid_quad.InputError) as caught:
        hybrid_quad.remesh(*surfaces.box(1), edge_length=1e-200)
    assert caught.value.code == "too_many_quads"
    assert len(hybrid_quad.remesh(*surfaces.box(1), edge_length=1e300).quads) >= 6


def fin():
    vertices, faces = surfaces.sphere(5)
    a, b = faces[0, :2]
    tip = vertices[[a, b]].mean(0) * 1.3
    return np.concatenate([vertices, [tip]]), np.concatenate([faces, [[a, b, len(vertices)]]])


def some_faces_turned():
    vertices, faces = surfaces.torus(16, 10)
    faces = faces.copy()
    faces[::3] = faces[::3, ::-1]
    return vertices, faces


def two_bodies_at_one_vertex():
    vertices, faces = surfaces.sphere(4)
    other = np.where(faces > 0, faces + len(vertices) - 1, 0)
    return np.concatenate([vertices, 2 * vertices[0] - vertices[1:]]), np.concatenate([faces, other])


def unused_vertices():
    vertices, faces = surfaces.sphere(4)
    return np.concatenate([vertices, np.full((20, 3), 50.0)]), faces


def faces_twice():
    vertices, faces = surfaces.sphere(4)
    return vertices, np.concatenate([faces, faces[:5]])


def unwelded():
    vertices, faces = surfaces.sphere(4)
    return vertices[faces].reshape(-1, 3), np.arange(3 * len(faces)).reshape(-1, 3)


def unrolled():
    return surfaces.unrolled_sphere()


def joined_inside_out():
    """A sphere with a tube inside, from one face to another, whose second end is the wrong way round."""
    vertices, faces = surfaces.sphere(12)
    a, b = faces[0], faces[len(faces) // 2]
    tube = [face for i, j in ((0, 1), (1, 2), (2, 0)) for face in ((a[i], a[j], b[j]), (a[i], b[j], b[i]))]
    return vertices, np.concatenate([np.delete(faces, [0, len(faces) // 2], axis=0), tube])


REPAIRED = {
    made.__name__: made
    for made in (
        fin,
        some_faces_turned,
        two_bodies_at_one_vertex,
        unused_vertices,
        faces_twice,
        unwelded,
        unrolled,
        joined_inside_out,
    )
}


@pytest.mark.parametrize("name", REPAIRED)
def test_what_can_be_repaired_gives_valid_quads_and_is_reported(name):
    vertices, faces = REPAIRED[name]()
    result = hybrid_quad.remesh(vertices, faces, quads=200)
    assert violations(result.vertices, result.quads) == []
    assert result.report["defects"]
    for defect in result.report["defects"]:
        assert defect["code"]
        assert defect["repairable"]


@pytest.mark.parametrize("name", REPAIRED)
def test_check_names_what_remesh_repairs(name):
    defects = hybrid_quad.check(*REPAIRED[name]())
    assert defects
    assert all(defect.repairable and defect.remedy for defect in defects)


@pytest.mark.parametrize("name", REFUSED)
def test_check_names_what_remesh_refuses(name):
    defects = hybrid_quad.check(*REFUSED[name])
    assert name.split(" ")[0] in [defect.code for defect in defects if not defect.repairable]


@pytest.mark.parametrize("mesh", [surfaces.torus(), surfaces.grid(3, 3), surfaces.mixed_polygons()], ids=len)
def test_check_finds_nothing_wrong_with_a_sound_mesh(mesh):
    assert hybrid_quad.check(*mesh) == []


@pytest.mark.parametrize("single", [False, True])
def test_spheres_made_from_angles_have_no_poles_and_no_seam(single):
    result = hybrid_quad.remesh(*surfaces.unrolled_sphere(single=single), quads=500)
    assert_sound(result, surfaces.sphere()[1])
    assert result.report["irregular_vertices"] == 8
    assert result.report["scaled_jacobian"]["min"] > 0.8
    gone = {code: count for d in result.report["defects"] for code, count in [(d["code"], len(d["elements"]))]}
    assert gone["pinhole"] == 2 * 31, "all vertices of both poles but one each"


@pytest.mark.parametrize("faces", [[[0, 1, 2]], [[0, 1, 2], [1, 3, 2]]])
def test_the_smallest_surfaces(faces):
    vertices = np.array([*TRIANGLE, [1, 1, 0]], float)[: 2 + len(faces)]
    assert_sound(hybrid_quad.remesh(vertices, faces, quads=50), faces)


def test_a_tetrahedron():
    faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    assert_sound(hybrid_quad.remesh([*TRIANGLE, [0, 0, 1]], faces, quads=60), faces)


def test_input_arrays_stay_as_they_were():
    vertices, faces = surfaces.torus(12, 8)
    before = vertices.copy(), faces.copy()
    hybrid_quad.remesh(vertices, faces, quads=100)
    assert np.array_equal(vertices, before[0])
    assert np.array_equal(faces, before[1])


def test_other_types_and_layouts_of_arrays():
    vertices, faces = surfaces.torus(16, 10)
    usual = hybrid_quad.remesh(vertices, faces, quads=150)
    for v, f in (
        (np.asfortranarray(vertices), np.asfortranarray(faces.astype(np.int64))),
        (vertices.tolist(), faces.tolist()),
        (vertices.repeat(2, axis=0)[::2], faces.astype(np.uint16)),
    ):
        assert np.array_equal(hybrid_quad.remesh(v, f, quads=150).vertices, usual.vertices)
