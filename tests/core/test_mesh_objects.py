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
    result = hybrid_quad.remesh(box, quads=60)
    assert np.array_equal(result.quads, hybrid_quad.remesh(vertices, faces, quads=60).quads)
    back = result.to_trimesh()
    assert np.array_equal(back.vertices, result.vertices)
    assert back.is_watertight and len(back.faces) == 2 * len(result.quads)


def test_a_mesh_goes_through_without_its_arrays(tmp_path):
    meshio = pytest.importorskip("meshio")
    flat = meshio.Mesh(POINTS, [("quad", [[0, 1, 2, 3]]), ("triangle", [[1, 4, 2]])])
    back = hybrid_quad.remesh(flat, quads=30).to_meshio()
    back.write(tmp_path / "quads.vtu")
    again = meshio.read(tmp_path / "quads.vtu")
    assert np.array_equal(again.points, back.points)
    assert np.array_equal(again.cells_dict["quad"], back.cells_dict["quad"])
    arrays = hybrid_quad.mesh_arrays(flat)
    assert hybrid_quad.check(flat) == hybrid_quad.check(*arrays) == []
    assert np.array_equal(hybrid_quad.repair(flat).triangles, hybrid_quad.repair(*arrays).triangles)
    assert np.array_equal(hybrid_quad.preview(flat).points, hybrid_quad.preview(*arrays).points)
    assert np.array_equal(hybrid_quad.subdivide(flat).vertices, hybrid_quad.subdivide(*arrays).vertices)


def test_what_is_no_mesh():
    with pytest.raises(TypeError, match="list"):
        hybrid_quad.mesh_arrays(POINTS)
    with pytest.raises(TypeError, match="faces are missing"):
        hybrid_quad.remesh(np.array(POINTS))
    with pytest.raises(TypeError, match="dict has neither"):
        hybrid_quad.remesh({"vertices": POINTS})
