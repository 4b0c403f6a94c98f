"""One run of the command line, limited in time and memory, measured and judged."""

from __future__ import annotations

import atexit
import csv
import functools
import json
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from hybrid_quad.core.mesh_io import read_mesh
from hybrid_quad.core.validation import topology, violations
from judging import SAMPLED_CHECK, judged
from measuring import measure

ROOT = Path(__file__).resolve().parent.parent
COLLECTION = ROOT.parent / "shared" / "meshes" / "dev"
BAD = COLLECTION.parent / "bad"
JUDGE = ROOT.parent / "shared" / "judge" / "judge_quads.py"
OWN = "own: "  # begins the names of failed checks that are not the judge's
SETTINGS = {"sharp": ("--sharp-angle", "40"), "no_sharp": ("--no-sharp",)}


@dataclass(frozen=True)
class Run:
    """What to do."""

    model: str
    path: Path
    quads: int
    setting: str
    arguments: tuple[str, ...] = ()  # more of the command line's
    variant: str = "default"  # see variants.py
    refusal: str | None = None  # what is expected, see refusals.as_expected

    @property
    def name(self) -> str:
        """Unique among the runs of a sweep; also the name of its files."""
        return f"{self.model}_{self.quads}_{self.setting}" + ("" if self.variant == "default" else f"_{self.variant}")


@dataclass(frozen=True)
class Limits:
    """What a run may take before it is ended.

    On a machine with other work the processor's seconds say what a run costs, the clock's only that it does not hang.
    """

    seconds: float = 300.0
    cpu_seconds: float | None = None
    grace_seconds: float = 10.0
    memory_mb: int = 8192
    judge_seconds: float = 600.0


@dataclass
class Outcome:
    """What came of a run.

    `status` is "valid", "valid but for samples" (the judge's random points of the surface miss what some quads agree with, and
    the whole surface does not), "refused" (with a reason, whether or not it should be), "invalid", "timeout" (had to be killed),
    "crash", or the report's where no mesh was made; `failed` names the checks that failed, of the judge and of our own validation.
    What was expected of a model makes "wrongly refused" and "not refused" of some, see `refusals.as_expected`.
    """

    model: str
    quads: int
    setting: str
    status: str
    failed: list[str] = field(default_factory=list)
    message: str = ""
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    peak_mb: float = 0.0
    report: dict[str, Any] = field(default_factory=dict)
    judgement: dict[str, Any] = field(default_factory=dict)
    variant: str = "default"
    threads: int = 1
    build: str = ""  # of the library, see results.build_id
    judged: bool = False  # the independent judge was asked about the mesh
    limits: dict[str, Any] = field(default_factory=dict)  # see Limits; empty in results older than this

    @property
    def is_good(self) -> bool:
        """Valid by the judge's criteria, or refused as it should be."""
        return self.status in ("valid", "valid but for samples", "refused")

    @property
    def has_mesh(self) -> bool:
        """Whether there is something to judge."""
        return self.status in ("valid", "valid but for samples", "invalid", "not refused")

    def as_json(self) -> dict[str, Any]:
        """For a line of results."""
        return asdict(self)


def run_and_judge(
    run: Run,
    folder: Path,
    limits: Limits,
    judge: Path | None = JUDGE,
    threads: int = 1,
    keep_meshes: bool = True,
    environment: Mapping[str, str] | None = None,
) -> Outcome:
    """Remeshes one model in a process of its own and judges what comes out.

    Parameters
    ----------
    folder : Path
        Receives the mesh and the reports.
    judge : Path or None
        Script of the independent judge; without one only our own validation speaks.
    threads : int
        Threads of the run.
    keep_meshes : bool
        Leave the result's mesh in the folder.
    environment : mapping or None
        Variables of the run, in place of this process's own.
    """
    out, report = folder / f"{run.name}.obj", folder / f"{run.name}.report.json"
    for old in (out, report):
        old.unlink(missing_ok=True)
    command = [sys.executable, "-m", "hybrid_quad", "remesh", str(run.path), str(out), "--quads", str(run.quads)]
    command += [*SETTINGS[run.setting], *run.arguments, "--threads", str(threads), "--report", str(report), "--quiet"]
    # By the clock the run ends itself, and says in which stage; it is killed only if it does not.
    command += ["--time-limit", str(limits.seconds)]
    measured = measure(
        command, limits.seconds + limits.grace_seconds, limits.memory_mb, limits.cpu_seconds, environment
    )
    outcome = Outcome(
        run.model,
        run.quads,
        run.setting,
        measured.status,
        message=measured.message,
        variant=run.variant,
        threads=threads,
        limits=asdict(limits),
    )
    outcome.seconds, outcome.cpu_seconds, outcome.peak_mb = measured.seconds, measured.cpu_seconds, measured.peak_mb
    if report.exists():
        outcome.report = json.loads(report.read_text())
    if measured.status != "ok":
        if measured.status == "failed":
            outcome.status = "refused" if _is_refusal(outcome.report) else outcome.report.get("status", "crash")
        return outcome
    reference = run.path
    if outcome.report.get("defects"):
        with _REPAIRING:
            reference, failed = _repaired(run.path, limits.judge_seconds)
        outcome.failed += failed
    outcome.failed += _own_checks(reference, out)
    outcome.judged = judge is not None and judge.exists()
    if judge is not None and outcome.judged:
        judgement = folder / f"{run.name}.judge.json"
        outcome.judgement = judged(judge, run.quads, reference, out, judgement, limits.judge_seconds)
        outcome.failed += outcome.judgement.get("failed", [])
    outcome.status = _status_of(outcome)
    if not keep_meshes:
        out.unlink(missing_ok=True)
    return outcome


def _status_of(outcome: Outcome) -> str:
    if not outcome.failed:
        return "valid"
    is_sampled = outcome.failed == [SAMPLED_CHECK] and outcome.judgement.get("inverted_by_whole_surface") == 0
    return "valid but for samples" if is_sampled else "invalid"


def models_of(folder: Path) -> Iterator[tuple[Path, bool]]:
    """Models with whether an index beside them says that they are manifold surfaces; without an index all are taken for that."""
    index = folder / "index.csv"
    if not index.exists():
        yield from ((path, True) for path in sorted(folder.glob("*.obj")))
        return
    with index.open() as file:
        for row in csv.DictReader(file):
            yield folder / f"{row['name']}.obj", row.get("edge_mf") == row.get("vert_mf") == "y"


_WHOLE_MESH = {"empty_mesh", "no_area", "malformed_faces", "coordinates_too_coarse"}  # no element of it is at fault


def _is_refusal(report: dict[str, Any]) -> bool:
    """Whether a report says why there is no result: a code, a sentence and the elements; or an unreadable file's line."""
    if report.get("status") == "unreadable_file":
        return bool(report.get("message"))
    if report.get("status") != "input_error" or not str(report.get("message", "")).endswith("."):
        return False
    return bool(report.get("elements")) or report.get("code") in _WHOLE_MESH


_REPAIRING = threading.Lock()


@functools.cache
def _repaired(source: Path, seconds: float) -> tuple[Path, list[str]]:
    """Where the surface is that a result stands for if the input is dirty, and what is wrong with it."""
    target = _folder_of_repaired() / f"{source.stem}.obj"
    command = [sys.executable, str(Path(__file__).with_name("repaired.py")), str(source), str(target)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, check=False)
    if not target.exists():
        return target, [OWN + "no repaired mesh: " + (done.stderr.strip().splitlines() or ["no answer"])[-1]]
    return target, [OWN + "the repair changed the area"] if done.returncode else []


@functools.cache
def _folder_of_repaired() -> Path:
    folder = tempfile.mkdtemp(prefix="repaired_")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def _own_checks(source: Path, result: Path) -> list[str]:
    vertices, polygons = read_mesh(result)
    if (polygons.sizes != 4).any():
        return [OWN + "not only quads"]
    failed = [OWN + sentence for sentence in violations(vertices, polygons.vertices.reshape(-1, 4))]
    # STL files have no connectivity to compare with.
    if not failed and source.suffix == ".obj" and topology(read_mesh(source)[1]) != topology(polygons):
        failed.append(OWN + "topology differs")
    return failed
