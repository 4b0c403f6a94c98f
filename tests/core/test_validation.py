import numpy as np
import pytest

from hybrid_quad.core.validation import scaled_jacobian, topology, violations
from support import surfaces


def lattice(columns=3, rows=3):
    """A flat open grid of quads."""
    x, y = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0))
    vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    quads = [
        [j * (columns + 1) + i, j * (columns + 1) + i + 1, (j + 1) * (columns + 1) + i + 1, (j + 1) * (columns + 1) + i]
        for j in range(rows)
        for i in range(columns)
    ]
    return vertices, np.array(quads)


@pytest.mark.parametrize("mesh", [surfaces.quad_box(1), surfaces.quad_box(3), lattice(1, 1), lattice()], ids=repr)
def test_sound_meshes_pass(mesh):
    assert violations(*mesh) == []


def with_change(change):
    vertices, quads = surfaces.quad_box(3)
    vertices, quads = vertices.copy(), quads.copy()
    return change(vertices, quads) or (vertices, quads)


def not_finite(vertices, _):
    vertices[5, 1] = np.nan


def twice_the_same_corner(_, quads):
    quads[4, 2] = quads[4, 0]


def turned_face(_, quads):
    quads[7] = quads[7, ::-1]


def third_face_on_an_edge(vertices, quads):
    a, b = quads[0, :2]
    fin = [[b, a, len(vertices), len(vertices) + 1]]
    return np.concatenate([vertices, vertices[[a, b]] + [0, 0, 3]]), np.concatenate([quads, fin])


def same_face_twice(vertices, quads):
    return vertices, np.concatenate([quads, quads[:1]])


def unknown_vertex(vertices, quads):
    quads[0, 0] = len(vertices)


def vertex_without_face(vertices, quads):
    return np.concatenate([vertices, [[9, 9, 9]]]), quads


def no_area(vertices, quads):
    vertices[quads[0]] = vertices[quads[0, 0]]


def two_bodies_at_one_vertex(vertices, quads):
    other = quads + len(vertices) - (quads > 0)
    other[quads == 0] = 0
    return np.concatenate([vertices, vertices[1:] + 5]), np.concatenate([quads, other])


def doublet(vertices, quads):
    """One face replaced by two that share two edges, around a new vertex of valence two."""
    a, b, c, d = quads[0]
    centre = len(vertices)
    pair = [[a, b, c, centre], [a, centre, c, d]]
    return np.concatenate([vertices, [vertices[quads[0]].mean(0)]]), np.concatenate([quads[1:], pair])


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (not_finite, "not finite"),
        (twice_the_same_corner, "uses? a vertex twice"),
        (turned_face, "same direction"),
        (third_face_on_an_edge, "more than two faces"),
        (same_face_twice, "same direction|more than two"),
        (unknown_vertex, "does not exist"),
        (vertex_without_face, "without a face"),
        (no_area, "without area"),
        (two_bodies_at_one_vertex, "more than one fan"),
        (doublet, "fewer than three"),
        (doublet, "more than one common edge"),
    ],
)
def test_each_damage_is_found(change, sentence):
    import re

    found = violations(*with_change(change))
    assert any(re.search(sentence, line) for line in found), found


@pytest.mark.parametrize("exponent", [-1020, -600, 600, 1000])
def test_the_size_of_a_mesh_makes_no_difference(exponent):
    vertices, quads = surfaces.quad_box(3)
    assert violations(np.ldexp(vertices, exponent), quads) == []
    vertices, quads = with_change(no_area)
    assert violations(np.ldexp(vertices, exponent), quads) == violations(vertices, quads)


def test_what_is_no_list_of_quads():
    assert violations(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    assert violations(np.zeros((0, 3)), np.zeros((0, 4), int))


@pytest.mark.parametrize(
    ("mesh", "euler", "loops"),
    [
        (surfaces.sphere(), (2,), 0),
        (surfaces.torus(), (0,), 0),
        (surfaces.annulus(), (0,), 2),
        (surfaces.grid(4, 3), (1,), 1),
        (surfaces.moebius(), (0,), 1),
        (surfaces.mixed_polygons(), (2,), 0),
        (surfaces.together(surfaces.torus(), surfaces.sphere(), surfaces.grid(2, 2)), (0, 1, 2), 1),
    ],
    ids=lambda value: None,
)
def test_topology(mesh, euler, loops):
    found = topology(mesh[1])
    assert (found.euler, found.boundary_loops, found.components) == (euler, loops, len(euler))


def test_scaled_jacobian_of_known_shapes():
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    rhombus = [[0, 0, 0], [1, 0, 0], [1.5, np.sqrt(0.75), 0], [0.5, np.sqrt(0.75), 0]]
    arrow = [[0, 0, 0], [1, 0, 0], [0.1, 0.1, 0], [0, 1, 0]]
    quad = [[0, 1, 2, 3]]
    assert scaled_jacobian(square, quad) == pytest.approx([1])
    assert scaled_jacobian(rhombus, quad) == pytest.approx([np.sin(np.pi / 3)])
    assert scaled_jacobian(arrow, quad)[0] < 0
