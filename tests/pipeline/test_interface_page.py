"""docs/interface.md names all that a report, an error and the command line can hold, so that users find what they meet."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import hybrid_quad
from hybrid_quad.cli.main import _parser
from support import surfaces

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "interface.md").read_text(encoding="utf-8")

# Mistakes of who calls the library; Python raises ValueError before.
LIBRARY_ONLY = {"wrong_count", "non_finite_stroke"}


def fields_of(value: Any) -> Iterator[str]:
    if isinstance(value, dict):
        yield from value
        for inner in value.values():
            yield from fields_of(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from fields_of(inner)


def test_every_field_of_a_report_is_told():
    vertices, faces = surfaces.quad_box(3)
    line = hybrid_quad.Stroke([[-0.3, 0.1, 1.0], [0.3, 0.1, 1.0]], 1.0, "loop")
    path = [int(vertex) for vertex in faces[0][:2]]
    result = hybrid_quad.remesh(
        vertices, faces, quads=200, strokes=[line], curve_counts=[(path, 3)], symmetry="auto", fit_limit_surface=True
    )
    told = {name for name, value in result.report.items() if name != "options"}
    told |= set(fields_of({name: value for name, value in result.report.items() if name != "options"}))
    missing = {name for name in told if f"`{name}`" not in PAGE}
    assert not missing


def test_every_code_of_an_error_is_told():
    sources = [path for folder in ("native/hybrid_quad", "addon") for path in (ROOT / folder).rglob("*")]
    text = "\n".join(path.read_text(encoding="utf-8") for path in sources if path.suffix in (".cpp", ".py"))
    codes = set(re.findall(r'\bInputError\(\s*"([a-z_]*[a-z])"', text)) - LIBRARY_ONLY
    assert len(codes) > 10
    missing = {code for code in codes if f"`{code}`" not in PAGE}
    assert not missing


def test_every_flag_of_remesh_is_told():
    asked = vars(_parser().parse_args(["remesh", "in.obj", "out.obj"]))
    missing = {
        name for name in asked if name not in ("run", "input", "output") and f"--{name.replace('_', '-')}" not in PAGE
    }
    assert not missing
