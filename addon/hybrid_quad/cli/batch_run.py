"""A batch from the words of its command to the summary."""

from __future__ import annotations

import argparse
import contextlib
import os
from collections.abc import Generator, Sequence
from pathlib import Path
from typing import Any

from ..batch_jobs import summary, summary_page
from ..batch_jobs.asset import WORK_FOLDER, Asset, BatchPlan
from ..batch_jobs.asset_range import in_range
from ..batch_jobs.asset_status import AssetStatus
from ..batch_jobs.blend_objects import object_lister
from ..batch_jobs.engine import run_locally
from ..batch_jobs.job_file import JobFileError, write_job_file
from ..batch_jobs.job_list import is_list_of_lines, list_assets, list_lines
from ..batch_jobs.run_asset import BatchFault
from ..batch_jobs.settings import KINDS, canonical
from ..core import native
from ..core.options import usable_threads
from . import exit_codes
from .batch_progress import BatchProgress
from .messages import say
from .setting_arguments import UsageProblem

_HOUR = 3600.0


def run_batch(arguments: argparse.Namespace) -> int:
    """Runs what is left to run, writes the summary and returns the exit status.

    Raises
    ------
    UsageProblem
        If the list of assets cannot be used, or the machine does not let the batch run.
    """
    try:
        return _run(arguments)
    except (BatchFault, JobFileError) as error:
        raise UsageProblem(str(error)) from error


def _run(arguments: argparse.Namespace) -> int:
    plan = _plan(arguments)
    if arguments.range is not None and not (arguments.write_list or arguments.summary_only):
        return exit_codes.OK if _run_all(_chosen(arguments, plan), plan, arguments) else exit_codes.CANCELLED
    assets = list_assets(arguments.inputs, _defaults(arguments), plan, object_lister(plan))
    if arguments.write_list:
        write_job_file(Path(arguments.write_list), assets)
        if not arguments.quiet:
            say(f"{arguments.write_list}: {len(assets)} assets")
        return exit_codes.OK
    interrupted = not arguments.summary_only and not _run_all(assets, plan, arguments)
    return _summarize(assets, plan, arguments, interrupted)


def _plan(arguments: argparse.Namespace) -> BatchPlan:
    output = Path(arguments.output).absolute()
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BatchFault(f"{output}: {error.strerror}") from error
    if not os.access(output, os.W_OK):
        raise BatchFault(f"{output}: cannot be written to")
    return BatchPlan(
        output=str(output),
        result_format=arguments.format,
        pictures=not arguments.no_pictures,
        blender=arguments.blender,
        retry_failed=arguments.retry_failed,
        time_limit=_HOUR,
    )


def _defaults(arguments: argparse.Namespace) -> dict[str, Any]:
    given = {name: getattr(arguments, name) for name in KINDS}
    try:
        return canonical(given, Path.cwd())
    except ValueError as error:
        raise UsageProblem(str(error)) from error


def _chosen(arguments: argparse.Namespace, plan: BatchPlan) -> list[Asset]:
    """The assets of ``--range``."""
    defaults, objects = _defaults(arguments), object_lister(plan)
    try:
        if is_list_of_lines(arguments.inputs):
            return list_lines(arguments.inputs[0], arguments.range, defaults, plan, objects)
        return in_range(list_assets(arguments.inputs, defaults, plan, objects), arguments.range)
    except ValueError as error:
        raise UsageProblem(f"--range: {error}") from error


def _run_all(assets: Sequence[Asset], plan: BatchPlan, arguments: argparse.Namespace) -> bool:
    """Whether all assets have been run; False after an interruption."""
    native.load()  # no worker could do without it
    with BatchProgress(len(assets), arguments.quiet) as progress:
        statuses = _engine(assets, plan, arguments)
        with contextlib.closing(statuses):
            try:
                for status in statuses:
                    progress.update(status)
            except KeyboardInterrupt:
                return False
    with contextlib.suppress(OSError):  # not empty where another batch uses the folder, or something was interrupted
        (Path(plan.output) / WORK_FOLDER).rmdir()
    return True


def _engine(
    assets: Sequence[Asset], plan: BatchPlan, arguments: argparse.Namespace
) -> Generator[AssetStatus, None, None]:
    if arguments.dask:
        from ..batch_jobs.dask_engine import run_on_dask

        return run_on_dask(assets, plan, arguments.dask)
    processors = usable_threads()
    jobs = arguments.jobs or min(processors, max(1, len(assets)))
    threads = max(1, processors // jobs)
    return run_locally(assets, BatchPlan(**{**vars(plan), "threads": threads}), jobs)


def _summarize(assets: Sequence[Asset], plan: BatchPlan, arguments: argparse.Namespace, interrupted: bool) -> int:
    lines = summary.collect(assets, plan)
    summary.write_summary(Path(plan.output), lines)
    summary_page.write_page(Path(plan.output), lines)
    if not arguments.quiet:
        found = ", ".join(f"{times} {name.replace('_', ' ')}" for name, times in summary.counts(lines).items())
        say(f"{Path(plan.output) / 'summary.html'}: {len(lines)} assets: {found}")
    if interrupted:
        say("interrupted; the same command goes on from here")
        return exit_codes.CANCELLED
    failed = summary.failed_percent(lines)
    if arguments.fail_above is not None and failed > arguments.fail_above:
        say(f"{failed:.1f} % of the assets have no result, more than {arguments.fail_above:g} %")
        return exit_codes.CANNOT_REMESH
    return exit_codes.OK
