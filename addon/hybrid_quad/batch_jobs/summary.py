"""What came of all assets, from their status files: as JSON and CSV."""

from __future__ import annotations

import csv
import io
import json
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import __version__
from ..core.mesh_io import replacing
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
        lines.append(Line(status, figures, _asked(status)))
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
    rows = [line.as_row() for line in lines]
    whole = {"version": __version__, "assets": len(lines), "statuses": counts(lines), "lines": rows}
    with replacing(folder / "summary.json") as file:
        file.write((json.dumps(whole, indent=1) + "\n").encode())
    text = io.StringIO(newline="")
    writer = csv.DictWriter(text, list(rows[0]) if rows else ["asset"], lineterminator="\n")
    writer.writeheader()
    writer.writerows({**row, "warnings": " | ".join(row["warnings"])} for row in rows)
    with replacing(folder / "summary.csv") as file:
        file.write(text.getvalue().encode())


def _found(report: Any, path: Sequence[str]) -> Any:
    for name in path:
        report = report.get(name) if isinstance(report, dict) else None
    return report


def _asked(status: AssetStatus) -> int | None:
    options = status.report.get("options") or {}
    by_number = options.get("edge_length") is None and options.get("chord_error") is None
    return options.get("quads") if by_number else None
