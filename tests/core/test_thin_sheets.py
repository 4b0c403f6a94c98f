"""A result belongs to the side of a thin sheet that it lies on, however thin that is, and whatever the order of the triangles."""

import numpy as np
import pytest

from hybrid_quad.core.surface_places import TriangleMesh
from hybrid_quad.core.transfer.correspondence import Correspondence
from hybrid_quad.core.transfer.layers import Layer, values_on_result


def _grid(cells: int, height: float, turned: bool):
    """Points and quads of a square, which face up, or down where it is turned."""
    axis = np.linspace(0.0, 1.0, cells + 1)
    points = np.stack(
        [*(each.ravel() for each in np.meshgrid(axis, axis, indexing="ij")), np.full((cells + 1) ** 2, height)], 1
    )
    first = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    quads = first[:, None] + np.array([0, cells + 1, cells + 2, 1])
    return points, quads[:, ::-1] if turned else quads


def _sheet(cells: int, thickness: float):
    """Both sides of a sheet, the upper one first."""
    (above, up), (below, down) = _grid(cells, thickness, False), _grid(cells, 0.0, True)
    return np.concatenate([above, below]), np.concatenate([up, down + len(above)])


def _triangles(points, quads, seed: int) -> TriangleMesh:
    """The quads' triangles in any order, the quads being polygons."""
    corners = np.arange(quads.size).reshape(-1, 4)
    split = np.array([[0, 1, 2], [0, 2, 3]])
    polygon = np.repeat(np.arange(len(quads)), 2)
    order = np.random.default_rng(seed).permutation(len(polygon))
    return TriangleMesh(
        points, quads[:, split].reshape(-1, 3)[order], corners[:, split].reshape(-1, 3)[order], polygon[order]
    )


@pytest.mark.parametrize("thickness", [1e-2, 1e-5, 1e-9, 0.0])
@pytest.mark.parametrize("seed", [1, 2])
def test_nothing_comes_through_a_sheet(thickness, seed):
    points, quads = _sheet(9, thickness)
    source = _triangles(points, quads, seed)
    result_points, result_quads = _sheet(7, thickness)
    found = Correspondence(source, result_points, result_quads)
    is_lower = np.repeat([0, 1], len(result_quads) // 2)
    lower_face, lower_vertex = (np.repeat([0.0, 1.0], len(each) // 2) for each in (quads, points))
    lower_corner = np.repeat(lower_face, 4)
    assert found.vertices_against == 0
    assert np.array_equal(values_on_result(Layer("FACE", lower_face), found), is_lower)
    values = values_on_result(Layer("POINT", lower_vertex, True), found)
    assert np.allclose(values, np.repeat([0, 1], len(result_points) // 2), rtol=0, atol=1e-12)
    # A map of two islands, one for each side, and colours that are another on each.
    places = points[quads.ravel()][:, :2] + 5 * lower_corner[:, None]
    expected = result_points[result_quads.ravel()][:, :2] + 5 * np.repeat(is_lower, 4)[:, None]
    for is_extended in (True, False):
        values = values_on_result(Layer("CORNER", places, True, 1e-6, is_extended=is_extended), found)
        assert np.allclose(values, expected, rtol=0, atol=1e-6)


def test_of_sides_as_near_the_one_that_agrees_best_counts():
    """The upper edge of a roof is as near to both slopes: a face that leans to one side is that side's."""
    points = np.array([[0, -1, 0], [0, 1, 0], [-1, -1, -1], [-1, 1, -1], [1, -1, -1], [1, 1, -1]], float)
    left, right = [0, 1, 3, 2], [0, 4, 5, 1]
    for quads in ([left, right], [right, left]):
        source = _triangles(points, np.array(quads), 0)
        for lean, slope in ((-0.1, left), (0.1, right)):
            tilted = np.array([[-0.1, -0.1, lean], [0.1, -0.1, -lean], [0.1, 0.1, -lean], [-0.1, 0.1, lean]])
            tilted[:, 2] += 0.3
            found = Correspondence(source, tilted, np.array([[0, 1, 2, 3]]))
            assert quads[found.polygons[0]] == slope


def test_what_agrees_as_well_is_told_apart_by_number():
    points, quads = _grid(4, 0.0, False)
    source = _triangles(points, quads, 3)
    result = Correspondence(source, points, quads)
    normals = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    # Each vertex lies on all of its triangles.
    lowest = [np.flatnonzero((source.vertices == vertex).any(axis=1)).min() for vertex in range(len(points))]
    assert np.array_equal(result.vertices.triangles, lowest)
    assert np.array_equal(result._nearest.find(points, normals, np.ones(len(points))), lowest)
