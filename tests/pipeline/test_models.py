"""Real models: those of the repository, and more where a collection of test meshes lies beside it."""

import csv
import re
import zlib
from pathlib import Path

import numpy as np
import pytest

import hybrid_quad
import variants
from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.validation import scaled_jacobian, violations
from support import surfaces
from support.results import assert_sound

HERE = Path(__file__).resolve().parents[1] / "data" / "meshes"
COLLECTION = Path(__file__).resolve().parents[3] / "shared" / "meshes"


def models_of_the_collection(only_manifold=False):
    index = COLLECTION / "dev" / "index.csv"
    if not index.exists():
        return []
    with index.open() as file:
        rows = list(csv.DictReader(file))
    return [row["name"] for row in rows if not only_manifold or row["edge_mf"] == row["vert_mf"] == "y"]


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


def test_too_few_quads_for_the_detail_are_told():
    """A part with pockets and bosses: thirty quads cannot have shapes there."""
    vertices, faces = read_mesh(HERE / "hexme_i01o_m1_t.obj")

    def told(quads):
        result = hybrid_quad.remesh(vertices, faces, quads=quads, threads=2)
        poor = int((scaled_jacobian(result.vertices, result.quads) < 0.2).sum())
        sentences = [w for w in result.report["warnings"] if "narrow, skew or folded" in w]
        assert all(w.startswith(f"{poor} of {len(result.quads)} quads") for w in sentences)
        return poor / len(result.quads), bool(sentences)

    few, many = told(30), told(2000)
    assert few[0] > 0.03 and few[1]
    assert many[0] < 0.03 and not many[1]


@pytest.mark.slow
@pytest.mark.skipif(not models_of_the_collection(), reason="no collection of meshes beside the repository")
@pytest.mark.parametrize("sharp_angle", [40.0, None], ids=["sharp", "no_sharp"])
@pytest.mark.parametrize("name", models_of_the_collection(only_manifold=True))
def test_manifold_models_of_the_collection(name, sharp_angle):
    vertices, faces = read_mesh(COLLECTION / "dev" / f"{name}.obj")
    result = hybrid_quad.remesh(vertices, faces, quads=2000, sharp_angle=sharp_angle)
    assert violations(result.vertices, result.quads) == []


@pytest.mark.parametrize("name", ["hexme_i01o_m1_t", "hexme_n11o_limit_cycle_g", "c3d_fandisk", "c3d_suzanne"])
def test_patches_of_models_of_the_repository_are_filled_by_their_morse_functions(name):
    """None in the other way, which needs nothing of a function and is for those whose quads fail the checks."""
    patches = hybrid_quad.remesh(*read_mesh(HERE / f"{name}.obj")).report["patches"]
    assert patches["morse_smale"] > 0
    assert (patches["combinatorial"], patches["combinatorial_area_fraction"]) == (0, 0)


@pytest.mark.slow
@pytest.mark.skipif(not models_of_the_collection(), reason="no collection of meshes beside the repository")
@pytest.mark.parametrize("name", models_of_the_collection())
def test_patches_of_the_collection_are_filled_by_their_morse_functions(name):
    patches = hybrid_quad.remesh(*read_mesh(COLLECTION / "dev" / f"{name}.obj")).report["patches"]
    assert patches["combinatorial_area_fraction"] < 0.01


@pytest.mark.parametrize("quads", [300, 500, 800])
def test_bars_thinner_than_quads_stay_bars(quads):
    """Edges along them, by angle, take most of the quads; without these the bars melt (docs/decisions/0043)."""
    bar, height = 1.0, 2.0
    vertices, faces = surfaces.grille(bars=12, bar=bar, gap=4.0, height=height)
    result = hybrid_quad.remesh(vertices, faces, quads=quads, threads=2)
    assert_sound(result, faces)
    assert abs(len(result.quads) / quads - 1) < 0.05
    usual_length = np.sqrt(
        np.linalg.norm(np.cross(*np.diff(vertices[faces], axis=1).swapaxes(0, 1)), axis=1).sum() / 2 / quads
    )
    assert bar < usual_length / 2, "or there is room for all"
    middles = result.vertices[result.quads].mean(axis=1)
    assert hybrid_quad.surface_distances(vertices, result.vertices, result.quads).max() < 0.01 * bar
    assert hybrid_quad.surface_distances(np.concatenate([result.vertices, middles]), vertices, faces).max() < 0.01 * bar
    assert scaled_jacobian(result.vertices, result.quads).min() > 0.1


def test_numbers_along_curves_are_counted_where_all_features_stay():
    """The curves of the plan are fewer than those that the quads follow in the end."""
    vertices, faces = surfaces.grille(bars=12, bar=1.0, gap=4.0, height=2.0)
    ends = [np.flatnonzero((vertices == corner).all(axis=1))[0] for corner in ([0, 10, 2], [0, 50, 2])]
    result = hybrid_quad.remesh(vertices, faces, quads=500, curve_counts=[([int(v) for v in ends], 4)])
    assert_sound(result, faces)
    assert result.report["features_given_way"] == 0
    (record,) = result.report["curve_counts"]
    along = (result.vertices[:, 0] == 0) & (result.vertices[:, 2] == 2) & (np.abs(result.vertices[:, 1] - 30) <= 20)
    assert record["got"] == along.sum() - 1


@pytest.mark.parametrize(
    ("length", "radius", "quads"), [(1.2, 0.06, 120), (2, 0.05, 120), (1.2, 0.04, 200), (0.8, 0.05, 300)]
)
def test_horns_thinner_than_quads_stay_horns(length, radius, quads):
    """Sizes gave way to fewer irregular vertices, two quads went around, and nothing was left (docs/decisions/0052)."""
    vertices, faces = surfaces.horned_sphere(length, radius)
    result = hybrid_quad.remesh(vertices, faces, quads=quads, sharp_angle=None, threads=2)
    assert_sound(result, faces)
    assert abs(len(result.quads) / quads - 1) < 0.05
    usual_length = np.sqrt((4 + 1.6 * radius * length) * np.pi / quads)
    assert 2 * np.pi * radius < 2 * usual_length, "or there is room for all"
    assert hybrid_quad.surface_distances(vertices, result.vertices, result.quads).max() < usual_length
    assert scaled_jacobian(result.vertices, result.quads).mean() > 0.9


def test_horns_stay_horns_where_lengths_are_asked_for():
    """Edges elsewhere stay as long as asked: the horn takes more quads."""
    length, edge = 2.0, 0.2
    vertices, faces = surfaces.horned_sphere(length, 0.03)
    result = hybrid_quad.remesh(vertices, faces, edge_length=edge, sharp_angle=None, threads=2)
    assert_sound(result, faces)
    assert hybrid_quad.surface_distances(vertices, result.vertices, result.quads).max() < 0.5 * edge
    corners = result.vertices[result.quads]
    on_sphere = corners[..., 2].max(axis=1) < 0
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)[on_sphere]
    assert abs(lengths.mean() / edge - 1) < 0.15


def _course() -> np.ndarray:
    """Up, around a bend and down again, some."""
    s = np.linspace(0, 1, 60)
    bend = np.stack([0.3 - 0.3 * np.cos(np.pi * s), 0 * s, 2 + 0.3 * np.sin(np.pi * s)], axis=1)
    return np.concatenate([np.outer(s, [0, 0, 2]), bend[1:], bend[-1] - np.outer(s[1:], [0, 0, 1])])


@pytest.mark.parametrize(("sides", "quads"), [(4, 100), (6, 100), (8, 60), (8, 200), (24, 100)])
def test_wires_thinner_than_quads_keep_their_course(sides, quads):
    """As squares there are too few for four around, and nothing was left but a crumpled sheet (docs/decisions/0053)."""
    radius = 0.012
    vertices, faces = surfaces.wire(_course(), radius, sides)
    result = hybrid_quad.remesh(vertices, faces, quads=quads, sharp_angle=None, threads=2)
    assert_sound(result, faces)
    assert len(result.quads) < 1.1 * quads
    edge = np.sqrt(2 * np.pi * radius * 4 / quads)
    assert hybrid_quad.surface_distances(vertices, result.vertices, result.quads).max() < 3 * edge
    assert scaled_jacobian(result.vertices, result.quads).mean() > 0.8


def test_what_is_cut_short_is_told_with_its_place():
    length = 1.2
    vertices, faces = surfaces.horned_sphere(length, 0.04)

    def told(quads):
        warnings = hybrid_quad.remesh(vertices, faces, quads=quads, sharp_angle=None).report["warnings"]
        return [warning for warning in warnings if "cut short" in warning]

    assert told(600) == []
    (warning,) = told(60)
    place = [float(number) for number in re.search(r"at \((.*?)\)", warning).group(1).split(", ")]
    np.testing.assert_allclose(place, [0, 0, 1 + length], atol=0.2)


@pytest.mark.parametrize(("tube", "quads"), [(0.2, 40), (0.1, 40), (0.05, 100)])
def test_rings_hardly_wider_than_quads_stay_rings(tube, quads):
    """Four quads around a tube get better shapes where they are drawn together, off its surface (docs/decisions/0051)."""
    vertices, faces = surfaces.torus(160, 40, tube)
    result = hybrid_quad.remesh(vertices, faces, quads=quads, sharp_angle=None, threads=2)
    assert_sound(result, faces)
    length = np.sqrt(4 * np.pi**2 * tube / len(result.quads))
    assert hybrid_quad.surface_distances(vertices, result.vertices, result.quads).max() < 0.5 * length
    assert scaled_jacobian(result.vertices, result.quads).mean() > 0.8


@pytest.mark.slow
@pytest.mark.skipif(
    not (COLLECTION / "dev" / "igl_beetle.obj").exists(), reason="no collection of meshes beside the repository"
)
def test_marks_that_no_valid_quads_have_room_for_give_way():
    vertices, polygons = read_mesh(COLLECTION / "dev" / "igl_beetle.obj")
    seed = [zlib.crc32(b"igl_beetle"), variants.VARIANTS.index("features")]
    marked = variants.random_walks(polygons, np.random.default_rng(seed))
    result = hybrid_quad.remesh(vertices, polygons, quads=100, sharp_angle=None, sharp_edges=marked)
    assert violations(result.vertices, result.quads) == []
    assert result.report["flawed_quads"] == 0
    given_way = result.report["marks_given_way"]
    assert 0 < given_way < 40
    assert any(
        f"{given_way} curves of marked edges or guides gave way" in warning for warning in result.report["warnings"]
    )
