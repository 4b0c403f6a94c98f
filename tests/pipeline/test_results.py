"""Whole runs on surfaces of every topology."""

import json
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import hybrid_quad
from fuzz.cases import load_case
from hybrid_quad.core import report
from hybrid_quad.core.validation import scaled_jacobian
from support import surfaces
from support.children import from_a_shell
from support.results import assert_sound, distance_to_edges

FLAP = Path(__file__).resolve().parents[1] / "data" / "regressions" / "rim_of_a_flap"

SURFACES = {
    "sphere": surfaces.sphere(10),
    "torus": surfaces.torus(),
    "box": surfaces.box(8),
    "flat_box": surfaces.box(8, (3.0, 2.0, 0.2)),
    "grid": surfaces.grid(20, 15, 2.0, 1.5),
    "wavy_grid": surfaces.wavy_grid(),
    "annulus": surfaces.annulus(),
    "cylinder": surfaces.cylinder(),
    "two_bodies": surfaces.together(surfaces.torus(), surfaces.box(5)),
    "open_and_closed": surfaces.together(surfaces.sphere(6), surfaces.grid(8, 8)),
    "quads": surfaces.quad_box(6),
    "mixed_polygons": surfaces.mixed_polygons(),
}

REPORT_FIELDS = {
    *("status", "quads", "vertices", "irregular_vertices", "field_singularities", "dislocations"),
    *("feature_singularities", "field_solutions"),
    *("singular_area_fraction", "patches", "scaled_jacobian", "hausdorff_percent", "feature_hausdorff_percent"),
    "sharp_angle_used",
    *("stages", "warnings", "seed", "version", "options"),
}


@pytest.mark.parametrize("sharp_angle", [40.0, None], ids=["sharp", "no_sharp"])
@pytest.mark.parametrize("name", SURFACES)
def test_every_topology_gives_a_sound_mesh(name, sharp_angle):
    vertices, faces = SURFACES[name]
    result = hybrid_quad.remesh(vertices, faces, quads=400, sharp_angle=sharp_angle)
    assert_sound(result, faces)
    assert scaled_jacobian(result.vertices, result.quads).mean() > 0.8


@pytest.mark.parametrize("quads", [6, 50, 3000])
def test_few_and_many_quads(quads):
    vertices, faces = SURFACES["torus"]
    result = hybrid_quad.remesh(vertices, faces, quads=quads)
    assert_sound(result, faces)


@pytest.mark.parametrize("name", ["sphere", "torus", "box", "wavy_grid", "annulus"])
def test_the_count_is_near_the_asked_one(name):
    vertices, faces = SURFACES[name]
    result = hybrid_quad.remesh(vertices, faces, quads=1500)
    assert abs(len(result.quads) / 1500 - 1) <= 0.1


def test_sheets_in_one_place_keep_the_shape_of_their_quads():
    """So small that no judge tells which sheet a quad agrees with: none is changed for that alone."""
    vertices, faces = SURFACES["torus"]
    result = hybrid_quad.remesh(vertices * (1.0, 1.0, 0.0), faces, quads=9000)
    shapes = scaled_jacobian(result.vertices, result.quads)
    assert result.report["repairs"]["mended_places"] < 0.05 * len(result.quads)
    assert shapes.mean() > 0.9


def test_edge_length():
    vertices, faces = surfaces.grid(20, 20, 4.0, 4.0)
    result = hybrid_quad.remesh(vertices, faces, edge_length=0.25)
    corners = result.vertices[result.quads]
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    assert lengths.mean() == pytest.approx(0.25, rel=0.1)


def test_edges_too_long_for_the_surface_are_told_as_lengths():
    result = hybrid_quad.remesh(*SURFACES["torus"], edge_length=2.0)
    assert any(warning.startswith("edges as long as asked make 4 quads, got ") for warning in result.report["warnings"])


def test_sharp_edges_and_corners_are_kept():
    vertices, faces = SURFACES["box"]
    result = hybrid_quad.remesh(vertices, faces, quads=600)
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    nearest = np.linalg.norm(result.vertices[:, None] - corners, axis=-1)
    assert (nearest.min(axis=0) < 1e-12).all()
    assert set(nearest.argmin(axis=0)) <= set(np.flatnonzero(result.vertex_kinds == 2))
    t = np.linspace(0, 1, 50)
    for axis in range(3):
        for a in (0, 1):
            for b in (0, 1):
                line = np.empty((len(t), 3))
                line[:, axis], line[:, (axis + 1) % 3], line[:, (axis + 2) % 3] = t, a, b
                assert distance_to_edges(line, result).max() < 1e-9


def test_the_report_says_that_edges_had_to_be_sharper_than_asked():
    """On a rough surface no angle below its roughest edges tells anything apart; a box has none to raise it for."""
    vertices, faces = surfaces.sphere(24)
    rough = vertices * (1 + 0.006 * np.random.default_rng(1).standard_normal(len(vertices)))[:, None]
    report = hybrid_quad.remesh(rough, faces, quads=600, sharp_angle=20).report
    assert report["sharp_angle_used"] > 20
    assert any("not 20, to be kept" in warning for warning in report["warnings"])
    box = hybrid_quad.remesh(*SURFACES["box"], quads=600, sharp_angle=20).report
    assert box["sharp_angle_used"] == 20
    assert not any("to be kept" in warning for warning in box["warnings"])
    assert hybrid_quad.remesh(*SURFACES["box"], quads=600, sharp_angle=None).report["sharp_angle_used"] is None


def test_the_boundary_is_kept():
    vertices, faces = SURFACES["grid"]
    result = hybrid_quad.remesh(vertices, faces, quads=300)
    t = np.linspace(0, 1, 50)
    for x, y in ((2 * t, 0 * t), (2 * t, 0 * t + 1.5), (0 * t, 1.5 * t), (0 * t + 2, 1.5 * t)):
        assert distance_to_edges(np.column_stack([x, y, 0 * t]), result).max() < 1e-9


def test_marked_edges_become_edges_of_the_result():
    vertices, faces = surfaces.grid(20, 20, 2.0, 2.0)
    marked = [(21 * row + 8, 21 * (row + 1) + 8) for row in range(20)]
    result = hybrid_quad.remesh(vertices, faces, quads=300, sharp_angle=None, sharp_edges=marked)
    assert_sound(result, faces)
    line = np.column_stack([np.full(50, 0.8), np.linspace(0, 2, 50), np.zeros(50)])
    assert distance_to_edges(line, result).max() < 1e-9


def test_the_report_has_every_field_and_fits_json():
    vertices, faces = SURFACES["box"]
    result = hybrid_quad.remesh(vertices, faces, quads=300, seed=5)
    made = json.loads(report.as_text(result.report))
    assert set(made) >= REPORT_FIELDS
    assert made["status"] == "ok"
    assert set(made["scaled_jacobian"]) == {"mean", "p1", "min"}
    assert -1 <= made["scaled_jacobian"]["min"] <= made["scaled_jacobian"]["p1"] <= 1
    assert set(made["patches"]) == {"count", "morse_smale", "combinatorial", "combinatorial_area_fraction"}
    assert made["stages"]
    assert all(set(stage) == {"name", "seconds", "peak_mb"} for stage in made["stages"])
    assert made["seed"] == made["options"]["seed"] == 5
    assert made["version"] == hybrid_quad.__version__


def test_the_stages_take_the_time_of_the_run():
    """On one thread no two of them run side by side, and next to nothing is done outside of them; on a busy machine the
    processor's time is less than the clock's."""
    begin, begin_used = time.perf_counter(), time.process_time()
    result = hybrid_quad.remesh(*surfaces.torus(150, 60), quads=4000, threads=1)
    whole, used = time.perf_counter() - begin, time.process_time() - begin_used
    seconds = [stage["seconds"] for stage in result.report["stages"]]
    assert min(seconds) >= 0
    assert 0.7 * used < sum(seconds) <= whole


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="only Linux tells the peak there")
def test_the_reported_peak_is_that_of_the_process():
    """Against what the kernel says of the program alone: to the number that the report has, it adds what the program took
    that started it, wherefore a shell stands between."""
    code = (
        f"import json, re, sys; sys.path.insert(0, {str(surfaces.__file__).rsplit('/support/', 1)[0]!r})\n"
        "from support import surfaces\n"
        "import hybrid_quad\n"
        "stages = hybrid_quad.remesh(*surfaces.torus(100, 40), quads=20000, threads=1).report['stages']\n"
        "peak = int(re.search(r'VmHWM:\\s*(\\d+) kB', open('/proc/self/status').read())[1]) / 1024\n"
        "print(json.dumps([stages[0]['peak_mb'], stages[-1]['peak_mb'], peak]))\n"
    )
    child = subprocess.run(from_a_shell([sys.executable, "-c", code]), check=True, stdout=subprocess.PIPE, timeout=120)
    first, last, peak = json.loads(child.stdout)
    assert first < 0.8 * last
    assert last == pytest.approx(peak, rel=0.1)


def test_the_reported_quality_is_that_of_the_mesh():
    vertices, faces = SURFACES["wavy_grid"]
    result = hybrid_quad.remesh(vertices, faces, quads=500)
    quality = scaled_jacobian(result.vertices, result.quads)
    assert result.report["scaled_jacobian"]["mean"] == pytest.approx(quality.mean(), abs=1e-6)
    assert result.report["scaled_jacobian"]["min"] == pytest.approx(quality.min(), abs=1e-6)


@pytest.mark.parametrize("solver", ["multilevel", "eigen"])
def test_both_solvers(solver):
    vertices, faces = SURFACES["wavy_grid"]
    result = hybrid_quad.remesh(vertices, faces, quads=300, solver=solver)
    assert_sound(result, faces)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_scale_does_not_matter(scale):
    vertices, faces = SURFACES["two_bodies"]
    usual = hybrid_quad.remesh(vertices, faces, quads=300)
    scaled = hybrid_quad.remesh(vertices * scale, faces, quads=300)
    assert_sound(scaled, faces)
    assert len(scaled.quads) == pytest.approx(len(usual.quads), rel=0.1)


def test_a_power_of_two_gives_the_same_mesh_scaled():
    vertices, faces = SURFACES["wavy_grid"]
    usual = hybrid_quad.remesh(vertices, faces, quads=300)
    scaled = hybrid_quad.remesh(vertices * 2.0**10, faces, quads=300)
    assert np.array_equal(scaled.quads, usual.quads)
    assert np.array_equal(scaled.vertices, usual.vertices * 2.0**10)


def test_a_place_far_from_the_origin():
    vertices, faces = SURFACES["torus"]
    offset = np.array([1e5, -2e5, 3e5])
    result = hybrid_quad.remesh(vertices + offset, faces, quads=300)
    assert_sound(result, faces)
    assert np.abs(result.vertices - offset).max() < 1.5


def test_the_surface_is_not_left():
    vertices, faces = SURFACES["torus"]
    result = hybrid_quad.remesh(vertices, faces, quads=800)
    x, y, z = result.vertices.T
    off = np.abs(np.hypot(np.hypot(x, y) - 1, z) - 0.4)
    assert off.max() < 0.03
    assert result.report["hausdorff_percent"] < 2


def test_orientation_is_the_input_s():
    vertices, faces = SURFACES["sphere"]
    for way, sign in ((faces, 1), (faces[:, ::-1], -1)):
        result = hybrid_quad.remesh(vertices, way, quads=200)
        a, b, c, d = result.vertices[result.quads].transpose(1, 0, 2)
        volume = np.einsum("ij,ij->i", a + b + c + d, np.cross(c - a, d - b)).sum()
        assert np.sign(volume) == sign


def test_flawed_quads_are_named():
    # A box and a flap ten thousand times as long as wide, which gets few quads: one of them has no way to lie right.
    case = load_case(FLAP)
    result = hybrid_quad.remesh(case.vertices, case.faces, quads=80)
    report = result.report
    assert report["flawed_quads"] > 0, "mended: another case has to stand for it"
    assert len(report["flawed_faces"]) == report["flawed_quads"]
    assert all(0 <= face < len(result.quads) for face in report["flawed_faces"])
    (warning,) = (warning for warning in report["warnings"] if "point" in warning)
    assert f"face {report['flawed_faces'][0]}" in warning

    sound = hybrid_quad.remesh(*SURFACES["torus"], quads=400)
    assert (sound.report["flawed_quads"], sound.report["flawed_faces"]) == (0, [])
