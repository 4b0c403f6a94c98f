"""One asset from its input to its status file: what every engine calls, and the only thing that it needs to know."""

from __future__ import annotations

import json
import os
import shutil
import signal
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from .. import __version__
from ..core.file_places import MeshFileError
from . import asset_status
from .asset import Asset, AssetFiles, BatchPlan, files_of
from .asset_lock import asset_lock
from .asset_status import AssetStatus, read_status, stands, write_status
from .job_hash import job_hash
from .settings import LIMITS
from .worker_command import PICTURE, REPORT, command_of, result_name, settings_of_run
from .worker_process import Outcome, run_process

_LOG = "messages.txt"
_HASH = "job_hash"  # in the work folder: the job that its files are of
_STATUS_OF_EXIT = {2: "wrong_usage", 3: "internal_error"}  # where there is no report
# By somebody, or by the system for want of memory. Windows has no SIGKILL.
_KILLED = {getattr(signal, name) for name in ("SIGKILL", "SIGTERM") if hasattr(signal, name)}


class BatchFault(Exception):
    """The machine, not an asset, is at fault: nothing can be written, or no process started."""


def run_asset(asset: Asset, plan: BatchPlan, stop: Callable[[], bool] = lambda: False) -> AssetStatus | None:
    """Remeshes an asset unless its status file says that this has been done, and returns its status.

    It may be killed at any moment, and called again, here or on another machine that sees the same folder. The result
    and a report come to a work folder, each as a whole; then they are moved beside each other; the status file is last.
    Each step is left out where what it makes is there already, so a finished run is never repeated.

    Parameters
    ----------
    asset : Asset
    plan : BatchPlan
    stop : callable() -> bool
        Polled; a true answer ends the run and leaves no status.

    Returns
    -------
    AssetStatus or None
        None where it was stopped.

    Raises
    ------
    BatchFault
        If a folder or file of the batch cannot be written, or the worker process not started.
    """
    files = files_of(asset, plan)
    try:
        files.status.parent.mkdir(parents=True, exist_ok=True)
        return _run(asset, plan, files, stop)
    except (OSError, MeshFileError) as error:
        raise BatchFault(f"{asset.name}: {error}") from error


def _run(asset: Asset, plan: BatchPlan, files: AssetFiles, stop: Callable[[], bool]) -> AssetStatus | None:
    described = _described(asset, plan, files)
    if asset.problem:
        return _publish(replace(described, status=asset_status.WRONG_USAGE, message=asset.problem), files)
    try:
        key = job_hash(asset, plan)
    except OSError as error:
        described = replace(described, status=asset_status.UNREADABLE, message=f"{error.filename}: {error.strerror}")
        return _publish(described, files)
    described = replace(described, job_hash=key)
    lock_file = files.work.with_suffix(".lock")
    found = _standing(described, files, plan)
    if found and not files.work.exists() and not lock_file.exists():
        return found
    files.work.parent.mkdir(parents=True, exist_ok=True)
    with asset_lock(lock_file, stop) as lock:
        if lock is None:
            return None
        # Another process has done it meanwhile, or was killed before it had tidied up.
        status = _standing(described, files, plan)
        if status is None:
            status = _finished_before(described, files, asset, plan) or _work(described, files, asset, plan, stop, lock)
            if status is None:
                return None
            _publish(status, files, files.work / result_name(asset, plan))
        _tidy_up(files.work, lock_file)
        return status


def _tidy_up(work: Path, lock_file: Path) -> None:
    shutil.rmtree(work, ignore_errors=True)
    lock_file.unlink(missing_ok=True)  # who waits for it looks at the status file next


def _described(asset: Asset, plan: BatchPlan, files: AssetFiles) -> AssetStatus:
    settings = settings_of_run(asset, plan)
    return AssetStatus(
        asset=asset.name,
        source=asset.source,
        object=asset.object_name,
        status=asset_status.PENDING,
        settings={name: value for name, value in asset.settings.items() if name not in LIMITS},
        limits={name: float(settings[name]) for name in asset_status.OUT_OF_LIMITS if name in settings},
        version=__version__,
        command=command_of(asset, plan, files.work),
    )


def _standing(described: AssetStatus, files: AssetFiles, plan: BatchPlan) -> AssetStatus | None:
    found = read_status(files.status)
    if found is None or not stands(found, described.job_hash, described.limits, files.status.parent):
        return None
    return None if plan.retry_failed and found.status != asset_status.OK else found


def _finished_before(described: AssetStatus, files: AssetFiles, asset: Asset, plan: BatchPlan) -> AssetStatus | None:
    """The status of a run that came to its end, but whose files were not moved: what called it was killed."""
    try:
        same = (files.work / _HASH).read_text() == described.job_hash
    except OSError:
        return None
    report = _report_in(files.work)
    # A failure may have come of being left alone, which the next run will not be.
    if not same or report.get("status") != asset_status.OK:
        return None
    result = files.work / result_name(asset, plan)
    if not result.is_file() and not _moved(result, files.result):
        return None
    seconds = sum(float(stage.get("seconds") or 0) for stage in report.get("stages", ()))
    return _succeeded(described, files, report, result if result.is_file() else files.result, seconds, plan.pictures)


def _moved(result: Path, place: Path) -> bool:
    """Whether the result has gone from the work folder to its place: it stood there with its size before it went."""
    try:
        return place.stat().st_size == int((result.with_suffix(".bytes")).read_text())
    except (OSError, ValueError):
        return False


def _work(
    described: AssetStatus, files: AssetFiles, asset: Asset, plan: BatchPlan, stop: Callable[[], bool], lock: int
) -> AssetStatus | None:
    shutil.rmtree(files.work, ignore_errors=True)
    files.work.mkdir(parents=True)
    (files.work / _HASH).write_text(described.job_hash)
    outcome = run_process(
        described.command,
        files.work / _LOG,
        stop,
        time_limit=described.limits.get("time_limit", 0),
        memory_limit=described.limits.get("memory_limit", 0),
        inherited=(lock,),
    )
    if outcome.stopped == "cancelled":
        return None
    report = _report_in(files.work)
    result = files.work / result_name(asset, plan)
    if outcome.exit_status == 0 and result.is_file():
        return _succeeded(described, files, report, result, outcome.seconds, plan.pictures)
    return _failed(replace(described, seconds=outcome.seconds, report=report), outcome)


def _succeeded(
    described: AssetStatus,
    files: AssetFiles,
    report: dict[str, Any],
    result: Path,
    seconds: float,
    pictures: bool,
) -> AssetStatus:
    picture = pictures and ((files.work / PICTURE).is_file() or files.picture.is_file())
    return replace(
        described,
        status=asset_status.OK,
        result=files.result.name,
        picture=files.picture.name if picture else "",
        result_bytes=result.stat().st_size,
        seconds=round(seconds, 3),
        report=report,
    )


def _failed(described: AssetStatus, outcome: Outcome) -> AssetStatus:
    report, last_line = described.report, outcome.messages.splitlines()[-1:] or [""]
    if outcome.stopped:
        status, message = outcome.stopped, "the run did not stop by itself and was killed"
    elif outcome.exit_status < 0:
        killed = -outcome.exit_status in _KILLED
        status = asset_status.LOST if killed else asset_status.CRASHED
        message = f"the worker process was ended by {_signal_name(-outcome.exit_status)}"
        message += ", maybe for want of memory" if killed else f"; its last message: {last_line[0]}"
    elif report.get("status") not in (None, asset_status.OK):
        status, message = str(report["status"]), str(report.get("message", ""))
    else:
        status = _STATUS_OF_EXIT.get(outcome.exit_status, asset_status.CRASHED)
        message = outcome.messages or f"the worker process ended with status {outcome.exit_status} and no message"
    if status == "cancelled":  # by no one here
        status = asset_status.LOST
    return replace(described, status=status, code=str(report.get("code", status)), message=message)


def _publish(status: AssetStatus, files: AssetFiles, result: Path | None = None) -> AssetStatus:
    if status.status == asset_status.OK and result is not None and result.is_file():
        result.with_suffix(".bytes").write_text(str(status.result_bytes))
        if (picture := files.work / PICTURE).is_file():
            os.replace(picture, files.picture)
        os.replace(result, files.result)
    write_status(files.status, status)
    return status


def _report_in(folder: Path) -> dict[str, Any]:
    try:
        report = json.loads((folder / REPORT).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return report if isinstance(report, dict) else {}


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return f"signal {number}"
