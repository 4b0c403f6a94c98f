from types import SimpleNamespace

import numpy as np
import pytest

import hybrid_quad

POINTS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)]


def rows(polygons):
    return [part.tolist() for part in np.split(polygons.vertices, np.cumsum(polygons.sizes)[:-1])]


def test_meshio_with_cells_of_all_kinds():
    meshio = pytest.importorskip("meshio")
    cells = [("line", [[0, 1]]), ("quad", [[0, 1, 2, 3]]), ("vertex", [[0]]), ("triangle", [[1, 4, 2]])]
    vertices, faces = hybrid_quad.mesh_arrays(meshio.Mesh(POINTS, cells))
    assert np.array_equal(vertices, POINTS) and rows(faces) == [[0, 1, 2, 3], [1, 4, 2]]
    flat = meshio.Mesh(np.array(POINTS, float)[:, :2], cells)
    assert np.array_equal(hybrid_quad.mesh_arrays(flat)[0], POINTS)
    with pytest.raises(ValueError, match="tetra"):
        hybrid_quad.mesh_arrays(meshio.Mesh(POINTS, [("tetra", [[0, 1, 2, 4]])]))


def test_trimesh_and_alike():
    alike = SimpleNamespace(vertices=POINTS, faces=[[0, 1, 2], [0, 2, 3]])
    vertices, faces = hybrid_quad.mesh_arrays(alike)
    assert np.array_equal(vertices, POINTS) and rows(faces) == alike.faces
    trimesh = pytest.importorskip("trimesh")
    box = trimesh.creation.box()
    vertices, faces = hybrid_quad.mesh_arrays(box)
    assert np.array_equal(vertices, box.vertices) and rows(faces) == box.faces.tolist()
    result = hybrid_quad.remesh(vertices, faces, quads=60)
    back = trimesh.Trimesh(result.vertices, result.quads)
    assert back.is_watertight and len(back.faces) == 2 * len(result.quads)


def test_what_is_no_mesh():
    with pytest.raises(TypeError, match="list"):
        hybrid_quad.mesh_arrays(POINTS)
