"""One result, byte for byte, from the add-on, the Python call and the command, with any number of threads."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import bpy
import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.blender.remesh_task import prepare_task
from hybrid_quad.core.mesh_io import read_mesh, write_mesh
from hybrid_quad.core.python_programs import python_program
from hybrid_quad.core.surface_points import fan_triangles
from scenes import add_object, faces_of, points_of

MODELS = Path(__file__).parents[1] / "data" / "meshes"
QUADS = 600


def _written(folder: Path, result: hybrid_quad.RemeshResult) -> bytes:
    path = folder / "result.obj"
    write_mesh(path, result.vertices, result.quads)
    return path.read_bytes()


def _written_by_command(folder: Path, obj: bpy.types.Object, threads: int) -> bytes:
    """What the command makes of the object's own single-precision coordinates, in a process of its own."""
    source, path = folder / "source.obj", folder / "command.obj"
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points_of(obj).tolist()]
    lines += ["f " + " ".join(str(vertex + 1) for vertex in face) for face in faces_of(obj)]
    source.write_text("\n".join(lines) + "\n")
    command = [
        python_program(),
        "-m",
        "hybrid_quad",
        "remesh",
        str(source),
        str(path),
        "--quads",
        str(QUADS),
        "--quiet",
    ]
    places = os.environ | {"PYTHONPATH": str(Path(hybrid_quad.__file__).parents[1])}
    subprocess.run([*command, "--threads", str(threads)], env=places, check=True, timeout=120)
    return path.read_bytes()


@pytest.mark.parametrize("name", ["hexme_i01o_m1_t", "c3d_spot_triangulated"], ids=["cad_part", "organic"])
def test_add_on_python_and_command_give_the_same_bytes_with_any_number_of_threads(tmp_path, name):
    vertices, polygons = read_mesh(MODELS / f"{name}.obj")
    obj = add_object("Model", vertices, fan_triangles(polygons).tolist())
    obj.hybrid_quad.quads = QUADS
    results, files = [], set()
    for threads in (1, 2, 4):
        of_add_on = prepare_task(obj, bpy.context.evaluated_depsgraph_get(), threads=threads).solve()
        of_python = hybrid_quad.remesh(points_of(obj), faces_of(obj), quads=QUADS, threads=threads)
        results += [of_add_on, of_python]
        files |= {
            _written(tmp_path, of_add_on),
            _written(tmp_path, of_python),
            _written_by_command(tmp_path, obj, threads),
        }
    for array in ("vertices", "quads", "feature_edges", "feature_curves", "vertex_kinds"):
        arrays = [getattr(result, array) for result in results]
        assert len({(each.dtype, each.shape, each.tobytes()) for each in arrays}) == 1, array
    assert len(files) == 1
    assert np.array_equal(read_mesh(tmp_path / "command.obj")[0], results[0].vertices)
