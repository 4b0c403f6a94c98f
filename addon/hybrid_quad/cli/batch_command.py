"""``hybrid-quad batch``: many meshes, each in a process of its own; goes on where it was stopped."""

from __future__ import annotations

import argparse
from typing import Any

from ..batch_jobs.settings import KINDS
from ..core.mesh_formats import WRITABLE
from .setting_arguments import add_settings


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
        help="folder, pattern in quotes, mesh file, .blend file (all its mesh objects), or job file: .csv, .json or .jsonl with the "
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
    parser.add_argument(
        "--write-list",
        metavar="FILE.jsonl",
        help="only write the list of assets, as a job file: .jsonl, of which --range reads its part only, or .json",
    )
    parser.add_argument("--summary-only", action="store_true", help="only write the summary of what has been run")
    parser.add_argument(
        "--fail-above",
        type=_percent,
        metavar="PERCENT",
        help="exit with status 1 if more than this share has no result",
    )
    parser.add_argument("--quiet", action="store_true", help="say nothing unless something is wrong")
    settings = parser.add_argument_group("settings")
    add_settings(settings)
    # Only what is given counts, so that settings of job files and objects are not hidden by defaults.
    parser.set_defaults(run=run, input="batch", **dict.fromkeys(KINDS))


def run(arguments: argparse.Namespace) -> int:
    """Runs what is left to run, writes the summary and returns the exit status."""
    from .batch_run import run_batch  # loads much that single runs, which start often, do without

    return run_batch(arguments)


def _percent(text: str) -> float:
    value = float(text)
    if not 0 <= value <= 100:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 and 100")
    return value


def _positive(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not 1 or more")
    return value
