"""What came of all assets, from their status files: as JSON and CSV."""

from __future__ import annotations

import csv
import io
import json
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from .. import __version__
from ..core.file_places import replacing
from . import asset_status
from .asset import Asset, BatchPlan, files_of
from .asset_status import AssetStatus, read_status

# Columns of the table, and where in a report they are found.
FIGURES: dict[str, tuple[str, ...]] = {
    "quads": ("quads",),
    "vertices": ("vertices",),
    "irregular_vertices": ("irregular_vertices",),
    "scaled_jacobian_mean": ("scaled_jacobian", "mean"),
    "scaled_jacobian_min": ("scaled_jacobian", "min"),
    "hausdorff_percent": ("hausdorff_percent",),
    "feature_hausdorff_percent": ("feature_hausdorff_percent",),
    "flawed_quads": ("flawed_quads",),
}


@dataclass(frozen=True)
class Line:
    """An asset in the summary.

    Attributes
    ----------
    status : AssetStatus
        Without settings and command, and of its report only the warnings: a summary is of a million assets too.
    figures : dict
        Values of `FIGURES`; None where there are none.
    asked_quads : int or None
        The number of quads that was aimed at, if one was.
    """

    status: AssetStatus
    figures: dict[str, Any]
    asked_quads: int | None

    def as_row(self) -> dict[str, Any]:
        """The line as flat values."""
        status = self.status
        return {
            "asset": status.asset,
            "status": status.status,
            "code": status.code,
            "message": status.message,
            "asked_quads": self.asked_quads,
            **self.figures,
            "seconds": status.seconds,
            "warnings": status.warnings,
            "source": status.source,
            "object": status.object,
            "result": status.result and str(Path(status.asset).parent / status.result),
        }


def collect(assets: Iterable[Asset], plan: BatchPlan) -> list[Line]:
    """Lines of all assets, in their order; those without a status file are pending."""
    lines = []
    for asset in assets:
        status = read_status(files_of(asset, plan).status)
        if status is None:
            status = AssetStatus(asset.name, asset.source, asset_status.PENDING, asset.object_name)
        figures = {name: _found(status.report, path) for name, path in FIGURES.items()}
        kept = replace(status, report={"warnings": status.warnings}, settings={}, limits={}, command=[])
        lines.append(Line(kept, figures, _asked(status)))
    return lines


def counts(lines: Sequence[Line]) -> dict[str, int]:
    """How many assets have which status, the successful ones first."""
    found = Counter(line.status.status for line in lines)
    return {name: found[name] for name in sorted(found, key=lambda name: (name != asset_status.OK, name))}


def failed_percent(lines: Sequence[Line]) -> float:
    """Share of the assets that have no result."""
    return 100 * sum(line.status.status != asset_status.OK for line in lines) / max(1, len(lines))


def write_summary(folder: Path, lines: Sequence[Line]) -> None:
    """Writes ``summary.json`` and ``summary.csv``.

    Raises
    ------
    MeshFileError
        If they cannot be written.
    """
    head = {"version": __version__, "assets": len(lines), "statuses": counts(lines)}
    with replacing(folder / "summary.json") as file:
        # Line by line, as the whole would take some times its size of memory.
        file.write((json.dumps(head, indent=1).removesuffix("\n}") + ',\n "lines": [').encode())
        for place, line in enumerate(lines):
            file.write((("," if place else "") + "\n  " + json.dumps(line.as_row())).encode())
        file.write(b"\n ]\n}\n")
    with replacing(folder / "summary.csv") as file:
        text = io.TextIOWrapper(file, "utf-8", newline="", write_through=True)
        writer = csv.DictWriter(text, list(lines[0].as_row()) if lines else ["asset"], lineterminator="\n")
        writer.writeheader()
        for row in (line.as_row() for line in lines):
            writer.writerow({**row, "warnings": " | ".join(row["warnings"])})
        text.detach()  # `replacing` closes the file


def _found(report: Any, path: Sequence[str]) -> Any:
    for name in path:
        report = report.get(name) if isinstance(report, dict) else None
    return report


def _asked(status: AssetStatus) -> int | None:
    options = status.report.get("options") or {}
    by_number = options.get("edge_length") is None and options.get("chord_error") is None
    return options.get("quads") if by_number else None
