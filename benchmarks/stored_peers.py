"""What free peers did on the models, measured once and kept as a Markdown table (../shared/peers/README.md)."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from runs import ROOT

PEERS = ROOT.parent / "shared" / "peers" / "README.md"
QUADS = 2000  # asked in all of the table's runs

_ROW = re.compile(r"(\S+) \(\d+\)( s)?")
_CELL = re.compile(
    r"(?:\*\*invalid\*\* \((?P<failed>[^)]*)\) · )?(?P<quads>\d+) · (?P<irregular>\d+) · "
    r"(?P<p1>-?[\d.]+)/(?P<least>-?[\d.]+) · (?P<distance>[\d.]+) · (?:f (?P<feature>[\d.]+) · )?(?P<seconds>[\d.]+) s"
)


@dataclass(frozen=True)
class StoredResult:
    """A peer's mesh for one model as the judge saw it; distances in percent of the diagonal."""

    valid: bool
    sharp: bool  # made with the peer's sharp edges
    quads: int
    irregular: int
    jacobian_p1: float
    jacobian_min: float
    distance: float
    feature: float | None
    seconds: float


def stored_results(path: Path = PEERS) -> dict[str, dict[str, StoredResult]]:
    """By model and peer; peers that gave no mesh are left out, and everything is where there is no such file."""
    results: dict[str, dict[str, StoredResult]] = {}
    if not path.exists():
        return results
    names: list[str] = []
    for line in path.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if cells[0].startswith("model"):
            names = cells[1:]
        head = _ROW.fullmatch(cells[0])
        if not head or not names:
            continue
        of_model = results.setdefault(head[1], {})
        for name, cell in zip(names, cells[1:], strict=False):
            found = _CELL.match(cell)
            if found:
                of_model[name] = StoredResult(
                    valid=found["failed"] is None,
                    sharp=bool(head[2]),
                    quads=int(found["quads"]),
                    irregular=int(found["irregular"]),
                    jacobian_p1=float(found["p1"]),
                    jacobian_min=float(found["least"]),
                    distance=float(found["distance"]),
                    feature=float(found["feature"]) if found["feature"] else None,
                    seconds=float(found["seconds"]),
                )
    return results
