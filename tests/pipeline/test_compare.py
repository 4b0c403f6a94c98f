"""The comparison with peers: what is read of them, what is measured of features, and what a target says."""

import json

import numpy as np
import pytest

from chord import chord_error, feature_curves
from comparison import Case, Result, page
from hybrid_quad.core.mesh_arrays import as_polygons
from results import read_results
from runs import Outcome
from stored_peers import stored_results
from support import surfaces

TABLE = """
| model (triangles) | Instant Meshes | QuadriFlow | QuadWild-BiMDF |
|--|--|--|--|
| part (48) s | **invalid** (no_inverted) · 1890 · 37 · 0.76/-1.00 · 0.072 · f 2.76 · 0.2 s | fails (timeout) 180 s | \
1960 · 24 · 0.99/0.97 · 0.010 · f 0.30 · 11.0 s |
| toy (967) | 1892 · 105 · 0.37/0.01 · 0.120 · 0.2 s | \
**invalid** (a, b) · 1893 · 81 · -0.00/-0.69 · 0.127 · 1.5 s | not run |
"""


def test_the_stored_table_is_read(tmp_path):
    path = tmp_path / "README.md"
    path.write_text(TABLE)
    results = stored_results(path)
    assert set(results["part"]) == {"Instant Meshes", "QuadWild-BiMDF"}
    best = results["part"]["QuadWild-BiMDF"]
    assert best.valid and best.sharp and (best.quads, best.irregular, best.feature) == (1960, 24, 0.3)
    assert not results["part"]["Instant Meshes"].valid
    assert not results["toy"]["QuadriFlow"].sharp and results["toy"]["Instant Meshes"].feature is None
    assert stored_results(tmp_path / "none.md") == {}


def test_chord_error_of_a_circle_is_its_sagitta_and_of_a_box_nothing():
    angle = np.linspace(0, 2 * np.pi, 721)
    circle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    circle[-1] = circle[0]
    for count in (12, 40):
        length = 2 * np.pi / count
        assert chord_error([circle], length) == pytest.approx(1 - np.cos(np.pi / count), rel=0.02)
    vertices, faces = surfaces.box(4)
    points = np.asarray(vertices, float)
    curves = feature_curves(points, as_polygons(faces), 40)
    assert len(curves) == 12
    assert chord_error(curves, 0.3) == pytest.approx(0, abs=1e-12)
    assert chord_error([], 0.3) == 0


def _ours(**changes):
    values = {
        "quads": 2000, "irregular": 20, "jacobian_mean": 0.98, "jacobian_p1": 0.8, "jacobian_min": 0.5,
        "distance": 0.02, "largest": 0.5, "feature": 0.2, "seconds": 1.0, "singularities": 20,
    }  # fmt: skip
    return Result("hybrid-quad", "valid", True, **{**values, **changes})


def _case(ours, chord=0.2):
    peer = Result("QuadWild-BiMDF", "valid", False, quads=2000, irregular=20, distance=0.03, largest=0.6, feature=0.3)
    return Case("part", 2000, True, chord, [ours, peer])


def test_all_targets_are_met_by_what_is_as_good():
    text, good = page([_case(_ours())])
    assert good and "**no**" not in text


@pytest.mark.parametrize(
    "worse",
    [
        {"irregular": 31},
        {"singularities": 10},
        {"jacobian_mean": 0.96},
        {"jacobian_p1": 0.7},
        {"jacobian_min": 0.2},
        {"jacobian_min": 0.0},
        {"distance": 0.04},
        {"largest": 0.7},
        {"feature": 0.31},
    ],
    ids=str,
)
def test_a_target_that_is_missed_names_the_model(worse):
    text, good = page([_case(_ours(**worse))])
    assert not good
    missed = [line for line in text.splitlines() if "**no**" in line]
    assert missed and all("part 2000" in line for line in missed)


def test_an_invalid_peer_is_no_measure_for_irregular_vertices():
    peer = Result("QuadWild-BiMDF", "invalid", False, quads=2000, irregular=1, distance=0.03, feature=0.3)
    text, good = page([Case("part", 2000, True, 0.2, [_ours(), peer])])
    assert good, text


def test_results_of_any_build_are_read_and_of_named_ones_alone(tmp_path):
    path = tmp_path / "results.jsonl"
    outcomes = {
        "a_500_sharp": Outcome("a", 500, "sharp", "valid", build="one"),
        "b_500_sharp": Outcome("b", 500, "sharp", "valid", build="two"),
    }
    path.write_text(
        "".join(json.dumps({"name": name, **outcome.as_json()}) + "\n" for name, outcome in outcomes.items()) + '{"na'
    )
    assert read_results(path) == outcomes
    assert set(read_results(path, "two")) == {"b_500_sharp"}
    assert read_results(tmp_path / "none.jsonl") == {}
