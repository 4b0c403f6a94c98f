#!/usr/bin/env python3
"""Remeshes random surfaces with random wishes, and keeps every case that does not end as it should.

    fuzz_pipeline.py [--seconds S] [--first SEED] [--out DIR]      goes on where it stopped
    fuzz_pipeline.py --replay FOLDER                               one case again
    fuzz_pipeline.py --shrink FOLDER [--seconds S]                 one case smaller, in its place

A case ends as it should with valid quads, or with a refusal that has a code, a sentence and elements. Each runs in a
worker process, which is started anew after a crash or when it takes too long. What fails is made as small as it still
fails and saved under DIR/failures; once it is mended, move it to tests/data/regressions, where tests find it, with an
expected.json that says how it ends: outcome and code.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import select
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parents[1] / "benchmarks")]

from fuzz.cases import Case, load_case, make_case  # noqa: E402
from fuzz.shrinking import shrunk  # noqa: E402
from fuzz.verdict import BAD, verdict_of  # noqa: E402

TIME_LIMIT = 60.0  # seconds of processor time
KILL_AFTER = 400.0  # seconds: a hang, also on a busy machine
MEMORY_MB = 6000


class Worker:
    """A process that judges one case after the other."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[str] | None = None

    def judge(self, request: dict[str, Any]) -> dict[str, Any]:
        """The verdict on ``{"seed"}`` or ``{"folder"}``; "timeout" or "crash" where none comes."""
        if self._process is None:
            self._process = subprocess.Popen(
                [sys.executable, str(Path(__file__).resolve()), "--worker"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
        process = self._process
        assert process.stdin is not None and process.stdout is not None
        begin = time.monotonic()
        process.stdin.write(json.dumps(request) + "\n")
        process.stdin.flush()
        ready, _, _ = select.select([process.stdout], [], [], KILL_AFTER)
        line = process.stdout.readline() if ready else ""
        if line:
            return json.loads(line)
        self.end()
        seconds = round(time.monotonic() - begin, 3)
        if not ready:
            return {"outcome": "timeout", "code": None, "detail": "had to be killed", "seconds": seconds}
        return {"outcome": "crash", "code": None, "detail": f"exit status {process.returncode}", "seconds": seconds}

    def end(self) -> None:
        """Ends the process."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process = None


def work() -> None:
    """The worker's side: a request a line in, a verdict a line out."""
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_MB << 20, MEMORY_MB << 20))
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever else is printed
    for line in sys.stdin:
        request = json.loads(line)
        case = make_case(request["seed"]) if "seed" in request else load_case(Path(request["folder"]))
        answers.write(json.dumps(verdict_of(case, TIME_LIMIT)) + "\n")
        answers.flush()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=60.0, help="how long to go on (default %(default)s)")
    parser.add_argument("--first", type=int, default=0, metavar="SEED", help="number of the first case")
    parser.add_argument("--out", type=Path, default=HERE.parents[1] / "out" / "fuzz")
    parser.add_argument("--replay", type=Path, metavar="FOLDER", help="judge the case in a folder, or of a number")
    parser.add_argument("--shrink", type=Path, metavar="FOLDER", help="make the case in a folder smaller")
    parser.add_argument("--no-shrink", action="store_true", help="save failures as they are")
    parser.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.worker:
        work()
        return 0
    if arguments.replay:
        is_number = str(arguments.replay).isdigit()
        case = make_case(int(str(arguments.replay))) if is_number else load_case(arguments.replay)
        verdict = verdict_of(case, TIME_LIMIT)
        print(json.dumps(verdict, indent=2))
        return int(verdict["outcome"] in BAD)
    if arguments.shrink:
        return shrink_stored(arguments.shrink, arguments.seconds)
    return fuzz(arguments.out, arguments.first, arguments.seconds, not arguments.no_shrink)


def fuzz(out: Path, first: int, seconds: float, shrink: bool) -> int:
    """Judges cases until the time is over; exit status 1 if one of them failed."""
    out.mkdir(parents=True, exist_ok=True)
    log = out / "cases.jsonl"
    done = [json.loads(line) for line in log.read_text().splitlines()] if log.exists() else []
    seed = max([first, *(row["seed"] + 1 for row in done)])
    outcomes: Counter[str] = Counter()
    worker = Worker()
    begin = time.monotonic()
    with log.open("a") as file:
        while time.monotonic() - begin < seconds:
            verdict = worker.judge({"seed": seed})
            file.write(json.dumps({"seed": seed, **verdict}) + "\n")
            file.flush()
            outcomes[verdict["outcome"]] += 1
            if verdict["outcome"] in BAD:
                folder = out / "failures" / f"{verdict['outcome']}_{seed}"
                print(f"{seed}: {verdict['outcome']} {verdict['detail']}", flush=True)
                make_case(seed).save(folder)
                if shrink and verdict["outcome"] != "timeout":
                    shrink_in_place(folder, verdict, worker, seconds=120)
            seed += 1
    worker.end()
    print(f"{outcomes.total()} cases in {time.monotonic() - begin:.0f} s: {dict(outcomes.most_common())}")
    return int(any(outcomes[name] for name in BAD))


def shrink_stored(folder: Path, seconds: float) -> int:
    """Makes a stored case smaller; exit status 1 if it is valid: then there is nothing to keep."""
    worker = Worker()
    verdict = worker.judge({"folder": str(folder)})
    if verdict["outcome"] != "valid":
        shrink_in_place(folder, verdict, worker, seconds)
    worker.end()
    print(f"{verdict['outcome']} {verdict['code'] or ''}: {len(load_case(folder).faces)} faces")
    return int(verdict["outcome"] == "valid")


def shrink_in_place(folder: Path, verdict: dict[str, Any], worker: Worker, seconds: float) -> None:
    """Keeps the smallest case found that ends as the one in the folder, a refusal with the same code."""
    trial = folder / "trial"

    def ends_alike(smaller: Case) -> bool:
        smaller.save(trial)
        judged = worker.judge({"folder": str(trial)})
        return (judged["outcome"], judged["code"]) == (verdict["outcome"], verdict["code"])

    shrunk(load_case(folder), ends_alike, seconds).save(folder)
    for path in trial.glob("*"):
        path.unlink()
    if trial.exists():
        trial.rmdir()


if __name__ == "__main__":
    sys.exit(main())
