"""docs/exceptions.md: the text, and what exceptions.py measured as tables."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import shape_causes as causes
from exceptions_pictures import number_of
from shape_causes import CAUSES, OPEN, Measured

MEANING = {
    causes.TIP: f"a worst corner of the quad sits in a corner of kept lines (features or the boundary) of less than "
    f"{causes.ACUTE_DEGREES:.0f}°, whose sine no quad there can exceed; what is beside it is squeezed between the same two lines",
    causes.LINES: f"two kept lines, or two parts of one, or two of their corners, are less than {causes.NEAR_LINES} edges apart on "
    f"a connected piece of surface, within {causes.NEAR_LINES} edges of the quad: vertices have to be on both",
    causes.FOLD: f"the surface's normals differ by more than {causes.FOLD_DEGREES:.0f}° within the radius of a quad, without a kept "
    "line between: more than at any one right-angled edge",
    causes.NECK: f"a tube, hole, finger or pit with room for fewer than {causes.AROUND:.0f} edges around it",
    causes.SHEET: f"the surface's other side is less than {causes.THIN} edges away, and its rim less than one edge",
    OPEN: "none of these: the surface has room for a better quad, and it is this program that did not find it",
}

INTRODUCTION = """\
# Badly shaped quads, and why

Every result is checked to be a valid mesh ([Why the result is valid](guarantee.md)), but a valid quad may be concave or nearly a
triangle: its scaled Jacobian, the smallest sine of its corners' angles, is then zero or less. This page lists every run of the
benchmark ([results](results.md)) in which that happens, with what the *input* is like at each such quad. It is written by one
command ([benchmarks/README.md](../benchmarks/README.md)), pictures included.

Lengths are in *edges*: the side of a square with the area that each of the asked quads gets. Only measurements on the input
surface decide, and the first cause of this list that holds is the one named:
"""

LIMITS = """\
## What this can and cannot say

- A cause that holds shows that the input has detail smaller than a quad there. It does not prove that nothing better is possible:
  many quads at such places have a good shape. The last column of the table says how many of the quads with a scaled Jacobian of
  0.3 or more (60 at random from the same run) have *no* cause; where these are few, the whole model is below the size of its quads,
  and more quads are the remedy.
- *Open* quads are faults of this program.
- Lines count where the result's edges follow them. Features by angle that gave way to the number of quads do not.
- "Edges around" is looked for at 1, 2, 3 and just under 4 edges, in balls around the quad as wide as a tube of that length around.
"""


def line(row: dict[str, Any]) -> str:
    """Of one run, for the terminal."""
    return f"{row['name']}: minimum {row['minimum']:.3f}, {len(row['quads'])} quads, {_causes_of(row)}"


def page(rows: Sequence[dict[str, Any]], runs: int, sheets: dict[str, Path], folder: Path) -> str:
    """Markdown.

    Parameters
    ----------
    rows : list of dict
        What exceptions.py measured of each run with bad quads.
    runs : int
        That the sweep has.
    sheets : dict
        Pictures of each cause.
    folder : Path
        Where the page will be.
    """
    quads = [quad for row in rows for quad in row["quads"]]
    counts = Counter(quad["cause"] for quad in quads)
    worst = Counter(row["quads"][0]["cause"] for row in rows)
    lines = [INTRODUCTION]
    lines += [f"{number}. **{cause}**: {MEANING[cause]}." for number, cause in enumerate(CAUSES, 1)]
    lines += ["", f"Of {runs} runs, {len(rows)} have such quads, {len(quads)} in all:", ""]
    lines += ["| cause | quads | runs whose worst quad has it | runs with any |", "|---|--:|--:|--:|"]
    for cause in CAUSES:
        having = sum(any(quad["cause"] == cause for quad in row["quads"]) for row in rows)
        lines.append(f"| {cause} | {counts[cause]} | {worst[cause]} | {having} |")
    lines += ["", "## Every run", ""]
    lines += ["In brackets the number measured at the worst quad of each cause.", ""]
    lines += ["| model | quads (asked) | sharp edges | SJ min | quads ≤ 0 | causes | no cause holds at good quads |"]
    lines += ["|---|--:|---|--:|--:|---|--:|"]
    lines += [_row(row) for row in rows]
    lines += ["", *_open(rows), LIMITS]
    if sheets:
        lines += ["## Pictures", ""]
        lines += [
            "For each run its worst quad, and its worst open one. Left the input, right the edges of the quads, two rings around; "
            "orange: quads with a scaled Jacobian of zero or less; red: kept lines. Above each: model, asked quads, setting, the "
            "quad's scaled Jacobian, what was measured.",
            "",
        ]
        for cause, picture in sheets.items():
            lines += [
                f"### {cause[0].upper()}{cause[1:]}",
                "",
                f"![{cause}]({picture.relative_to(folder).as_posix()})",
                "",
            ]
    return "\n".join(lines).rstrip() + "\n"


def _row(row: dict[str, Any]) -> str:
    sharp = "40°" if row["setting"] == "sharp" else "no"
    given = f", {row['features_given_way']} edges gave way" if row["features_given_way"] else ""
    return (
        f"| {row['model']} | {row['got']} ({row['asked']}) | {sharp}{given} | {row['minimum']:.3f} | {len(row['quads'])} "
        f"| {_causes_of(row)} | {100 * row['others'][OPEN]:.0f} % |"
    )


def _causes_of(row: dict[str, Any]) -> str:
    counts = Counter(quad["cause"] for quad in row["quads"])
    parts = []
    for cause in (cause for cause in CAUSES if counts[cause]):
        worst = next(quad for quad in row["quads"] if quad["cause"] == cause)
        number = number_of(Measured.of_json(worst["at"]), cause)
        parts.append(f"{cause} {counts[cause]}{number and f' ({number})'}")
    return ", ".join(parts)


def _open(rows: Sequence[dict[str, Any]]) -> list[str]:
    """A table of the open quads, those of small models first."""
    found = [(row, quad) for row in rows for quad in row["quads"] if quad["cause"] == OPEN]
    if not found:
        return []
    lines = [
        "## Open ones",
        "",
        "| run | triangles | quad | SJ | fold | nearest lines | most degrees of a quad on a line |",
    ]
    lines += ["|---|--:|--:|--:|--:|--:|--:|"]
    for row, quad in found:
        at = Measured.of_json(quad["at"])
        near = min(at.gap, at.corners)
        lines.append(
            f"| {row['name']} | {row['faces']} | {quad['quad']} | {quad['sj']:.3f} | {at.fold:.0f}° "
            f"| {f'{near:.2f}' if near < 100 else '-'} | {f'{at.degrees_a_quad:.0f}°' if at.degrees_a_quad else '-'} |"
        )
    return [*lines, ""]
