import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.core.mesh_arrays import Polygons, as_edges, as_polygons, as_vertices, surface_area
from support import surfaces


def test_arrays_and_lists_of_faces_mean_the_same():
    rows = [[0, 1, 2], [2, 1, 3]]
    for faces in (rows, np.array(rows), np.array(rows, np.uint8), tuple(map(tuple, rows)), iter(rows)):
        polygons = as_polygons(faces)
        assert polygons.sizes.tolist() == [3, 3]
        assert polygons.vertices.tolist() == [0, 1, 2, 2, 1, 3]
        assert polygons.sizes.dtype == polygons.vertices.dtype == np.int32


def test_polygons_of_different_sizes():
    polygons = as_polygons([[0, 1, 2, 3], [3, 2, 4]])
    assert polygons.sizes.tolist() == [4, 3]
    assert as_polygons(polygons).vertices.tolist() == [0, 1, 2, 3, 3, 2, 4]


@pytest.mark.parametrize("empty", [[], np.zeros((0, 3), int), np.zeros(0), Polygons(np.zeros(0), np.zeros(0))])
def test_no_faces(empty):
    assert len(as_polygons(empty).sizes) == 0


def test_wrong_shapes_and_types_are_refused():
    with pytest.raises(ValueError, match=r"\(n, 3\)"):
        as_vertices([[0.0, 1.0]])
    with pytest.raises(ValueError, match="vertices"):
        as_vertices(np.zeros(6))
    with pytest.raises(TypeError, match="integers"):
        as_polygons(np.array([[0.0, 1.0, 2.0]]))
    with pytest.raises(ValueError, match="faces"):
        as_polygons(np.array([0, 1, 2]))
    for flat in ([0, 1, 2], (0, 1, 2)):
        with pytest.raises(ValueError, match="faces"):
            as_polygons(flat)
    for edges in ([[0, 1, 2]], [0, 1]):
        with pytest.raises(ValueError, match="sharp_edges"):
            as_edges(edges)


def test_complex_numbers_do_not_lose_a_part():
    points = np.eye(3) + 1j
    for vertices in (points, points.tolist()):
        with pytest.raises(TypeError, match="vertices must be real"):
            as_vertices(vertices)
    with pytest.raises(TypeError, match="density must be real"):
        hybrid_quad.remesh(np.eye(3), [[0, 1, 2]], density=np.ones(3) + 0j)


def test_missing_faces_are_told_as_such():
    for vertices in (np.zeros((3, 3)), [[0.0, 0.0, 0.0]]):
        with pytest.raises(TypeError, match="faces are missing"):
            hybrid_quad.remesh(vertices)


def test_indices_beyond_32_bits_do_not_wrap_around():
    with pytest.raises(hybrid_quad.InputError) as caught:
        as_polygons([[0, 1, 2**32 + 2]])
    assert caught.value.code == "index_out_of_range"


def test_edges():
    assert as_edges(None).shape == (0, 2)
    assert as_edges([]).shape == (0, 2)
    assert as_edges({(3, 4)}).tolist() == [[3, 4]]


def test_area():
    vertices, faces = surfaces.mixed_polygons()
    assert surface_area(vertices + 1e7, as_polygons(faces)) == pytest.approx(3 + 3 + 8)
    assert surface_area(vertices, as_polygons([[0, 1, 99], [0, 1, 2]])) == pytest.approx(1)
    assert surface_area(np.zeros((0, 3)), as_polygons([])) == 0
