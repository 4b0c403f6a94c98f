#!/usr/bin/env python3
"""Times the command against free peers: whole programs, in turn, so that what else the machine does hits all alike.

Peers: Instant Meshes (the Python of an environment that has pynanoinstantmeshes) and QuadriFlow in Blender. Writes
speed.json (every run) and speed.md (medians).
"""

from __future__ import annotations

import argparse
import json
import shlex
import statistics
import sys
import tempfile
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

from measuring import measure

PEERS = Path(__file__).resolve().parent / "peers"
OURS = "hybrid-quad remesh {source} {target} --quads {quads} --no-sharp --quiet"


@dataclass(frozen=True)
class Timing:
    """One run of one program; seconds and MB of the whole process, and of the remeshing call alone where it tells."""

    program: str
    model: str
    quads: int
    ok: bool
    seconds: float
    cpu_seconds: float
    peak_mb: float
    faces: int
    call_seconds: float | None = None
    call_cpu_seconds: float | None = None


def main() -> int:
    """Runs all programs on all models; exit status 1 if one of them fails."""
    arguments = _parser().parse_args()
    programs = {"hybrid-quad": arguments.ours}
    if arguments.instant_meshes_python:
        script = PEERS / "instant_meshes.py"
        programs["Instant Meshes"] = f"{arguments.instant_meshes_python} {script} {{source}} {{quads}} {{target}}"
    if arguments.blender:
        script = PEERS / "quadriflow.py"
        start = f"{arguments.blender} -b --factory-startup --python-exit-code 1 -P {script}"
        programs["QuadriFlow"] = f"{start} -- {{source}} {{quads}} {{target}}"
    arguments.out.mkdir(parents=True, exist_ok=True)
    timings: list[Timing] = []
    for model in arguments.models:
        for quads in arguments.quads:
            for turn in range(arguments.turns):
                # Every other turn backwards: none is always the first.
                for name in list(programs)[:: 1 if turn % 2 == 0 else -1]:
                    timings.append(run(name, programs[name], model, quads, arguments.time_limit))
                    print(timings[-1], file=sys.stderr, flush=True)
                (arguments.out / "speed.json").write_text(json.dumps([asdict(t) for t in timings], indent=1))
    (arguments.out / "speed.md").write_text(table(timings, list(programs)))
    print(table(timings, list(programs)))
    return 0 if all(t.ok for t in timings) else 1


def run(name: str, command: str, model: Path, quads: int, time_limit: float) -> Timing:
    """One run in a process of its own, measured by the system's accounting."""
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "out.obj"
        words = [w.format(source=model, quads=quads, target=target) for w in shlex.split(command)]
        log = Path(folder) / "log"
        with log.open("w") as output:
            measured = measure(words, time_limit, memory_mb=0, output=output)
        faces = 0
        if target.exists():
            with target.open() as file:
                faces = sum(line.startswith("f ") for line in file)
        call: dict[str, float] = {}
        for line in log.read_text(errors="replace").splitlines():
            if line.startswith('{"call_seconds"'):
                call = json.loads(line)
        ok = measured.status == "ok" and faces > 0
        took = (measured.seconds, measured.cpu_seconds, measured.peak_mb)
        return Timing(name, model.stem, quads, ok, *took, faces, **call)


def table(timings: list[Timing], programs: list[str]) -> str:
    """Medians, as Markdown: a line for each model and count, ratios are ours over the peer's."""
    peers = programs[1:]
    head = ["model", "quads", "wall s", "CPU s", "MB"]
    for peer in peers:
        head += [f"{peer}: wall s", "CPU s", "CPU s of the call", "MB", "our wall / its", "our CPU / its"]
    lines = [" | ".join(head), " | ".join("---" for _ in head)]
    for model, quads in dict.fromkeys((t.model, t.quads) for t in timings):
        these = [t for t in timings if (t.model, t.quads) == (model, quads)]
        ours = [t for t in these if t.program == programs[0]]
        wall, cpu = median(t.seconds for t in ours), median(t.cpu_seconds for t in ours)
        cells = [model, str(quads), f"{wall:.2f}", f"{cpu:.2f}", f"{median(t.peak_mb for t in ours):.0f}"]
        for peer in peers:
            its = [t for t in these if t.program == peer]
            if not all(t.ok for t in its):
                cells += ["fails"] + [""] * 5
                continue
            its_wall, its_cpu = median(t.seconds for t in its), median(t.cpu_seconds for t in its)
            cells += [
                f"{its_wall:.2f}",
                f"{its_cpu:.2f}",
                f"{median(t.call_cpu_seconds or 0 for t in its):.2f}",
                f"{median(t.peak_mb for t in its):.0f}",
                f"{wall / its_wall:.2f}",
                f"{cpu / its_cpu:.2f}",
            ]
        lines.append(" | ".join(cells))
    return "\n".join(f"| {line} |" for line in lines) + "\n"


def median(values: Iterable[float]) -> float:
    """Of some values; there is at least one."""
    return statistics.median(list(values))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("models", nargs="+", type=Path, help="triangle meshes, .obj")
    parser.add_argument("--quads", nargs="+", type=int, default=[2000, 8000])
    parser.add_argument("--turns", type=int, default=3, help="runs of each program on each model")
    parser.add_argument("--ours", default=OURS, help="our command, with {source}, {quads} and {target}")
    parser.add_argument("--instant-meshes-python", help="a Python that has pynanoinstantmeshes")
    parser.add_argument("--blender", help="a Blender, for its QuadriFlow")
    parser.add_argument("--time-limit", type=float, default=300, help="seconds a run may take")
    parser.add_argument("--out", type=Path, default=Path("out/speed"))
    return parser


if __name__ == "__main__":
    sys.exit(main())
