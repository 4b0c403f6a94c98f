"""The run of a case: as a batch runs an asset, so that a crash, too, is an outcome."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..batch_jobs import asset_status
from ..batch_jobs.asset import Asset, BatchPlan, files_of
from ..batch_jobs.run_asset import run_asset
from ..batch_jobs.settings import Settings, as_arguments, canonical
from ..batch_jobs.worker_process import run_process
from ..core.options import usable_threads
from ..core.python_programs import python_program

TIME_LIMIT = 3600.0  # seconds, where the settings have none
RESULT = "quads.off"

_CHECK_SECONDS = 600.0


@dataclass(frozen=True)
class Outcome:
    """What came of a run.

    Attributes
    ----------
    status : str
        As in the status files of batches: ``"ok"``, ``"input_error"``, ``"crashed"``, ...
    code, message : str
        What is wrong.
    seconds : float
    report : dict
        Of the run; empty where it left none.
    result : bytes or None
        The quads as an .off file.
    """

    status: str
    code: str
    message: str
    seconds: float
    report: dict[str, Any]
    result: bytes | None

    def is_as(self, status: str, code: str, result: bytes | None) -> bool:
        """Whether another run came to the same, to the last byte."""
        return (self.status, self.code, self.result) == (status, code, result)


def run_case(folder: Path, mesh: str, settings: Settings) -> Outcome:
    """Remeshes a mesh of a folder by settings that name files of the same folder.

    Raises
    ------
    BatchFault
        If the machine does not let it run.
    SettingError
        If there is no such setting, or it cannot have its value.
    """
    asset = Asset("run", str(folder / mesh), settings=canonical(settings, folder))
    with tempfile.TemporaryDirectory() as output:
        plan = BatchPlan(output, ".off", threads=usable_threads(), time_limit=TIME_LIMIT)
        status = run_asset(asset, plan)
        assert status is not None  # nobody asks it to stop
        result = files_of(asset, plan).result
        return Outcome(
            status=status.status,
            code=status.code,
            message=status.message.replace(f"{folder}/", ""),
            seconds=status.seconds,
            report=status.report,
            result=result.read_bytes() if status.status == asset_status.OK else None,
        )


def without_paths(outcome: Outcome) -> Outcome:
    """The same without its message where that may hold a path: messages of the system and of libraries do."""
    message = "" if "/" in outcome.message or "\\" in outcome.message else outcome.message
    report = {**outcome.report, "message": message} if "message" in outcome.report else outcome.report
    return replace(outcome, message=message, report=report)


def command_of_case(mesh: str, settings: Settings) -> list[str]:
    """The words by which the run is done by hand, in the folder of the case."""
    return ["hybrid-quad", "remesh", mesh, RESULT, *as_arguments(settings)]


def check_report(source: Path) -> bytes | None:
    """What ``hybrid-quad check`` reports of a mesh file; None where it gives no report."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "check.json"
        run_process(check_command(source, report), Path(folder) / "log.txt", lambda: False, time_limit=_CHECK_SECONDS)
        return report.read_bytes() if report.is_file() else None


def check_command(source: Path, report: Path) -> list[str]:
    """Words of the command that checks a mesh file."""
    return [python_program(), "-m", "hybrid_quad", "check", str(source), "--report", str(report)]
