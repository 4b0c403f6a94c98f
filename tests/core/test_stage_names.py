"""Whatever stage a run can be in, a person reads what is being done in plain words."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import hybrid_quad
from hybrid_quad.core.options import RemeshOptions
from hybrid_quad.core.stage_names import WORDS, StageWatch, in_words, while_in

ROOT = Path(__file__).resolve().parents[2]
# How sources name a stage: literally, or as the first argument of what passes it on.
NATIVE = r'(?:in_stage|finish|InternalError|measure|require_sound)\(\s*"([^"]+)"'
PYTHON = r'(?:first_stage=|STAGE = |self\.stage = |InternalError\([^)]*, )"([^"]+)"'


def named_in(folder: str, pattern: str, endings: tuple[str, ...]) -> set[str]:
    paths = [path for path in (ROOT / folder).rglob("*") if path.suffix in endings]
    return {name for path in paths for name in re.findall(pattern, path.read_text(encoding="utf-8"))}


def test_every_stage_that_sources_name_has_words():
    native = named_in("native", NATIVE, (".cpp", ".h"))
    python = named_in("addon/hybrid_quad", PYTHON, (".py",))
    assert {"frame field", "count", "assemble", "morse-smale"} <= native and {"data_transfer", "validation"} <= python
    assert native | python <= WORDS.keys()


def test_sources_pass_no_stage_on_under_another_name():
    """Stages in variables are those of the literals above."""
    variables = named_in("native", r"InternalError\(\s*([a-z_]+)\s*,", (".cpp", ".h"))
    assert variables <= {"stage"}


def test_every_stage_that_a_run_tells_has_words():
    corner = np.arange(56).reshape(7, 8)[:, :-1].ravel()
    points = np.array([(x, y, 0.3 * np.sin(x)) for y in range(8) for x in range(8)], float)
    faces = np.stack([corner, corner + 1, corner + 9, corner + 8], axis=1)
    seen: set[str] = set()
    watch = StageWatch(lambda stage, _fraction: seen.add(stage))
    result = hybrid_quad.remesh(points, faces, quads=60, symmetry="auto", fit_limit_surface=True, progress=watch)
    hybrid_quad.preview(points, faces, RemeshOptions(quads=60), progress=watch)
    assert watch.stage in seen  # progress tells of some of them, as time goes by
    timed = {stage["name"] for stage in result.report["stages"]}
    assert len(timed) > 8 and (timed | seen) - {""} <= WORDS.keys()


def test_words_are_plain():
    for words in WORDS.values():
        assert len(words) <= 25, "longer ones do not fit into the sidebar"
        assert re.fullmatch(r"[a-z ]+", words) and words.split()[0].endswith("ing"), words
    assert while_in("data_transfer") == "while transferring data"
    assert while_in("") == "" and in_words("") == "starting"


@pytest.mark.parametrize("stage", ["some_new stage"])
def test_a_stage_without_words_shows_no_identifier(stage):
    assert in_words(stage) == "some new stage"
