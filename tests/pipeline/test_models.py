"""Real models: those of the repository, and more where a collection of test meshes lies beside it."""

import csv
from pathlib import Path

import pytest

import hybrid_quad
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.validation import violations
from support.results import assert_sound

HERE = Path(__file__).resolve().parents[1] / "data" / "meshes"
COLLECTION = Path(__file__).resolve().parents[3] / "shared" / "meshes"


def manifold_models():
    index = COLLECTION / "dev" / "index.csv"
    if not index.exists():
        return []
    with index.open() as file:
        return [row["name"] for row in csv.DictReader(file) if row["edge_mf"] == row["vert_mf"] == "y"]


@pytest.mark.parametrize("sharp_angle", [40.0, None], ids=["sharp", "no_sharp"])
@pytest.mark.parametrize(
    "name",
    ["oded_cube", "hexme_i01o_m1_t", "hexme_n11o_limit_cycle_g", "c3d_fandisk", "c3d_spot_triangulated"],
)
def test_models_of_the_repository(name, sharp_angle):
    vertices, faces = read_mesh(HERE / f"{name}.obj")
    result = hybrid_quad.remesh(vertices, faces, quads=1000, sharp_angle=sharp_angle)
    assert_sound(result, faces)
    if name != "hexme_i01o_m1_t":  # whose many features force more
        assert abs(len(result.quads) / 1000 - 1) <= 0.1 or result.report["warnings"]


def test_a_model_with_edges_of_three_faces():
    vertices, faces = read_mesh(HERE / "c3d_suzanne.obj")
    result = hybrid_quad.remesh(vertices, faces, quads=1000)
    assert violations(result.vertices, result.quads) == []
    assert {defect["code"] for defect in result.report["defects"]} >= {"non_manifold_edge"}


@pytest.mark.slow
@pytest.mark.skipif(not manifold_models(), reason="no collection of meshes beside the repository")
@pytest.mark.parametrize("sharp_angle", [40.0, None], ids=["sharp", "no_sharp"])
@pytest.mark.parametrize("name", manifold_models())
def test_manifold_models_of_the_collection(name, sharp_angle):
    vertices, faces = read_mesh(COLLECTION / "dev" / f"{name}.obj")
    result = hybrid_quad.remesh(vertices, faces, quads=2000, sharp_angle=sharp_angle)
    assert violations(result.vertices, result.quads) == []
