"""Same input, same bits: again, with other threads, and beside another run."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.cli.main import main
from hybrid_quad.core.mesh_io import write_mesh
from support import surfaces

TORUS = surfaces.torus(50, 24)
BOX = surfaces.together(surfaces.box(8), surfaces.wavy_grid(14))


def same(one, two):
    return (
        np.array_equal(one.vertices, two.vertices)
        and np.array_equal(one.quads, two.quads)
        and np.array_equal(one.feature_edges, two.feature_edges)
        and np.array_equal(one.vertex_kinds, two.vertex_kinds)
    )


@pytest.mark.parametrize("mesh", [TORUS, BOX], ids=["torus", "two_parts"])
def test_again_and_with_other_threads(mesh):
    first = hybrid_quad.remesh(*mesh, quads=500, threads=1)
    for threads in (1, 2, 4):
        assert same(first, hybrid_quad.remesh(*mesh, quads=500, threads=threads))


def test_two_runs_at_once_give_what_they_give_alone():
    jobs = [(TORUS, 400), (BOX, 500), (TORUS, 700)]
    alone = [hybrid_quad.remesh(*mesh, quads=quads) for mesh, quads in jobs]
    with ThreadPoolExecutor(len(jobs)) as pool:
        together = list(pool.map(lambda job: hybrid_quad.remesh(*job[0], quads=job[1]), jobs))
    assert all(same(one, two) for one, two in zip(alone, together, strict=True))


def test_callbacks_change_nothing():
    alone = hybrid_quad.remesh(*BOX, quads=400)
    watched = hybrid_quad.remesh(
        *BOX, quads=400, progress=lambda stage, fraction: None, cancel=lambda: False, on_snapshot=lambda snapshot: None
    )
    assert same(alone, watched)


def test_another_process_gives_the_same_bytes(tmp_path):
    code = (
        f"import sys; sys.path.insert(0, {str(surfaces.__file__).rsplit('/support/', 1)[0]!r})\n"
        "from support import surfaces\n"
        "import hybrid_quad\n"
        "result = hybrid_quad.remesh(*surfaces.torus(50, 24), quads=400)\n"
        f"open({str(tmp_path / 'out')!r}, 'wb').write(result.vertices.tobytes() + result.quads.tobytes())\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)
    here = hybrid_quad.remesh(*TORUS, quads=400)
    assert (tmp_path / "out").read_bytes() == here.vertices.tobytes() + here.quads.tobytes()


def test_a_seed_is_a_seed():
    assert same(hybrid_quad.remesh(*TORUS, quads=300, seed=9), hybrid_quad.remesh(*TORUS, quads=300, seed=9))


@pytest.mark.parametrize("variant", ["plain", "wishes"])
def test_the_command_writes_the_same_bytes_with_any_number_of_threads(tmp_path, variant):
    vertices, faces = surfaces.quad_box(6)
    write_mesh(tmp_path / "in.obj", vertices, faces)
    more = []
    if variant == "wishes":
        np.savetxt(tmp_path / "density.txt", 1 + vertices[:, 0])
        more = [
            "--density",
            str(tmp_path / "density.txt"),
            "--adaptivity",
            "0.3",
            "--symmetry",
            "z",
            "--symmetry-center",
            "bounds",
        ]
    written = set()
    for threads in (1, 2, 4):
        out = tmp_path / f"out{threads}.obj"
        arguments = ["remesh", str(tmp_path / "in.obj"), str(out), "--quads", "300", "--quiet", *more]
        assert main([*arguments, "--threads", str(threads)]) == 0
        written.add(out.read_bytes())
    assert len(written) == 1


def test_wishes_with_other_threads():
    vertices, faces = TORUS
    wishes = {
        "density": np.linspace(0.5, 2, len(vertices)),
        "guides": np.roll(vertices, 1, axis=1),
        "chord_error": None,
    }
    first = hybrid_quad.remesh(vertices, faces, quads=400, threads=1, **wishes)
    for threads in (2, 4):
        assert same(first, hybrid_quad.remesh(vertices, faces, quads=400, threads=threads, **wishes))
