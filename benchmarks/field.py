#!/usr/bin/env python3
"""How many singularities the frame fields have, and how many irregular vertices the meshes, as Markdown.

Two tables. The first sets each model's field at 2000 quads against the irregular vertices of the best peer whose result
an independent judge found valid (../shared/peers). The second sets each mesh's irregular vertices against its field's
singularities, for closed models at 2000 and 8000 quads. Runs are taken from a sweep's results.jsonl; what is missing
there is run.
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from results import build_id, read_results
from runs import COLLECTION, JUDGE, ROOT, SETTINGS, Limits, Outcome, Run, run_and_judge
from stored_peers import PEERS, stored_results

COUNTED = """
*Field*: vertices inside the surface around which the field turns by a quarter or more, on feature curves and off them.
A cube's corner is one (three quads meet there whatever is done), as it is an irregular vertex of the mesh, and so is the
vertex that a quad at an acute tip between features forces beside it; vertices on the boundary are neither.
"""


@dataclass(frozen=True)
class Peer:
    """A peer's result on a model at 2000 quads."""

    name: str
    irregular: int
    sharp: bool  # made with the peer's sharp edges


def main() -> int:
    """Prints both tables and what they add up to; exit status 1 if a target is missed."""
    arguments = _parser().parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    source = _Runs(arguments.results, arguments.out, arguments.no_judge)
    models = [
        path
        for path in sorted(arguments.models.glob("*.obj"))
        if not arguments.only or any(part in path.stem for part in arguments.only)
    ]
    if not models or not (arguments.models / "index.csv").exists():
        print(f"no models with an index.csv in {arguments.models}", file=sys.stderr)
        return 2
    lines, good = _beside_peers(source, models, best_valid_peers(arguments.peers))
    text, kept = _irregular_by_field(source, _closed(models, arguments.models), arguments.quads)
    lines += ["", *text]
    page = "\n".join(lines) + "\n"
    (arguments.out / "field.md").write_text(page)
    print(page)
    return 0 if good and kept else 1


def best_valid_peers(path: Path) -> dict[str, Peer]:
    """The valid result with the fewest irregular vertices for each model that has one, from the peers' table."""
    best: dict[str, Peer] = {}
    for model, of_model in stored_results(path).items():
        valid = [Peer(name, result.irregular, result.sharp) for name, result in of_model.items() if result.valid]
        if valid:
            best[model] = min(valid, key=lambda peer: peer.irregular)
    return best


class _Runs:
    """Outcomes of runs, from a sweep or made now."""

    def __init__(self, results: Path, out: Path, no_judge: bool) -> None:
        self._out = out
        self._judge = None if no_judge else JUDGE
        self._build = build_id()
        self._done = {**read_results(results, self._build), **read_results(out / "results.jsonl", self._build)}

    def outcomes(self) -> list[Outcome]:
        return list(self._done.values())

    def __call__(self, path: Path, quads: int, setting: str) -> Outcome:
        run = Run(path.stem, path, quads, setting)
        if run.name not in self._done:
            outcome = run_and_judge(run, self._out, Limits(), self._judge, keep_meshes=False)
            self._done[run.name] = outcome
            with (self._out / "results.jsonl").open("a") as file:
                file.write(json.dumps({"name": run.name, **outcome.as_json(), "build": self._build}) + "\n")
            print(f"{run.name}: {outcome.status}, {outcome.seconds:.1f} s", file=sys.stderr, flush=True)
        return self._done[run.name]


def _beside_peers(source: _Runs, models: Sequence[Path], peers: dict[str, Peer]) -> tuple[list[str], bool]:
    lines = ["## Fields beside the best valid peer, 2000 quads", COUNTED]
    header = ("model", "sharp edges", "field (on features)", "irregular", "best peer", "its irregular", "no more")
    lines += ["| " + " | ".join(header) + " |"]
    lines += ["|---|---|--:|--:|---|--:|---|"]
    counted = fewer = 0
    for path in models:
        peer = peers.get(path.stem)
        if peer is None:
            continue
        outcome = source(path, 2000, "sharp" if peer.sharp else "no_sharp")
        if "quads" not in outcome.report:
            lines.append(f"| {path.stem} | | {outcome.status} | | {peer.name} | {peer.irregular} | no |")
            counted += 1
            continue
        field, mesh = field_singularities(outcome), irregular_vertices(outcome)
        on_features = outcome.report["feature_singularities"]
        counted += 1
        fewer += field <= peer.irregular
        lines.append(
            f"| {path.stem} | {'yes' if peer.sharp else 'no'} | {field} ({on_features}) | {mesh} "
            f"| {peer.name} | {peer.irregular} | {'yes' if field <= peer.irregular else '**no**'} |"
        )
    share = fewer / counted if counted else 1.0
    lines += [
        "",
        f"No more in the field than the best peer has in its mesh: {fewer} of {counted} models ({share:.0%}).",
    ]
    lines += _solutions(source.outcomes())
    return lines, share >= 0.7


def _solutions(outcomes: Iterable[Outcome]) -> list[str]:
    """How often each of the field's two solutions was the better one, over components."""
    records = [outcome.report["field_solutions"] for outcome in outcomes if "field_solutions" in outcome.report]
    kept = [sum(record[name]["kept"] for record in records) for name in ("relaxed", "smoothest")]
    fewer = [
        sum(record[one]["singularities"] < record[other]["singularities"] for record in records)
        for one, other in (("relaxed", "smoothest"), ("smoothest", "relaxed"))
    ]
    return [
        "",
        f"Of the two solutions the relaxed one was kept for {kept[0]} components and the smoothest for {kept[1]}; "
        f"in {len(records)} runs the relaxed one had fewer singularities in {fewer[0]}, the smoothest in {fewer[1]}.",
    ]


def _irregular_by_field(source: _Runs, models: Sequence[Path], counts: Sequence[int]) -> tuple[list[str], bool]:
    lines = ["## Irregular vertices over field singularities, closed models", COUNTED]
    lines += ["| model | " + " | ".join(f"{quads} {name}" for quads in counts for name in SETTINGS) + " |"]
    lines += ["|---|" + "--:|" * (len(counts) * len(SETTINGS))]
    columns = [(quads, setting) for quads in counts for setting in SETTINGS]
    ratios: dict[tuple[int, str], list[float]] = {column: [] for column in columns}
    for path in models:
        cells = []
        for column in columns:
            outcome = source(path, *column)
            if "quads" not in outcome.report:
                cells.append(outcome.status)
                ratios[column].append(float("inf"))
                continue
            field, mesh = field_singularities(outcome), irregular_vertices(outcome)
            ratio = mesh / field if field else (1.0 if mesh == 0 else float("inf"))
            ratios[column].append(ratio)
            left = outcome.report["dislocations"]
            cells.append(f"{mesh} / {field} = {ratio:.2f}" + (f" ({left} left)" if left else ""))
        lines.append(f"| {path.stem} | " + " | ".join(cells) + " |")
    medians = {column: median(values) if values else 1.0 for column, values in ratios.items()}
    lines.append("| **median** | " + " | ".join(f"**{medians[column]:.2f}**" for column in columns) + " |")
    lines += ["", "In brackets: dislocations left after cancellation. Targets: 1.00 without sharp edges, 1.15 with."]
    most = {"sharp": 1.15, "no_sharp": 1.0}
    return lines, all(value <= most[setting] for (_, setting), value in medians.items())


def field_singularities(outcome: Outcome) -> int:
    """Of the field, inside the surface, on features and off them."""
    return int(outcome.report["field_singularities"])


def irregular_vertices(outcome: Outcome) -> int:
    """Of the mesh, inside the surface; the judge's count where it spoke."""
    return int(outcome.judgement.get("irregular", outcome.report["irregular_vertices"]))


def _closed(models: Sequence[Path], folder: Path) -> list[Path]:
    with (folder / "index.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["edge_mf"] == row["vert_mf"] == "y"]
    closed = {row["name"] for row in rows if row["loops"] == "0"}
    return [path for path in models if path.stem in closed]


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    out = ROOT / "out"
    parser.add_argument(
        "--models", type=Path, default=COLLECTION, help="folder with an index.csv (default %(default)s)"
    )
    parser.add_argument("--peers", type=Path, default=PEERS, help="the peers' table (default %(default)s)")
    parser.add_argument(
        "--results", type=Path, default=out / "sweep" / "results.jsonl", help="of a sweep of this build"
    )
    parser.add_argument("--out", type=Path, default=out / "field", help="for what is run here, and field.md")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="only models whose name contains one of these")
    parser.add_argument("--quads", nargs="+", type=int, default=[2000, 8000], metavar="N", help="of the second table")
    parser.add_argument("--no-judge", action="store_true", help="only our own validation")
    return parser


if __name__ == "__main__":
    sys.exit(main())
