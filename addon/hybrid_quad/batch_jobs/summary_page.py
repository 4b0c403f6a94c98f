"""The summary as one HTML page that needs nothing else: styles and pictures are in it, and it runs no script."""

from __future__ import annotations

import base64
import html
from collections.abc import Sequence
from pathlib import Path

from .. import __version__
from ..core.file_places import replacing
from . import asset_status
from .summary import Line, counts

# A browser shows a page of some tens of megabytes, not of gigabytes.
MOST_PICTURES = 2000
MOST_CARDS = 10000

_STYLE = """
body { font: 14px/1.45 system-ui, sans-serif; margin: 2em auto; max-width: 1500px; padding: 0 1em; color: #222; background: #fff; }
h1 { font-size: 1.5em; } .ok { color: #1a7f37; } .bad { color: #b42318; } .pending, .quiet { color: #666; }
.assets { display: grid; grid-template-columns: repeat(auto-fill, minmax(260px, 1fr)); gap: 14px; }
.asset { border: 1px solid #ddd; border-radius: 6px; padding: 10px; overflow-wrap: anywhere; break-inside: avoid; }
.asset.failed { border-color: #b42318; } .asset img { width: 100%; height: auto; display: block; }
.asset h2 { font-size: 1em; margin: 0 0 4px; } dl { display: grid; grid-template-columns: auto auto; gap: 0 1em; margin: 6px 0; }
dt { color: #666; } dd { margin: 0; text-align: right; } ul { margin: 6px 0; padding-left: 1.2em; color: #8a4b00; }
@media (prefers-color-scheme: dark) { body { color: #ddd; background: #1b1b1b; } .asset { border-color: #444; }
 .ok { color: #56d364; } .bad { color: #ff7b72; } dt, .pending, .quiet { color: #999; } ul { color: #e3b341; } }
"""


def write_page(folder: Path, lines: Sequence[Line]) -> None:
    """Writes ``summary.html``: failures first, then the rest in their order, as far as a browser can show them.

    Raises
    ------
    MeshFileError
        If it cannot be written.
    """
    ordered = sorted(lines, key=lambda line: line.status.status == asset_status.OK)
    cards, shown = [], 0
    for line in ordered[:MOST_CARDS]:
        picture = _picture(folder, line) if shown < MOST_PICTURES else ""
        shown += bool(picture)
        cards.append(_card(line, picture))
    with replacing(folder / "summary.html") as file:
        file.write(_page(lines, cards, shown).encode())


def _page(lines: Sequence[Line], cards: Sequence[str], shown: int) -> str:
    total = ", ".join(
        f'<span class="{_class(name)}">{times} {_words(name)}</span>' for name, times in counts(lines).items()
    )
    drawn = sum(bool(line.status.picture) for line in lines)
    left_out = (
        f'<p class="quiet">Pictures of the first {shown} of {drawn} are in this page.</p>' if shown < drawn else ""
    )
    if len(cards) < len(lines):
        left_out += (
            f'<p class="quiet">This page shows {len(cards)} of {len(lines)} assets, those without a result first; '
            "summary.csv and summary.json have all.</p>"
        )
    quads = sum(line.figures["quads"] or 0 for line in lines if line.status.status == asset_status.OK)
    hours = sum(line.status.seconds for line in lines) / 3600
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
        f"<title>Hybrid Quad: {len(lines)} assets</title><style>{_STYLE}</style></head><body>\n"
        f"<h1>{len(lines)} assets: {total}</h1>\n"
        f"<p>{quads:,} quads; {hours:.2f} hours of runs; hybrid-quad {html.escape(__version__)}. In the pictures, three quads "
        "or fewer meet at orange vertices, five or more at blue ones.</p>\n"
        f'{left_out}<div class="assets">\n{"".join(cards)}</div></body></html>\n'
    )


def _card(line: Line, picture: str) -> str:
    status = line.status
    good = status.status == asset_status.OK
    parts = [f'<section class="asset{"" if good else " failed"}"><h2>{html.escape(status.asset)}</h2>']
    if picture:
        parts.append(f'<img alt="{html.escape(status.asset)}" src="data:image/png;base64,{picture}">')
    parts.append(f'<div class="{_class(status.status)}">{_words(status.status)}</div>')
    if status.message:
        code = f" [{html.escape(status.code)}]" if status.code not in ("", status.status) else ""
        parts.append(f"<div>{html.escape(status.message)}{code}</div>")
    rows = _rows(line) if good else [("seconds", f"{status.seconds:.1f}")] * bool(status.seconds)
    parts.append("<dl>" + "".join(f"<dt>{name}</dt><dd>{value}</dd>" for name, value in rows) + "</dl>")
    if status.warnings:
        parts.append("<ul>" + "".join(f"<li>{html.escape(text)}</li>" for text in status.warnings) + "</ul>")
    return "".join(parts) + "</section>\n"


def _rows(line: Line) -> list[tuple[str, str]]:
    figures = line.figures
    asked = f" (asked {line.asked_quads})" if line.asked_quads else ""
    return [
        ("quads", f"{figures['quads']}{asked}"),
        ("irregular vertices", str(figures["irregular_vertices"])),
        ("scaled Jacobian, mean", _number(figures["scaled_jacobian_mean"], 3)),
        ("scaled Jacobian, worst", _number(figures["scaled_jacobian_min"], 3)),
        ("distance, % of diagonal", _number(figures["hausdorff_percent"], 3)),
        ("of features, %", _number(figures["feature_hausdorff_percent"], 3)),
        *([("flawed quads", str(figures["flawed_quads"]))] if figures["flawed_quads"] else []),
        ("seconds", f"{line.status.seconds:.1f}"),
    ]


def _number(value: float | None, digits: int) -> str:
    return "-" if value is None else f"{value:.{digits}f}"


def _picture(folder: Path, line: Line) -> str:
    """A picture's bytes as text; empty where there is none."""
    if not line.status.picture:
        return ""
    path = (folder / line.status.asset).with_name(line.status.picture)
    return base64.b64encode(path.read_bytes()).decode() if path.is_file() else ""


def _class(status: str) -> str:
    return {asset_status.OK: "ok", asset_status.PENDING: "pending"}.get(status, "bad")


def _words(status: str) -> str:
    return html.escape(status.replace("_", " "))
