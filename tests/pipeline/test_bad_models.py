"""Broken, extreme and hostile meshes: valid quads, or a reason with a code and, where there are any, the elements."""

import os
from pathlib import Path

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.core.file_places import MeshFileError
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.validation import violations
from hybrid_quad.core.wish_files import read_line_elements
from support import surfaces

_DEV = os.environ.get("HQ_MODELS")
COLLECTION = (Path(_DEV).parent if _DEV else Path(__file__).resolve().parents[3] / "shared" / "meshes") / "bad"

# What each of these does to a run is settled in a moment; the others take minutes together.
QUICK = tuple(
    [
        "m15",
        "m16",
        "m17",
        "m18",
        "m19",
        "m20",
        "m21",
        "m22",
        "m23",
        "m38",
        "m39",
        "m41",
        "m43",
        "m44",
        "r01",
        "r15",
        "r19",
    ]
)
NO_ELEMENTS = {"empty_mesh", "no_area", "coordinates_too_coarse"}  # the whole mesh is at fault


def bad_models():
    return sorted(path.stem for path in COLLECTION.glob("*.obj"))


def assert_valid_or_refused(vertices, faces):
    defects = hybrid_quad.check(vertices, faces)
    refused = {defect.code for defect in defects if not defect.repairable}
    try:
        result = hybrid_quad.remesh(vertices, faces, quads=300, time_limit=120)
    except hybrid_quad.InputError as error:
        assert refused == {error.code}
        assert str(error).endswith(".")
        assert error.code in NO_ELEMENTS or error.elements
    else:
        assert not refused
        assert len(result.quads)
        assert violations(result.vertices, result.quads) == []
        told = {defect["code"] for defect in result.report["defects"]}
        assert told == {defect.code for defect in defects if not defect.kept or defect.code == "touching_vertex"}


@pytest.mark.skipif(not bad_models(), reason="no collection of meshes beside the repository")
@pytest.mark.parametrize(
    "name", [name if name.startswith(QUICK) else pytest.param(name, marks=pytest.mark.slow) for name in bad_models()]
)
def test_bad_models(name):
    try:
        vertices, faces = read_mesh(COLLECTION / f"{name}.obj")
    except MeshFileError as error:
        assert name in str(error)
        return
    assert_valid_or_refused(vertices, faces)


def noisy_torus(share):
    vertices, faces = surfaces.torus(24, 12)
    return vertices + share * np.random.default_rng(1).normal(size=vertices.shape), faces


def dust():
    """Forty tiny tetrahedra about a sphere."""
    vertices, faces = surfaces.sphere(4)
    corners = 0.01 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    places = np.random.default_rng(2).uniform(-3, 3, (40, 1, 3))
    tetrahedron = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    more = tetrahedron + 4 * np.arange(40)[:, None, None] + len(vertices)
    return np.concatenate([vertices, (corners + places).reshape(-1, 3)]), np.concatenate([faces, more.reshape(-1, 3)])


def sheets_on_one_edge(count):
    """Triangles about one edge, as the pages of a book."""
    angles = 2 * np.pi * np.arange(count) / count
    tips = np.column_stack([np.cos(angles), np.sin(angles), np.full(count, 0.5)])
    return np.concatenate([[[0, 0, 0], [0, 0, 1]], tips]), [[0, 1, 2 + k] for k in range(count)]


def flattened():
    vertices, faces = surfaces.sphere(6)
    return vertices * [1, 1, 0], faces


def needles():
    vertices, faces = surfaces.torus(16, 10)
    return vertices * [1, 1, 1e-4], faces


def klein_bottle(n=16):
    """Closed, one-sided: the last ring is glued to the first the other way round."""
    ring, place = np.divmod(np.arange(n * n), n)
    u, v = 2 * np.pi * ring / n, 2 * np.pi * place / n
    radius = 2 + np.cos(u / 2) * np.sin(v) - np.sin(u / 2) * np.sin(2 * v)
    height = np.sin(u / 2) * np.sin(v) + np.cos(u / 2) * np.sin(2 * v)
    vertices = np.column_stack([radius * np.cos(u), radius * np.sin(u), height])

    def vertex(i, j):
        return (i * n + j) % (n * n) if i < n else (-j) % n

    steps = ((0, 0), (1, 0), (1, 1), (0, 1))
    return vertices, [[vertex(i + a, (j + b) % n) for a, b in steps] for i in range(n) for j in range(n)]


MADE = {
    "noise": lambda: noisy_torus(0.02),
    "heavy noise": lambda: noisy_torus(0.1),
    "dust": dust,
    "three sheets": lambda: sheets_on_one_edge(3),
    "seven sheets": lambda: sheets_on_one_edge(7),
    "flattened": flattened,
    "needles": needles,
    "klein bottle": klein_bottle,
}


@pytest.mark.parametrize("name", MADE)
def test_made_ones(name):
    assert_valid_or_refused(*MADE[name]())


def test_a_one_sided_closed_surface_names_its_faces():
    vertices, faces = klein_bottle()
    with pytest.raises(hybrid_quad.InputError) as caught:
        hybrid_quad.remesh(vertices, faces)
    assert (caught.value.code, caught.value.element_kind) == ("non_orientable", "face")
    assert set(caught.value.elements) == set(range(len(faces)))


def test_tiny_parts_do_not_take_many_times_the_asked_quads():
    vertices, faces = dust()
    result = hybrid_quad.remesh(vertices, faces, quads=300)
    assert len(result.quads) < 300 + 40 * 40


@pytest.mark.parametrize(("size", "is_left_out"), [(1e-5, True), (2e-5, True), (1e-3, False)])
def test_specks_are_left_out_and_listed(size, is_left_out):
    vertices, faces = surfaces.sphere(4)
    specks = np.concatenate([vertices, 3 + size * vertices]), np.concatenate([faces, faces + len(vertices)])
    result = hybrid_quad.remesh(*specks, quads=100)
    left_out = {
        element
        for defect in hybrid_quad.check(*specks)
        if defect.code == "tiny_component"
        for element in defect.elements
    }
    assert left_out == (set(range(len(faces), 2 * len(faces))) if is_left_out else set())
    assert result.report["flawed_quads"] == 0


def test_what_is_odd_but_possible_is_listed_and_left():
    vertices, faces = surfaces.sphere(4)
    other = (
        np.concatenate([vertices, vertices + np.array([0.7, 0.1, 0.2])]),
        np.concatenate([faces, faces + len(vertices)]),
    )
    (found,) = hybrid_quad.check(*other)
    assert (found.code, found.element_kind, found.kept, found.repairable) == ("self_intersection", "face", True, True)
    assert 0 < len(found) < len(other[1])
    assert hybrid_quad.remesh(*other, quads=300).report["defects"] == []


def test_loose_edges_are_listed(tmp_path):
    vertices, faces = surfaces.sphere(3)
    found = hybrid_quad.check(vertices, faces, edges=[faces[0][:2], [0, len(vertices) - 1]])
    assert [(defect.code, defect.elements.tolist()) for defect in found] == [("loose_edge", [[0, len(vertices) - 1]])]
    path = tmp_path / "lines.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\nl -1 -3\n")
    assert read_line_elements(path).tolist() == [[0, 1], [1, 2], [2, 0]]
