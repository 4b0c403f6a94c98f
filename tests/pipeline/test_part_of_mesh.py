"""Remeshing some faces: the rest keeps its bits, the quads join it edge to edge."""

import json
import time

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad import remesh_part
from hybrid_quad.cli import exit_codes
from hybrid_quad.cli.main import main
from hybrid_quad.core import part_files
from hybrid_quad.core.edge_borders import edge_keys
from hybrid_quad.core.mesh_arrays import as_polygons
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.part_files import write_polygons
from hybrid_quad.core.part_sheet import sides_of
from hybrid_quad.core.remesh_part import PartChoice
from hybrid_quad.core.validation import topology
from hybrid_quad.worker.process import WorkerRun
from hybrid_quad.worker.request import RemeshRequest
from support import surfaces


def model(root, name):
    vertices, polygons = read_mesh(root / "tests" / "data" / "meshes" / f"{name}.obj")
    return vertices, polygons


def grown(polygons, vertex_count, seed, count):
    """(#F,) bool: a connected patch of faces around one."""
    keys = edge_keys(sides_of(polygons), vertex_count)
    owner = np.repeat(np.arange(len(polygons.sizes)), polygons.sizes)
    part = np.zeros(len(polygons.sizes), bool)
    part[seed] = True
    while part.sum() < count:
        wider = part.copy()
        wider[owner[np.isin(keys, keys[part[owner]])]] = True
        if (wider == part).all():
            break
        part = wider
    return part


def assert_joined(vertices, faces, result):
    """The rest is bit for bit as it was; the mesh has no more and no other open edges, and the same topology."""
    polygons = as_polygons(faces)
    assert np.array_equal(result.vertices[: len(result.kept_vertices)], vertices[result.kept_vertices])
    starts = np.cumsum(polygons.sizes) - polygons.sizes
    before = [polygons.vertices[starts[f] : starts[f] + polygons.sizes[f]].tolist() for f in result.kept_faces]
    ends = np.cumsum(result.faces.sizes)
    after = [result.faces.vertices[end - size : end] for size, end in zip(result.faces.sizes, ends, strict=True)]
    assert before == [result.kept_vertices[face].tolist() for face in after[: len(before)]]
    assert np.array_equal(np.array(after[len(before) :]), result.quads)
    _, uses = np.unique(edge_keys(sides_of(result.faces), len(result.vertices)), return_counts=True)
    assert uses.max() == 2
    assert topology(result.faces) == topology(polygons)
    assert len(np.unique(result.faces.vertices)) == len(result.vertices)


@pytest.mark.parametrize("name", ["c3d_spot_triangulated", "c3d_fandisk"])
@pytest.mark.parametrize("count", [1, 30, 400])
def test_patches_of_models(root, name, count):
    vertices, polygons = model(root, name)
    part = grown(polygons, len(vertices), 1234, count)
    result = remesh_part(vertices, polygons, part, odd_border="grow")
    assert_joined(vertices, polygons, result)
    assert result.report["curve_counts"] == []


def test_several_pieces_with_holes_and_points_in_common():
    vertices, faces = surfaces.torus()
    for seed in range(4):
        part = np.random.default_rng(seed).random(len(faces)) < 0.6
        result = remesh_part(vertices, faces, part, odd_border="grow", sharp_angle=None)
        assert_joined(vertices, faces, result)


def test_odd_borders_that_are_closed_again_after_a_cut():
    vertices, faces = surfaces.torus(30, 15)
    part = np.ones(len(faces), bool)
    part[[3, 200]] = False  # two triangular holes
    result = remesh_part(vertices, faces, part, sharp_angle=None, edge_length=0.2)
    assert result.report["part"]["cuts"] == 1
    assert_joined(vertices, faces, result)


def test_the_own_border_is_divided_anew():
    vertices, faces = surfaces.wavy_grid(20)
    part = vertices[faces].mean(axis=1)[:, 0] < 0.5
    result = remesh_part(vertices, faces, part, edge_length=0.025)
    assert_joined(vertices, faces, result)
    assert np.isclose(result.vertices[:, 0], 0).sum() > 25
    assert np.isclose(result.vertices[:, 0], 0.5).sum() == 21


def test_all_faces_are_a_part_too():
    vertices, faces = surfaces.sphere()
    result = remesh_part(vertices, faces, np.arange(len(faces)), quads=300)
    assert len(result.kept_vertices) == len(result.kept_faces) == 0
    assert_joined(vertices, faces, result)


def test_far_from_the_origin_and_small():
    vertices, faces = surfaces.wavy_grid(12)
    part = grown(as_polygons(faces), len(vertices), 130, 60)
    for moved in (vertices + np.array([1e5, -3e4, 7.0]), 1e-7 * vertices + 0.1):
        assert_joined(moved, faces, remesh_part(moved, faces, part))


def test_rest_of_other_polygons():
    vertices, faces = surfaces.quad_box(6)
    part = vertices[faces].mean(axis=1)[:, 2] > 0.7
    result = remesh_part(vertices, faces, part)
    assert_joined(vertices, faces, result)


def test_same_by_the_worker():
    vertices, faces = surfaces.wavy_grid(12)
    polygons = as_polygons(faces)
    part = grown(polygons, len(vertices), 130, 60)
    request = RemeshRequest(
        vertices,
        polygons,
        hybrid_quad.RemeshOptions(),
        np.zeros((0, 2), np.int32),
        part=PartChoice(part, "grow", True),
    )
    run = WorkerRun(request)
    run.wait()
    here, there = request.solve(), run.result()
    for name in ("vertices", "quads", "whole_vertices", "part"):
        assert np.array_equal(getattr(here, name), getattr(there, name)), name


@pytest.mark.parametrize(("choice", "code"), [([], "no_part"), ([27], "odd_border"), ([9999], "unknown_face")])
def test_refusals(choice, code):
    vertices, faces = surfaces.wavy_grid(8)
    with pytest.raises(hybrid_quad.InputError) as refused:
        remesh_part(vertices, faces, np.array(choice, int))
    assert refused.value.code == code


def test_cracks_at_the_border_are_refused():
    vertices, faces = surfaces.grid(6, 6)
    part = grown(as_polygons(faces), len(vertices), 30, 12)
    uses = np.bincount(faces[part].ravel(), minlength=len(vertices))
    vertex = int(next(v for v in np.intersect1d(faces[part], faces[~part]) if uses[v] > 1))
    faces = faces.copy()
    torn = np.flatnonzero(part & (faces == vertex).any(axis=1))[0]
    faces[torn] = np.where(faces[torn] == vertex, len(vertices), faces[torn])
    with pytest.raises(hybrid_quad.InputError) as refused:
        remesh_part(np.concatenate([vertices, vertices[[vertex]]]), faces, part, odd_border="grow")
    assert refused.value.code == "unwelded_border"


def test_errors_name_elements_of_the_whole():
    vertices, faces = surfaces.wavy_grid(12)
    part = grown(as_polygons(faces), len(vertices), 130, 60)
    vertices = vertices.copy()
    inside = np.setdiff1d(faces[part], faces[~part])
    vertices[inside[0]] = np.nan
    with pytest.raises(hybrid_quad.InputError) as refused:
        remesh_part(vertices, faces, part, edge_length=0.1)
    assert refused.value.code == "non_finite_vertex" and refused.value.elements == (int(inside[0]),)


def test_what_needs_the_whole_surface():
    vertices, faces = surfaces.wavy_grid(6)
    with pytest.raises(ValueError, match="whole surface"):
        remesh_part(vertices, faces, [0, 1], symmetry="x")


@pytest.mark.parametrize("suffix", [".obj", ".off", ".ply"])
def test_command_line(tmp_path, suffix):
    vertices, faces = surfaces.quad_box(6)
    part = np.flatnonzero(vertices[faces].mean(axis=1)[:, 2] > 0.7)
    paths = [tmp_path / name for name in (f"in{suffix}", f"out{suffix}", "part.txt", "report.json")]
    write_polygons(paths[0], vertices, as_polygons(faces))
    paths[2].write_text("# the upper faces\n" + " ".join(map(str, part)) + "\n")
    arguments = ["remesh", str(paths[0]), str(paths[1]), "--part", str(paths[2]), "--report", str(paths[3]), "--quiet"]
    assert main(arguments) == 0
    found, polygons = read_mesh(paths[1])
    expected = remesh_part(vertices, faces, part)
    assert np.array_equal(found, expected.vertices)
    assert np.array_equal(polygons.vertices, expected.faces.vertices)
    assert json.loads(paths[3].read_text())["part"]["chosen_faces"] == len(part)
    paths[2].write_text("1 x\n")
    assert main(arguments) == 2


def test_a_part_of_a_file_whose_faces_use_vertices_that_are_not_there_is_refused(tmp_path, capfd):
    """Also where only the rest does."""
    vertices, faces = surfaces.grid(6, 6, 1.0, 1.0)
    path, part = tmp_path / "in.off", tmp_path / "part.txt"
    wrong = np.concatenate([np.asarray(faces), [[0, 1, 999]]])
    write_polygons(path, np.asarray(vertices), as_polygons(wrong))
    part.write_text("0 1 2 3")
    arguments = ["remesh", str(path), str(tmp_path / "out.obj"), "--part", str(part), "--odd-border", "grow"]
    assert main(arguments) == exit_codes.CANNOT_REMESH
    assert "[index_out_of_range]" in capfd.readouterr().err


@pytest.mark.parametrize("suffix", [".obj", ".off", ".ply"])
def test_polygons_are_written_the_same_however_many_at_a_time(tmp_path, monkeypatch, suffix):
    vertices = np.arange(21.0).reshape(7, 3) / 3
    polygons = as_polygons([[0, 1, 2], [1, 2, 3, 4, 5], [], [2, 3, 6, 5], [6, 5, 4]])
    whole, some = tmp_path / f"a{suffix}", tmp_path / f"b{suffix}"
    write_polygons(whole, vertices, polygons)
    monkeypatch.setattr(part_files, "_AT_ONCE", 2)
    write_polygons(some, vertices, polygons)
    assert some.read_bytes() == whole.read_bytes()
    if suffix == ".off":
        assert some.read_text().splitlines()[9:] == ["3 0 1 2", "5 1 2 3 4 5", "0 ", "4 2 3 6 5", "3 6 5 4"]


def test_the_time_limit_of_a_part_counts_from_the_start_of_the_run(tmp_path, monkeypatch, capfd):
    vertices, faces = surfaces.grid(12, 12, 1.0, 1.0)
    path, part, out = tmp_path / "in.off", tmp_path / "part.txt", tmp_path / "out.obj"
    write_polygons(path, np.asarray(vertices), as_polygons(faces))
    part.write_text(" ".join(map(str, range(60))))
    options_for = PartChoice.options_for

    def slow(*given):
        time.sleep(0.4)
        return options_for(*given)

    monkeypatch.setattr(PartChoice, "options_for", slow)
    arguments = ["remesh", str(path), str(out), "--part", str(part), "--odd-border", "grow", "--time-limit"]
    assert main([*arguments, "0.3"]) == exit_codes.CANCELLED
    assert "(the time limit passed)" in capfd.readouterr().err
    assert not out.exists()
    assert main([*arguments, "600"]) == exit_codes.OK
