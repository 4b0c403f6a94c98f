"""What a case has of the files of a run: the same numbers, and nothing else."""

import numpy as np
import pytest

from hybrid_quad.cases.case_inputs import MESH, write_copies
from hybrid_quad.core.file_places import MeshFileError
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.part_files import read_part
from hybrid_quad.core.strokes import kind_of_name
from hybrid_quad.core.wish_files import read_counts, read_edges, read_polylines, read_rows

OBJ = """# of jane
o secret
v 0.1 0.2 1e-300
v 0.30000000000000004 -0.0 7e22
v 1 nan inf
vt 0 0
f 1/1 2/1 3/1
f -1 -2 -9 0
f 1
f 4000000000 1 2 3 1
"""
TEXTS = {
    "features": "0 1 # secret\n\n2 1\n",
    "curve_counts": "7 0 1 2 # secret\n3 2 0\n",
    "guides": "# secret\no Ring_secret\nv 0 0 0.1\nv 1 0 0\nv 1 0.3 0\nl 1 2 3\no secret\nl -1 -3\no loop\nl 1 2 1\n",
    "density": "0.1 # secret\n2\n1e-9\n",
    "frames": "0 0 0 0 0 0\n0.1 0 0 0 3 0 # secret\n0 0 1 1e-17 0 0\n",
    "part": "0 1 # secret\n3\n",
}


def named(path):
    return [(kind_of_name(name, ""), points.tolist()) for name, points in read_polylines(path)]


READERS = {
    "features": lambda path: read_edges(path).tolist(),
    "curve_counts": read_counts,
    "guides": named,
    "density": lambda path: read_rows(path, 1).tolist(),
    "frames": lambda path: read_rows(path, 6).tolist(),
    "part": lambda path: read_part(path).tolist(),
}


def test_copies_have_the_same_numbers_and_no_names(tmp_path):
    source, folder = tmp_path / "secret.obj", tmp_path / "copies"
    folder.mkdir()
    source.write_text(OBJ)
    paths = {name: tmp_path / f"secret_{name}" for name in TEXTS}
    for name, path in paths.items():
        path.write_text(TEXTS[name])
    packed = write_copies(source, {"quads": 9, **{name: str(path) for name, path in paths.items()}}, folder)
    assert packed["quads"] == 9
    vertices, polygons = read_mesh(source)
    again, same = read_mesh(folder / MESH)
    assert vertices.tobytes() == again.tobytes()
    assert np.array_equal(polygons.sizes, same.sizes) and np.array_equal(polygons.vertices, same.vertices)
    for name, path in paths.items():
        assert READERS[name](folder / packed[name]) == READERS[name](path), name
    content = "".join(path.read_text() for path in folder.iterdir()).lower()
    assert "secret" not in content and "jane" not in content


def test_a_file_that_cannot_be_read_is_said(tmp_path):
    source, folder = tmp_path / "a.obj", tmp_path / "copies"
    folder.mkdir()
    source.write_text(OBJ)
    (tmp_path / "density").write_text("one\n")
    with pytest.raises(MeshFileError, match="line 1"):
        write_copies(source, {"density": str(tmp_path / "density")}, folder)
