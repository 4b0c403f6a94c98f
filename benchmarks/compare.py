#!/usr/bin/env python3
"""Sets this package beside free peers over the manifold models, and against its targets, as Markdown.

Peers are run here, as far as they are named, with the same limits, and judged by the same judge: QuadriFlow in Blender,
Instant Meshes (a Python with pynanoinstantmeshes) and, on CAD models, Gmsh (a Python with gmsh). On CAD models they run with
their sharp edges. What peers did once, QuadWild-BiMDF among them, is taken from ../shared/peers. Results of this package are
taken from a sweep where it has them. What is done is kept: a comparison goes on where it stopped.
"""

from __future__ import annotations

import argparse
import csv
import shlex
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from chord import chord_error, feature_curves
from comparison import Case, Result, from_outcome, from_stored, page
from hybrid_quad.core.mesh_arrays import surface_area
from hybrid_quad.core.mesh_io import read_mesh
from judging import judged
from measuring import measure
from results import append_row, build_id, read_results
from runs import COLLECTION, JUDGE, ROOT, Limits, Outcome, Run, run_and_judge
from stored_peers import PEERS, QUADS, stored_results

SCRIPTS = Path(__file__).resolve().parent / "peers"
SHARP_DEGREES = 40.0


@dataclass(frozen=True)
class Peer:
    """A program that is run here."""

    name: str
    command: str  # with {source}, {quads}, {target} and {flags}
    cad_only: bool = False


def main() -> int:
    """Runs what is missing and prints the page; exit status 1 if a target is missed."""
    arguments = _parser().parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    models = [row for row in _models(arguments.models, arguments.only)]
    if not models:
        print(f"no manifold models with an index.csv in {arguments.models}", file=sys.stderr)
        return 2
    ours = _Ours(arguments)
    peers = _Peers(list(_peers(arguments)), arguments)
    stored = stored_results(arguments.stored)
    cases = []
    for path, is_cad in models:
        chords = _chord_percents(path, arguments.quads)
        for quads in arguments.quads:
            results = [ours(path, quads), *peers(path, quads, is_cad)]
            if quads == QUADS:
                results += [from_stored(name, result) for name, result in stored.get(path.stem, {}).items()]
            case = Case(path.stem, quads, is_cad, chords[quads], results)
            peer = case.best_peer()
            if is_cad and peer is not None and peer.quads is not None:
                case = replace(case, as_many=ours(path, peer.quads))
            cases.append(case)
    text, good = page(cases)
    (arguments.out / "compare.md").write_text(text)
    print(text)
    return 0 if good else 1


class _Ours:
    """This package's results: of a sweep, or made now."""

    def __init__(self, arguments: argparse.Namespace) -> None:
        self._out: Path = arguments.out
        self._judge: Path = arguments.judge
        self._seconds: float = arguments.time_limit
        self._only_recorded: bool = arguments.only_recorded
        self._done = {**read_results(arguments.results), **read_results(self._out / "results.jsonl")}

    def __call__(self, path: Path, quads: int) -> Result:
        run = Run(path.stem, path, quads, "sharp")
        if run.name not in self._done:
            if self._only_recorded:
                return Result("hybrid-quad", "not run", here=True)
            outcome = run_and_judge(run, self._out, Limits(seconds=self._seconds), self._judge)
            self._done[run.name] = outcome
            append_row(self._out / "results.jsonl", {"name": run.name, **outcome.as_json(), "build": build_id()})
            print(f"{run.name}: {outcome.status}, {outcome.seconds:.1f} s", file=sys.stderr, flush=True)
        return from_outcome("hybrid-quad", self._done[run.name])


class _Peers:
    """Peers' results: of an earlier comparison, or made now."""

    def __init__(self, peers: list[Peer], arguments: argparse.Namespace) -> None:
        self._peers = peers
        self._out: Path = arguments.out
        self._judge: Path = arguments.judge
        self._limits = Limits(seconds=arguments.time_limit)
        self._done = read_results(self._out / "peers.jsonl")

    def __call__(self, path: Path, quads: int, is_cad: bool) -> list[Result]:
        results = []
        for peer in self._peers:
            if peer.cad_only and not is_cad:
                continue
            name = f"{path.stem}_{quads}_{peer.name.replace(' ', '_')}"
            if name not in self._done:
                outcome = self._run(peer, path, quads, is_cad, self._out / f"{name}.obj")
                self._done[name] = outcome
                append_row(self._out / "peers.jsonl", {"name": name, **outcome.as_json(), "build": peer.name})
                print(f"{name}: {outcome.status}, {outcome.seconds:.1f} s", file=sys.stderr, flush=True)
            results.append(from_outcome(peer.name, self._done[name]))
        return results

    def _run(self, peer: Peer, path: Path, quads: int, sharp: bool, target: Path) -> Outcome:
        target.unlink(missing_ok=True)
        words = {"source": path, "quads": quads, "target": target, "flags": "sharp" if sharp else ""}
        command = [word for word in (part.format(**words) for part in shlex.split(peer.command)) if word]
        measured = measure(command, self._limits.seconds, self._limits.memory_mb)
        outcome = Outcome(path.stem, quads, "sharp" if sharp else "no_sharp", measured.status, message=measured.message)
        outcome.seconds, outcome.cpu_seconds, outcome.peak_mb = measured.seconds, measured.cpu_seconds, measured.peak_mb
        if measured.status == "ok" and target.exists():
            report = target.with_suffix(".judge.json")
            outcome.judgement = judged(self._judge, quads, path, target, report, self._limits.judge_seconds)
            outcome.judged, outcome.failed = True, outcome.judgement.get("failed", [])
            outcome.status = "invalid" if outcome.failed else "valid"
        elif measured.status == "ok":
            outcome.status = "no mesh"
        return outcome


def _peers(arguments: argparse.Namespace) -> Iterator[Peer]:
    tail = "{source} {quads} {target} {flags}"
    if arguments.blender:
        start = f"{arguments.blender} -b --factory-startup --python-exit-code 1 -P {SCRIPTS / 'quadriflow.py'}"
        yield Peer("QuadriFlow in Blender", f"{start} -- {tail}")
    if arguments.instant_meshes_python:
        yield Peer("Instant Meshes here", f"{arguments.instant_meshes_python} {SCRIPTS / 'instant_meshes.py'} {tail}")
    if arguments.gmsh_python:
        yield Peer("Gmsh", f"{arguments.gmsh_python} {SCRIPTS / 'gmsh_quads.py'} {tail}", cad_only=True)


def _models(folder: Path, only: Iterable[str] | None) -> Iterator[tuple[Path, bool]]:
    """Manifold models, and whether they are CAD parts."""
    if not (folder / "index.csv").exists():
        return
    with (folder / "index.csv").open() as file:
        for row in csv.DictReader(file):
            is_asked = not only or any(part in row["name"] for part in only)
            if is_asked and row["edge_mf"] == row["vert_mf"] == "y":
                yield folder / f"{row['name']}.obj", "cad" in row["tags"].split("|")


def _chord_percents(path: Path, counts: Iterable[int]) -> dict[int, float]:
    """For numbers of quads, the chord error of their edges on the model's features, in percent of the diagonal."""
    vertices, faces = read_mesh(path)
    area = surface_area(vertices, faces)
    diagonal = float(((vertices.max(axis=0) - vertices.min(axis=0)) ** 2).sum() ** 0.5)
    curves = feature_curves(vertices, faces, SHARP_DEGREES)
    return {quads: 100 * chord_error(curves, (area / quads) ** 0.5) / diagonal for quads in counts}


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    out = ROOT / "out"
    parser.add_argument(
        "--models", type=Path, default=COLLECTION, help="folder with an index.csv (default %(default)s)"
    )
    parser.add_argument("--only", nargs="+", metavar="NAME", help="only models whose name contains one of these")
    parser.add_argument("--quads", nargs="+", type=int, default=[500, 2000, 8000], metavar="N")
    parser.add_argument(
        "--results",
        type=Path,
        default=out / "sweep" / "results.jsonl",
        help="this package's, of a sweep (default %(default)s)",
    )
    parser.add_argument("--only-recorded", action="store_true", help="leave out what of this package is not there")
    parser.add_argument("--blender", help="a Blender, for its QuadriFlow")
    parser.add_argument("--instant-meshes-python", metavar="PYTHON", help="a Python that has pynanoinstantmeshes")
    parser.add_argument("--gmsh-python", metavar="PYTHON", help="a Python that has gmsh")
    parser.add_argument("--stored", type=Path, default=PEERS, help="the peers' table (default %(default)s)")
    parser.add_argument("--judge", type=Path, default=JUDGE, help="script of the independent judge")
    parser.add_argument("--time-limit", type=float, default=180, metavar="SECONDS", help="of a run")
    parser.add_argument("--out", type=Path, default=out / "compare", help="for results, meshes and compare.md")
    return parser


if __name__ == "__main__":
    sys.exit(main())
