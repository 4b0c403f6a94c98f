"""``hybrid-quad batch``: many meshes, each in a process of its own; goes on where it was stopped."""

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
from ..batch_jobs.job_file import write_job_file
from ..batch_jobs.job_list import list_assets
from ..batch_jobs.run_asset import BatchFault
from ..batch_jobs.settings import KINDS, canonical
from ..core import native, picture
from ..core.mesh_io import WRITABLE
from ..core.options import usable_threads
from . import exit_codes, remesh_command
from .batch_progress import BatchProgress
from .messages import say

_HOUR = 3600.0


def add_to(commands: Any) -> None:
    """Adds the command to the parser's subcommands."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "batch",
        help="turn many meshes into pure quads; goes on where it was stopped",
        description="Remeshes each asset in a process of its own. Beside every result is a status file; what has one that "
        "still fits input, settings and version is not run again. A summary is written as JSON, CSV and HTML.",
        epilog="Exit status: 0 all assets were run, whatever came of them; 1 more of them failed than --fail-above allows; "
        "2 wrong usage, or the machine does not let the batch run; 3 internal error; 4 interrupted. Settings are those "
        "of remesh, for every asset whose job file says nothing else.",
    )
    parser.add_argument(
        "inputs",
        nargs="+",
        metavar="INPUT",
        help="folder, pattern in quotes, mesh file, .blend file (all its mesh objects), or job file: .csv or .json with the "
        "columns input, name, object and any settings",
    )
    parser.add_argument("--output", required=True, metavar="DIR", help="folder for results, status files and summary")
    parser.add_argument("--format", choices=WRITABLE, default=".obj", help="of the results (default .obj)")
    parser.add_argument(
        "--jobs", type=_positive, metavar="N", help="assets at a time (default: one for each processor)"
    )
    parser.add_argument("--dask", metavar="ADDRESS", help="run on the Dask cluster whose scheduler is at this address")
    parser.add_argument("--blender", default="blender", metavar="PROGRAM", help="for .blend files (default blender)")
    parser.add_argument(
        "--retry-failed", action="store_true", help="run assets again that failed with the same settings"
    )
    parser.add_argument("--no-pictures", action="store_true", help="draw no pictures of results")
    parser.add_argument(
        "--range", metavar="A-B", help="only these assets of the list, counted from 0; writes no summary"
    )
    parser.add_argument("--write-list", metavar="FILE.json", help="only write the list of assets, as a job file")
    parser.add_argument("--summary-only", action="store_true", help="only write the summary of what has been run")
    parser.add_argument(
        "--fail-above", type=float, metavar="PERCENT", help="exit with status 1 if more than this share has no result"
    )
    parser.add_argument("--quiet", action="store_true", help="say nothing unless something is wrong")
    settings = parser.add_argument_group("settings")
    remesh_command.add_settings(settings)
    # Only what is given counts, so that settings of job files and objects are not hidden by defaults.
    parser.set_defaults(run=run, input="batch", **dict.fromkeys(KINDS))


def run(arguments: argparse.Namespace) -> int:
    """Runs what is left to run, writes the summary and returns the exit status."""
    plan = _plan(arguments)
    assets = list_assets(arguments.inputs, _defaults(arguments), plan, object_lister(plan))
    if arguments.write_list:
        write_job_file(Path(arguments.write_list), assets)
        if not arguments.quiet:
            say(f"{arguments.write_list}: {len(assets)} assets")
        return exit_codes.OK
    chosen = assets if arguments.range is None else _chosen(assets, arguments.range)
    interrupted = False
    if not arguments.summary_only:
        native.load()  # no worker could do without it
        interrupted = not _run_all(chosen, plan, arguments)
    if arguments.range is not None:
        return exit_codes.CANCELLED if interrupted else exit_codes.OK
    return _summarize(assets, plan, arguments, interrupted)


def _plan(arguments: argparse.Namespace) -> BatchPlan:
    output = Path(arguments.output).absolute()
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BatchFault(f"{output}: {error.strerror}") from error
    if not os.access(output, os.W_OK):
        raise BatchFault(f"{output}: cannot be written to")
    can_draw = picture.can_draw()
    if not (can_draw or arguments.no_pictures or arguments.quiet):
        say("pictures of results are left out: they need Pillow (pip install 'hybrid-quad[pictures]')")
    return BatchPlan(
        output=str(output),
        result_format=arguments.format,
        pictures=can_draw and not arguments.no_pictures,
        blender=arguments.blender,
        retry_failed=arguments.retry_failed,
        time_limit=_HOUR,
    )


def _defaults(arguments: argparse.Namespace) -> dict[str, Any]:
    given = {name: getattr(arguments, name) for name in KINDS}
    try:
        return canonical(given, Path.cwd())
    except ValueError as error:
        raise remesh_command.UsageProblem(str(error)) from error


def _chosen(assets: Sequence[Asset], text: str) -> list[Asset]:
    try:
        return in_range(assets, text)
    except ValueError as error:
        raise remesh_command.UsageProblem(f"--range: {error}") from error


def _run_all(assets: Sequence[Asset], plan: BatchPlan, arguments: argparse.Namespace) -> bool:
    """Whether all assets have been run; False after an interruption."""
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


def _positive(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not 1 or more")
    return value
