import numpy as np
import pytest

from hybrid_quad.core.edge_borders import EdgeSides, polygon_normals
from hybrid_quad.core.mesh_arrays import Polygons, as_polygons

# Three squares in a row along x, the last one standing; the middle one wound the other way about in TWISTED.
POINTS = np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0), (2, 0, 1), (0, 1, 0), (1, 1, 0), (2, 1, 0), (2, 1, 1)], float)
FACES = as_polygons([(0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6)])
TWISTED = as_polygons([(0, 1, 5, 4), (5, 6, 2, 1), (2, 3, 7, 6)])
EDGES = np.array([(0, 1), (5, 1), (2, 6), (3, 7)], np.int32)


def _sides(faces: Polygons = FACES) -> EdgeSides:
    return EdgeSides(faces, EDGES, len(POINTS))


def test_bends_are_found_by_angle():
    assert _sides().where_faces_bend(POINTS, np.radians(89)).tolist() == [False, False, True, False]
    assert not _sides().where_faces_bend(POINTS, np.radians(91)).any()


def test_borders_between_values_of_faces():
    assert _sides().where_faces_differ([3, 3, 3]).tolist() == [False] * 4
    assert _sides().where_faces_differ([3, 1, 1]).tolist() == [False, True, False, False]
    assert _sides().where_faces_differ([3, 1, 3]).tolist() == [False, True, True, False]


@pytest.mark.parametrize("faces", [FACES, TWISTED], ids=["alike", "twisted"])
def test_cuts_between_corners_whatever_the_winding(faces):
    uv = POINTS[faces.vertices][:, :2].copy()
    uv[faces.vertices >= 0] += POINTS[faces.vertices][:, 2:]
    assert not _sides(faces).where_corners_differ(uv).any()
    one_end = uv.copy()
    one_end[0:4] += np.where(faces.vertices[0:4] == 5, 0.1, 0)[:, None]
    assert _sides(faces).where_corners_differ(one_end).tolist() == [False, True, False, False]
    assert not _sides(faces).where_corners_differ(one_end, tolerance=0.2).any()
    moved = uv.copy()
    moved[8:] += 5
    assert _sides(faces).where_corners_differ(moved).tolist() == [False, False, True, False]


def test_where_three_faces_meet_nothing_changes():
    faces = as_polygons([(0, 1, 5, 4), (1, 2, 6, 5), (1, 5, 7)])
    assert not EdgeSides(faces, EDGES, len(POINTS)).where_faces_differ([1, 2, 3]).any()


def test_faces_without_corners_are_passed_over():
    faces = Polygons(np.array([4, 0, 4, 4, 0], np.int32), FACES.vertices)
    assert EdgeSides(faces, EDGES, len(POINTS)).where_faces_differ([3, 9, 1, 1, 9]).tolist() == [
        False,
        True,
        False,
        False,
    ]
    normals = polygon_normals(POINTS, faces)
    assert normals[[0, 2, 3]] == pytest.approx(np.array([(0, 0, 1), (0, 0, 1), (-1, 0, 0)]))
    assert not normals[[1, 4]].any()
