"""From what a user names to assets with settings and names of their own."""

import csv
import json
import os
import pickle
import re

import pytest

from hybrid_quad.batch_jobs import settings, summary, summary_page
from hybrid_quad.batch_jobs.asset import Asset, BatchPlan, files_of
from hybrid_quad.batch_jobs.asset_lock import asset_lock
from hybrid_quad.batch_jobs.asset_range import in_range
from hybrid_quad.batch_jobs.asset_status import AssetStatus, read_status, stands, write_status
from hybrid_quad.batch_jobs.job_file import JobFileError, write_job_file
from hybrid_quad.batch_jobs.job_hash import job_hash
from hybrid_quad.batch_jobs.job_list import ObjectsUnknown, list_assets, list_lines
from hybrid_quad.cli import main as cli_main


def no_objects(path):
    raise ObjectsUnknown(f"{path}: no Blender here")


@pytest.fixture
def plan(tmp_path):
    return BatchPlan(output=str(tmp_path / "out"))


@pytest.fixture
def folder(tmp_path):
    for name in ("a.obj", "b.STL", "deep/er/c.ply", "notes.txt", ".hidden.obj", "out/a.obj"):
        path = tmp_path / "in" / name if not name.startswith("out") else tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(name)
    return tmp_path / "in"


def names(assets):
    return [asset.name for asset in assets]


def test_a_folder_a_pattern_and_files(folder, plan):
    assert names(list_assets([str(folder)], {}, plan, no_objects)) == ["a", "b", "deep/er/c"]
    assert names(list_assets([str(folder / "**" / "*.ply")], {}, plan, no_objects)) == ["deep/er/c"]
    assert names(list_assets([str(folder / "a.obj"), str(folder / "b.STL")], {}, plan, no_objects)) == ["a", "b"]


def test_results_are_no_inputs(folder, plan):
    assert names(list_assets([str(folder.parent)], {}, plan, no_objects)) == ["in/a", "in/b", "in/deep/er/c"]


def test_what_differs_in_its_suffix_only_gets_names_of_its_own(folder, plan):
    (folder / "A.off").write_text("")
    assert names(list_assets([str(folder)], {}, plan, no_objects))[:2] == ["A_off", "a_obj"]


def test_no_result_takes_the_place_of_an_input(folder):
    with pytest.raises(JobFileError, match="take the place"):
        list_assets([str(folder / "a.obj")], {}, BatchPlan(output=str(folder)), no_objects)


def test_the_folder_of_the_results_is_told_as_such(folder):
    plan = BatchPlan(str(folder))
    with pytest.raises(JobFileError, match="folder of the results"):
        list_assets([str(folder)], {}, plan, lambda _: [])


def test_nothing_found_is_said(folder, plan):
    for text in ("nowhere", str(folder / "*.blend")):
        with pytest.raises(JobFileError, match="no such file or folder"):
            list_assets([text], {}, plan, no_objects)


@pytest.mark.parametrize("form", ["csv", "json"])
def test_a_job_file(folder, plan, form):
    rows = [
        {"input": "a.obj", "quads": "300", "name": "hero"},
        {"input": "deep/**/*.ply", "sharp_angle": "none"},
        {"input": "b.STL", "quads": "many"},
        {"input": "missing.obj"},
        {"input": "no*match"},
        {"input": "a.obj", "name": "hero_fine", "edge_length": 0.25, "fit_limit": "yes"},
    ]
    path = folder / f"jobs.{form}"
    if form == "json":
        path.write_text(json.dumps(rows))
    else:
        columns = ["input", "name", "quads", "sharp_angle", "edge_length", "fit_limit"]
        path.write_text("\n".join([",".join(columns), *(",".join(str(r.get(c, "")) for c in columns) for r in rows)]))
    assets = list_assets([str(path)], {"quads": 2000, "sharp_angle": 30.0}, plan, no_objects)
    assert names(assets) == ["hero", "er/c", "b", "missing", "no_match", "hero_fine"]
    assert assets[0].settings == {"quads": 300, "sharp_angle": 30.0}
    assert assets[1].settings == {"quads": 2000, "no_sharp": True}
    assert "quads" in assets[2].problem and assets[4].problem
    # A length takes the place of the number for all.
    assert assets[5].settings == {"edge_length": 0.25, "fit_limit": True, "sharp_angle": 30.0}


def test_a_written_list_says_the_same(folder, plan, tmp_path):
    given = list_assets([str(folder)], {"quads": 300, "no_sharp": True}, plan, no_objects)
    write_job_file(tmp_path / "list.json", given)
    assert list_assets([str(tmp_path / "list.json")], {"quads": 7}, plan, no_objects) == given


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[{"input": "a.obj", "quats": 5}]', "quats"),
        ('[{"quads": 5}]', "no input"),
        ("[5]", "list of objects"),
        ("[", "no JSON"),
        ('[{"input": "a.obj", "name": "../a"}]', "relative path"),
        ('[{"input": "a.obj", "name": "x"}, {"input": "a.obj", "name": "X"}]', "two assets"),
    ],
)
def test_job_files_that_cannot_be_used(folder, plan, text, message):
    (folder / "jobs.json").write_text(text)
    with pytest.raises(JobFileError, match=message):
        list_assets([str(folder / "jobs.json")], {}, plan, no_objects)


def test_objects_of_a_blender_file(folder, plan):
    (folder / "scene.blend").write_text("")
    blend = [str(folder / "scene.blend")]
    found = list_assets(blend, {}, plan, lambda _: ["Cube", "a/b", "a:b"])
    assert names(found)[0] == "scene/Cube" and len(set(names(found))) == 3
    assert [asset.object_name for asset in found] == ["Cube", "a/b", "a:b"]
    assert "no Blender here" in list_assets(blend, {}, plan, no_objects)[0].problem


def test_the_settings_are_the_options_of_remesh():
    parser = cli_main._parser()
    options = vars(parser.parse_args(["remesh", "IN", "OUT"]))
    others = {"input", "output", "report", "picture", "dump_stages", "quiet", "end_with_stdin", "run"}
    assert set(options) - others == set(settings.KINDS)


def test_one_form_of_a_value(tmp_path):
    for given in (
        {"quads": 500, "no_sharp": True},
        {"quads": "500", "no_sharp": "yes"},
        {"quads": 500.0, "no_sharp": 1},
    ):
        assert settings.canonical(given, tmp_path) == {"no_sharp": True, "quads": 500}
    assert settings.canonical({"no_sharp": "false", "quads": "", "seed": None}, tmp_path) == {}
    with pytest.raises(settings.SettingError):
        settings.canonical({"quads": "5.5"}, tmp_path)


def test_ranges():
    items = list(range(20))
    assert in_range(items, "0-3") == [0, 1, 2, 3]
    assert in_range(items, "18-40, 2,2") == [2, 18, 19]
    assert [each for first in range(0, 20, 6) for each in in_range(items, f"{first}-{first + 5}")] == items
    with pytest.raises(ValueError, match="ends before"):
        in_range(items, "0-3,5-4")
    for text in ("", "a", "3-", "-3", "1;2"):
        with pytest.raises(ValueError):
            in_range(items, text)


def test_the_hash_is_of_all_that_makes_a_difference(tmp_path):
    plan = BatchPlan(output=str(tmp_path))
    mesh, density = tmp_path / "a.obj", tmp_path / "d.txt"
    mesh.write_text("v 0 0 0")
    density.write_text("1")
    asset = Asset("a", str(mesh), settings={"quads": 5, "density": str(density), "time_limit": 3.0})
    first = job_hash(asset, plan)
    # Where files lie, what assets are called, and limits: none.
    moved = tmp_path / "sub" / "b.obj"
    moved.parent.mkdir()
    moved.write_text("v 0 0 0")
    same = Asset("b", str(moved), settings={"quads": 5, "density": str(density), "threads": 2})
    assert job_hash(same, plan) == first
    seen = {first, job_hash(asset, plan, version="0.0.9"), job_hash(asset, BatchPlan(str(tmp_path), ".ply"))}
    seen.add(job_hash(Asset("a", str(mesh), settings={**asset.settings, "quads": 6}), plan))
    density.write_text("2")
    seen.add(job_hash(asset, plan))
    mesh.write_text("v 0 0 1")
    seen.add(job_hash(asset, plan))
    assert len(seen) == 6


def test_when_a_status_stands(tmp_path):
    (tmp_path / "a.obj").write_text("12345")
    good = AssetStatus("a", "s", "ok", job_hash="h", result="a.obj", result_bytes=5)
    write_status(tmp_path / "a.hq.json", good)
    assert read_status(tmp_path / "a.hq.json") == good
    assert stands(good, "h", {}, tmp_path) and not stands(good, "other", {}, tmp_path)
    (tmp_path / "a.obj").write_text("123")
    assert not stands(good, "h", {}, tmp_path)
    late = AssetStatus("a", "s", "time_limit", job_hash="h", limits={"time_limit": 5.0})
    assert stands(late, "h", {"time_limit": 5.0}, tmp_path) and not stands(late, "h", {"time_limit": 50.0}, tmp_path)
    assert not stands(AssetStatus("a", "s", "lost", job_hash="h"), "h", {}, tmp_path)
    (tmp_path / "a.hq.json").write_text('{"asset": "a"')
    assert read_status(tmp_path / "a.hq.json") is None


@pytest.mark.skipif(os.name != "posix", reason="locks of POSIX systems")
def test_a_lock_is_one_processes(tmp_path):
    with asset_lock(tmp_path / "lock", lambda: True) as first, asset_lock(tmp_path / "lock", lambda: True) as second:
        assert first is not None and second is None
    with asset_lock(tmp_path / "lock", lambda: True) as third:
        assert third is not None


def test_a_task_reads_its_lines_of_a_list_and_no_others(folder, plan, tmp_path):
    listed = tmp_path / "list.jsonl"
    assets = list_assets([str(folder)], {"quads": 300, "no_sharp": True}, plan, no_objects)
    write_job_file(listed, assets)
    assert list_assets([str(listed)], {}, plan, no_objects) == assets
    for text, chosen in (("1-2", assets[1:]), ("0,2", [assets[0], assets[2]]), ("2-99", assets[2:]), ("7", [])):
        assert list_lines(str(listed), text, {}, plan, no_objects) == chosen
    lines = listed.read_text().splitlines()
    listed.write_text("\n".join(["no JSON", lines[1], "", "{}"]) + "\n")
    assert list_lines(str(listed), "1", {}, plan, no_objects) == assets[1:2]
    with pytest.raises(JobFileError, match="no JSON"):
        list_lines(str(listed), "0", {}, plan, no_objects)
    with pytest.raises(JobFileError, match="has no input"):
        list_lines(str(listed), "2", {}, plan, no_objects)
    with pytest.raises(ValueError, match="ranges"):
        list_lines(str(listed), "a-b", {}, plan, no_objects)


@pytest.mark.parametrize("row", [{"input": "in", "name": "x"}, {"input": "in/a.obj"}])
def test_a_line_that_is_not_one_named_asset_is_no_line_to_count(folder, plan, tmp_path, row):
    listed = tmp_path / "list.jsonl"
    listed.write_text(json.dumps(row) + "\n")
    with pytest.raises(JobFileError, match="--write-list"):
        list_lines(str(listed), "0", {}, plan, no_objects)


def test_a_page_shows_what_a_browser_can_and_failures_first(tmp_path, plan, monkeypatch):
    monkeypatch.setattr(summary_page, "MOST_CARDS", 3)
    assets = [Asset(f"folder/asset{number}", "x.obj") for number in range(5)]
    for number, asset in enumerate(assets[:4]):
        path = files_of(asset, plan).status
        path.parent.mkdir(parents=True, exist_ok=True)
        report = {"quads": number, "warnings": [f"näher {number}"], "stages": [{"name": "x"}] * 1000}
        state = "ok" if number else "crashed"
        write_status(path, AssetStatus(asset.name, asset.source, state, report=report, settings={"quads": 5}))
    lines = summary.collect(assets, plan)
    summary.write_summary(tmp_path, lines)
    summary_page.write_page(tmp_path, lines)
    page = (tmp_path / "summary.html").read_text(encoding="utf-8")
    shown = re.findall(r"<h2>(.*?)</h2>", page)
    assert shown == ["folder/asset0", "folder/asset4", "folder/asset1"] and "3 of 5 assets" in page
    whole = json.loads((tmp_path / "summary.json").read_text())
    assert [line["asset"] for line in whole["lines"]] == [asset.name for asset in assets]
    assert whole["lines"][2]["quads"] == 2 and whole["lines"][2]["warnings"] == ["näher 2"]
    assert whole["statuses"] == {"ok": 3, "crashed": 1, "pending": 1}
    rows = list(csv.DictReader((tmp_path / "summary.csv").open(encoding="utf-8")))
    assert [row["warnings"] for row in rows] == [*(f"näher {n}" for n in range(4)), ""]
    # Of a million assets the reports would not fit into memory.
    assert len(pickle.dumps(lines)) < 5000
