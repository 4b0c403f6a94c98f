"""Cases that once failed, each in a folder with how it ends now: found by listing it."""

import json
from pathlib import Path

import pytest

import hybrid_quad
from fuzz.cases import load_case, make_case
from fuzz.verdict import arguments_of, verdict_of

FOLDER = Path(__file__).resolve().parents[1] / "data" / "regressions"
SEEDS = range(12)  # of random cases, besides


@pytest.mark.parametrize("name", sorted(path.name for path in FOLDER.glob("*") if (path / "options.json").exists()))
def test_what_once_failed(name):
    verdict = verdict_of(load_case(FOLDER / name), 60.0)
    expected = json.loads((FOLDER / name / "expected.json").read_text())
    assert {key: verdict[key] for key in expected} == expected, verdict


def test_tips_that_let_go_are_counted():
    case = load_case(FOLDER / "tips_that_let_go")
    report = hybrid_quad.remesh(case.vertices, case.faces, **arguments_of(case)).report
    assert (report["flawed_quads"], report["repairs"]["released_tips"]) == (0, 1)


@pytest.mark.parametrize("quads", [300, 700])
def test_few_flawed_quads_are_split_before_all_is_remeshed_anew(quads):
    case = load_case(FOLDER / "tips_that_let_go")
    report = hybrid_quad.remesh(case.vertices, case.faces, quads=quads).report
    assert (report["flawed_quads"], report["extra_passes"]) == (0, 0)
    assert report["repairs"]["split_sides"] > 0


def test_small_parts_leave_nothing_flawed_and_take_no_further_pass():
    case = load_case(FOLDER / "small_parts_shrink_to_points")
    report = hybrid_quad.remesh(case.vertices, case.faces, quads=2000).report
    assert (report["flawed_quads"], report["extra_passes"]) == (0, 0)


def test_the_rim_of_a_flap_thin_as_a_hair_is_no_feature():
    case = load_case(FOLDER / "rim_of_a_flap")
    for asked in ({"quads": 2000}, {"edge_length": 1.5}):
        report = hybrid_quad.remesh(case.vertices, case.faces, sharp_angle=40.0, **asked).report
        assert (report["flawed_quads"], report["extra_passes"]) == (0, 0), asked
        assert report["features_given_way"] > 0


def test_guides_and_counts_give_way_where_they_leave_flawed_quads():
    case = load_case(FOLDER / "guides_on_a_wire")
    report = hybrid_quad.remesh(case.vertices, case.faces, **arguments_of(case)).report
    assert (report["flawed_quads"], report["marks_given_way"]) == (0, 1)
    assert report["quads"] < 2 * case.options["quads"]
    assert [record["met"] for record in report["guides"]] == [False]
    assert [record["got"] == record["asked"] for record in report["curve_counts"]] == [False]
    assert any("marked edges or guides gave way" in warning for warning in report["warnings"])


@pytest.mark.parametrize("seed", SEEDS)
def test_random_surfaces_with_random_wishes(seed):
    verdict = verdict_of(make_case(seed), 60.0)
    assert verdict["outcome"] in ("valid", "refused"), verdict


def test_a_case_in_a_folder_is_the_same_case(tmp_path):
    case = make_case(3)
    case.save(tmp_path)
    again = load_case(tmp_path)
    assert (again.vertices == case.vertices).all()
    assert (again.faces, again.options) == (case.faces, case.options)
