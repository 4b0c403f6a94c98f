"""The tables of docs/parameters.md."""

from __future__ import annotations

import re
from pathlib import Path


def parameter_rows(root: Path) -> list[dict[str, str]]:
    """Every row of the page's tables, by the names of its columns."""
    rows: list[dict[str, str]] = []
    names: list[str] = []
    for line in (root / "docs" / "parameters.md").read_text().splitlines():
        if not line.startswith("|"):
            names = []
        elif not names:
            names = _cells(line)
        elif not set(line) <= set("|-: "):
            rows.append(dict(zip(names, _cells(line), strict=True)))
    return rows


def quoted(cell: str) -> list[str]:
    """What stands in backticks."""
    return re.findall(r"`([^`]+)`", cell)


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip().strip("|").split("|")]
