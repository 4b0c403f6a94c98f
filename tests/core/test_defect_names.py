"""Whatever is wrong with a mesh, a person reads it in plain words."""

from __future__ import annotations

import re
from pathlib import Path

from hybrid_quad.core.defect_names import WORDS, in_words

ROOT = Path(__file__).resolve().parents[2]


def test_every_documented_code_has_words():
    page = (ROOT / "docs" / "interface.md").read_text(encoding="utf-8")
    table = page.split("| Code | Elements |")[1].split("\n\n")[0]
    cells = [line.split("|")[1] for line in table.splitlines()[2:]]
    codes = {code for cell in cells for code in re.findall(r"`(\w+)`", cell)}
    assert len(codes) > 20 and codes == WORDS.keys()


def test_every_code_that_sources_note_has_words():
    paths = (ROOT / "native" / "hybrid_quad" / "mesh").glob("*.cpp")
    pattern = r'"([a-z]+(?:_[a-z]+)+)", "(?:vertex|face|edge)"'
    codes = {code for path in paths for code in re.findall(pattern, path.read_text(encoding="utf-8"))}
    assert len(codes) > 12 and codes <= WORDS.keys()


def test_numbers_and_words_agree():
    assert in_words("flipped_face", 1) == "1 flipped face" and in_words("flipped_face", 2000) == "2,000 flipped faces"
    assert in_words("empty_mesh") == "mesh without faces" and in_words("of_the_future", 2) == "2 of the future"
    assert not any("_" in text for words in WORDS.values() for text in words)
