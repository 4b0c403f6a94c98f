#!/usr/bin/env python3
"""Remeshes many models at many counts, with many wishes, judges each result, and writes a table (CSV and Markdown).

Every run has a process of its own, with limits of time and memory. What is done is kept in results.jsonl: a sweep that
was interrupted goes on where it stopped; what another build of the library did is made again, and what had other limits
or no judge where one is asked for now. Models of the collections are refused as expected_refusals.csv says, or not at all.
"""

from __future__ import annotations

import argparse
import os
import random
import sys
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import asdict, replace
from pathlib import Path

import table
from refusals import EXPECTED, as_expected, expected_refusals
from results import append_row, build_id, pack_results, read_results
from runs import BAD, COLLECTION, JUDGE, ROOT, SETTINGS, Limits, Outcome, Run, models_of, run_and_judge
from variants import VARIANTS, arguments_of

SECONDS_FOR_10000 = 60.0  # of the processor, quads; also the least that a run may take
CLOCK = 5.0  # times as many seconds by the clock: other work may go on


def main() -> int:
    """Runs what is missing and writes the table; exit status 1 if a run is neither valid nor refused as it should be."""
    arguments = _parser().parse_args()
    out: Path = arguments.out
    out.mkdir(parents=True, exist_ok=True)
    build = build_id(arguments.package)
    runs = _sample(list(_runs(arguments)), arguments.sample, arguments.seed)
    if not runs:
        print("no models to run: name some files, or a folder by --models", file=sys.stderr)
        return 2
    done = {} if arguments.fresh else read_results(out / "results.jsonl", build, *arguments.also)
    if arguments.known is not None:
        done = {**read_results(arguments.known, build, *arguments.also), **done}
    if arguments.pack is not None:
        pack_results(done, arguments.pack)
        return 0
    judge: Path | None = None if arguments.no_judge else arguments.judge
    if judge is not None and not judge.is_file():
        print(f"no judge at {judge}: name it by --judge, or do without one by --no-judge", file=sys.stderr)
        return 2

    def limits(run: Run) -> Limits:
        seconds = arguments.time_limit or max(1.0, run.quads / 10000) * SECONDS_FOR_10000
        if arguments.threads > 1:
            return Limits(seconds=seconds, cpu_seconds=arguments.threads * seconds, memory_mb=arguments.memory_mb)
        return Limits(seconds=CLOCK * seconds, cpu_seconds=seconds, memory_mb=arguments.memory_mb)

    def is_done(run: Run) -> bool:
        outcome = done.get(run.name)
        if outcome is None or as_expected(outcome, run.refusal).status in arguments.again:
            return False
        if judge is not None and outcome.has_mesh and not outcome.judged:
            return False
        # What is to be made again may have other limits than the rest, whose limits then say nothing.
        return bool(arguments.again) or outcome.limits in ({}, asdict(limits(run)))

    missing = [run for run in runs if not is_done(run)]
    print(f"{len(runs)} runs, {len(missing)} to do, build {build}", flush=True)
    environment = _environment(arguments)

    def done_by_process(run: Run) -> tuple[Run, Outcome]:
        wished = _with_wishes(run, out)
        outcome = run_and_judge(wished, out, limits(run), judge, arguments.threads, environment=environment)
        return run, replace(outcome, build=build)

    with ThreadPoolExecutor(arguments.jobs) as pool:
        waiting: set[Future[tuple[Run, Outcome]]] = {pool.submit(done_by_process, run) for run in missing}
        finished = 0
        try:
            while waiting:
                ready, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for future in ready:
                    run, outcome = future.result()
                    finished += 1
                    done[run.name] = outcome
                    append_row(out / "results.jsonl", {"name": run.name, **outcome.as_json()})
                    line = _line(run, as_expected(outcome, run.refusal))
                    print(f"[{finished}/{len(missing)}] {line}", flush=True)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    outcomes = [as_expected(done[run.name], run.refusal) for run in runs]
    (out / "sweep.csv").write_text(table.as_csv(outcomes))
    (out / "sweep.md").write_text(table.as_markdown(outcomes))
    (out / "sweep_short.md").write_text(table.as_short_markdown(outcomes))
    print("\n".join(table.summary(outcomes)))
    print(f"tables: {out / 'sweep.csv'}, {out / 'sweep.md'}, {out / 'sweep_short.md'}")
    return 0 if all(outcome.is_good for outcome in outcomes) else 1


def _line(run: Run, outcome: Outcome) -> str:
    quads = outcome.report.get("quads", "-")
    problem = ", ".join(outcome.failed) or (outcome.message.splitlines() or [""])[0]
    return f"{run.name}: {outcome.status}, {quads} quads, {outcome.seconds:.1f} s {problem}".rstrip()


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path, help="mesh files instead of a collection")
    parser.add_argument(
        "--models",
        nargs="+",
        type=Path,
        default=[COLLECTION, BAD],
        metavar="DIR",
        help="folders with an index.csv (default: the clean models and the bad ones)",
    )
    parser.add_argument("--only", nargs="+", metavar="NAME", help="only models whose name contains one of these")
    parser.add_argument("--quads", nargs="+", type=int, default=[100, 500, 2000, 8000, 30000], metavar="N")
    parser.add_argument("--settings", nargs="+", choices=list(SETTINGS), default=list(SETTINGS))
    parser.add_argument("--variants", nargs="+", choices=VARIANTS, default=list(VARIANTS))
    parser.add_argument("--sample", type=int, metavar="N", help="only so many runs, drawn at random from all of these")
    parser.add_argument("--seed", type=int, default=0, help="of the sample: the same number, the same runs (default 0)")
    parser.add_argument("--clean-only", action="store_true", help="only models that are manifold surfaces")
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "sweep")
    parser.add_argument("--jobs", type=int, default=1, help="runs at once (default 1: honest timings)")
    parser.add_argument(
        "--threads",
        type=int,
        default=1,
        metavar="N",
        help="of a run (default 1); with more the limit is one of the clock, as for a user who waits",
    )
    parser.add_argument(
        "--again",
        nargs="+",
        default=[],
        metavar="STATUS",
        help="make runs that ended so once more, as those over the limit (timeout) with more threads",
    )
    parser.add_argument(
        "--time-limit",
        type=float,
        metavar="SECONDS",
        help="of the processor, for a run (default: 60 s for 10000 quads, at least 60 s; by the clock five times as many)",
    )
    parser.add_argument("--memory-mb", type=int, default=Limits.memory_mb, help="for a run (default 8192); 0: no limit")
    parser.add_argument(
        "--also",
        nargs="+",
        default=[],
        metavar="BUILD",
        help="what these builds did counts too: they give the same results",
    )
    parser.add_argument("--package", type=Path, metavar="DIR", help="folder with the package hybrid_quad to run")
    parser.add_argument("--preload", nargs="+", default=[], metavar="LIBRARY", help="of a sanitizer, for the runs")
    parser.add_argument("--judge", type=Path, default=JUDGE, help="script of the independent judge")
    parser.add_argument("--no-judge", action="store_true", help="only our own validation")
    parser.add_argument(
        "--expected", type=Path, default=EXPECTED, metavar="FILE", help="models to be refused, and for what (CSV)"
    )
    parser.add_argument("--known", type=Path, metavar="FILE", help="what the same build did elsewhere, from --pack")
    parser.add_argument(
        "--pack", type=Path, metavar="FILE", help="write in short what is done, for --known (.jsonl.xz), and end"
    )
    parser.add_argument("--fresh", action="store_true", help="do everything again")
    return parser


def _runs(arguments: argparse.Namespace) -> Iterator[Run]:
    expected = expected_refusals(arguments.expected)
    for path, is_clean, is_known in _models(arguments):
        if arguments.only and not any(part in path.stem for part in arguments.only):
            continue
        if arguments.clean_only and not is_clean:
            continue
        refusal = expected.get(path.stem, "") if is_known else None
        for quads in arguments.quads:
            for setting in arguments.settings:
                for variant in arguments.variants:
                    yield Run(path.stem, path, quads, setting, variant=variant, refusal=refusal)


def _sample(runs: list[Run], size: int | None, seed: int) -> list[Run]:
    """The same runs for the same number, in the order in which they were."""
    if size is None or size >= len(runs):
        return runs
    return [runs[i] for i in sorted(random.Random(seed).sample(range(len(runs)), size))]


def _with_wishes(run: Run, folder: Path) -> Run:
    return replace(run, arguments=arguments_of(run.variant, run.path, folder))


def _models(arguments: argparse.Namespace) -> Iterator[tuple[Path, bool, bool]]:
    """Files, whether each is a manifold surface, and whether it is of a collection, of which all refusals are known."""
    if arguments.files:
        collections = [folder.resolve() for folder in arguments.models]
        yield from ((path, True, path.resolve().parent in collections) for path in arguments.files)
        return
    for folder in arguments.models:
        yield from ((path, is_clean, True) for path, is_clean in models_of(folder))


def _environment(arguments: argparse.Namespace) -> dict[str, str] | None:
    """Of the runs; none: this process's own."""
    if arguments.package is None:
        return None
    return {**os.environ, "PYTHONPATH": str(arguments.package.resolve()), "LD_PRELOAD": " ".join(arguments.preload)}


if __name__ == "__main__":
    sys.exit(main())
