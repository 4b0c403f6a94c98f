"""``hybrid-quad remesh``: a mesh file in, a quad mesh file out."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import __version__
from ..core import file_places, native, report
from ..core.errors import Cancelled, InputError
from ..core.held_mesh import HeldQuads, can_hold, read_held, remesh_held, write_held
from ..core.mesh_formats import check_writable
from ..core.options import RemeshOptions
from ..core.parent_process import end_with_stdin
from ..core.run_limits import RunLimits
from . import exit_codes
from .messages import describe_defect, describe_symmetry, say, what_became_of
from .progress_bar import ProgressBar
from .run_checks import check_valid
from .setting_arguments import add_settings, options_of

if TYPE_CHECKING:
    from ..core.remesh import RemeshResult
    from ..core.remesh_part import PartRemesh

FILES_READ = ("features", "curve_counts", "guides", "density", "frames", "part")  # beside IN


def add_to(commands: Any) -> None:
    """Adds the command to the parser's subcommands."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "remesh", help="turn a mesh into pure quads", description="Turns any surface mesh into pure quads."
    )
    parser.add_argument("input", metavar="IN", help="mesh file: .obj, .ply, .stl or .off")
    parser.add_argument("output", metavar="OUT", help="result: .obj, .ply or .off")
    add_settings(parser)
    parser.add_argument("--report", metavar="FILE.json", help="write counts, quality, timings and warnings there")
    parser.add_argument("--picture", metavar="FILE.png", help="draw a small picture of the result there")
    parser.add_argument("--dump-stages", metavar="DIR", help="write a .vtu file of every stage there")
    parser.add_argument("--quiet", action="store_true", help="say nothing unless something is wrong")
    parser.add_argument(
        "--end-with-stdin",
        action="store_true",
        help="end as soon as the standard input is closed, as it is when the program that holds its other end dies",
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Remeshes, checks the result, writes it, and returns the exit status; failures are raised."""
    started = time.monotonic()
    if arguments.end_with_stdin:
        end_with_stdin()
    options = options_of(arguments)
    limits = RunLimits(options)
    check_writable(arguments.output)
    _check_files(arguments)
    files = file_places.FilesTogether()
    try:
        result, mesh = _remesh(arguments, options, limits)
        _write(arguments, result, mesh, files)
        _tell(arguments, result, started)
    except OSError as error:  # of a folder of stages: what else is read or written has errors of its own
        problem = file_places.UnwritableFileError(file_places.name_and_reason(error))
        _write_failure(arguments, options, problem)
        raise problem from error
    except (KeyboardInterrupt, Exception) as error:
        if files.are_in_place and isinstance(error, KeyboardInterrupt):
            return exit_codes.OK  # too late: all is done
        _write_failure(arguments, options, error)
        raise
    return exit_codes.OK


def _tell(arguments: argparse.Namespace, result: HeldQuads | RemeshResult, started: float) -> None:
    if arguments.quiet:
        return
    for defect in result.report["defects"]:
        say(f"{what_became_of(defect)} {describe_defect(defect)}")
    if result.report["symmetry"]["deviation_percent"]:
        say(describe_symmetry(result.report["symmetry"]))
    for warning in result.report["warnings"]:
        say(f"warning: {warning}")
    seconds = time.monotonic() - started
    say(
        f"{arguments.output}: {result.report['quads']} quads, {result.report['irregular_vertices']} irregular vertices, "
        f"scaled Jacobian {result.report['scaled_jacobian']['mean']:.3f} in the mean, {seconds:.1f} s"
    )


def _check_files(arguments: argparse.Namespace) -> None:
    """Raises MeshFileError where a file cannot be written, or not without loss of another that was named. OUT may be IN."""
    named = [getattr(arguments, name) for name in FILES_READ]
    file_places.check_apart(arguments.output, named)
    named += [arguments.input, arguments.output]
    for path in filter(None, (arguments.report, arguments.picture)):
        file_places.check_place(path)
        file_places.check_apart(path, named)
        named.append(path)
    if arguments.dump_stages and Path(arguments.dump_stages).exists() and not Path(arguments.dump_stages).is_dir():
        raise file_places.MeshFileError(f"{arguments.dump_stages}: is no folder")


def _remesh(
    arguments: argparse.Namespace, options: RemeshOptions, limits: RunLimits
) -> tuple[HeldQuads | RemeshResult, PartRemesh | None]:
    reads_wishes = any(getattr(arguments, name) is not None for name in FILES_READ)
    if reads_wishes or arguments.dump_stages or not can_hold(arguments.input, options):
        from .array_run import remesh_arrays  # loads NumPy

        return remesh_arrays(arguments, options, limits)
    native.load().keep_freed_memory()
    mesh = read_held(arguments.input)
    limits.check("reading")
    with ProgressBar(arguments.quiet) as bar:
        result = remesh_held(mesh, options, bar.update, measure_distances=arguments.report is not None)
    check_valid(result.mesh.violations())
    return result, None


def _write(
    arguments: argparse.Namespace,
    result: HeldQuads | RemeshResult,
    mesh: PartRemesh | None,
    files: file_places.FilesTogether,
) -> None:
    """All that the run gives, put in place together: no result without its report, nor a report of success without it."""
    with files:
        if isinstance(result, HeldQuads):
            write_held(arguments.output, result, files)
        else:
            from .array_run import write_arrays

            write_arrays(arguments.output, result, mesh, files)
        if arguments.picture:
            from ..core import picture

            picture.write_picture(arguments.picture, result.vertices, result.quads, files)
        if arguments.report:
            with files.replacing(arguments.report) as file:
                file.write(report.as_text(result.report).encode())


def _write_failure(arguments: argparse.Namespace, options: RemeshOptions, error: BaseException) -> None:
    if not arguments.report:
        return
    if isinstance(error, InputError):
        status = "input_error"
    elif isinstance(error, file_places.UnwritableFileError):
        status = "unwritable_file"
    elif isinstance(error, file_places.MeshFileError):
        status = "unreadable_file"
    elif isinstance(error, MemoryError):
        status = "memory_limit"
    elif isinstance(error, (Cancelled, KeyboardInterrupt)):
        status = getattr(error, "code", "cancelled")
    else:
        status = "internal_error"
    try:
        with file_places.replacing(arguments.report) as file:
            file.write(report.as_text(report.failed(status, error, options, __version__)).encode())
    except file_places.UnwritableFileError as problem:
        if str(problem) != str(error):  # which is said after it, and is what the exit status tells
            say(str(problem))
