"""``hybrid-quad remesh``: a mesh file in, a quad mesh file out."""

from __future__ import annotations

import argparse
import signal
import time
from pathlib import Path
from typing import Any

from .. import __version__
from ..core import file_places, mesh_io, report, wish_files
from ..core.errors import Cancelled, InputError, InternalError
from ..core.mesh_arrays import FloatArray
from ..core.options import RemeshOptions
from ..core.parent_process import end_with_stdin
from ..core.part_files import write_polygons
from ..core.remesh import RemeshResult, remesh_with_options
from ..core.remesh_part import PartRemesh
from ..core.strokes import KINDS, Stroke, joined_lines, kind_of_name
from ..core.validation import violations
from . import exit_codes
from .messages import describe_defect, describe_symmetry, say, what_became_of
from .part_arguments import joined_mesh, part_solver
from .progress_bar import ProgressBar
from .setting_arguments import add_settings, options_of

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
    mesh_io.check_writable(arguments.output)
    _check_files(arguments)
    try:
        result, mesh = _remesh(arguments, options, started)
        if arguments.picture:
            from ..core import picture

            picture.write_picture(arguments.picture, result.vertices, result.quads)
    except (InputError, Cancelled, KeyboardInterrupt, Exception) as error:
        _write_failure(arguments, options, error)
        raise
    _write(arguments, result, mesh)
    if not arguments.quiet:
        for defect in result.report["defects"]:
            say(f"{what_became_of(defect)} {describe_defect(defect)}")
        if result.report["symmetry"]["deviation_percent"]:
            say(describe_symmetry(result.report["symmetry"]))
        for warning in result.report["warnings"]:
            say(f"warning: {warning}")
        seconds = time.monotonic() - started
        say(
            f"{arguments.output}: {len(result.quads)} quads, {result.report['irregular_vertices']} irregular vertices, "
            f"scaled Jacobian {result.report['scaled_jacobian']['mean']:.3f} in the mean, {seconds:.1f} s"
        )
    return exit_codes.OK


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
    arguments: argparse.Namespace, options: RemeshOptions, started: float
) -> tuple[RemeshResult, PartRemesh | None]:
    vertices, polygons = mesh_io.read_mesh(arguments.input)
    sharp_edges = None if arguments.features is None else wish_files.read_edges(arguments.features)
    curve_counts = None if arguments.curve_counts is None else wish_files.read_counts(arguments.curve_counts)
    density = _numbers(arguments.density, 1, len(vertices))
    frames = _numbers(arguments.frames, 6, len(vertices))
    solve, asked = part_solver(arguments, vertices, polygons, options) or (remesh_with_options, options)
    if options.time_limit is not None and time.monotonic() - started > options.time_limit:
        raise Cancelled("the time limit passed while the mesh was read", "time_limit")
    with ProgressBar(arguments.quiet) as bar:
        result = solve(
            vertices,
            polygons,
            asked,
            sharp_edges=sharp_edges,
            curve_counts=curve_counts,
            density=None if density is None else density.reshape(-1),
            frames=None if frames is None else frames.reshape(-1, 2, 3),
            progress=bar.update,
            dump_stages=arguments.dump_stages,
            strokes=None if arguments.guides is None else _strokes(arguments),
            stroke_radius=arguments.guide_radius,
        )
    problems = violations(result.vertices, result.quads)
    if problems:
        raise InternalError("the result is no valid quad mesh: " + "; ".join(problems), "validation")
    return result, joined_mesh(vertices, polygons, result)


def _strokes(arguments: argparse.Namespace) -> list[Stroke]:
    """The lines of a file, each of the kind that its object's name or the option says."""
    lines = [
        (kind_of_name(name, arguments.guide_kind), line) for name, line in wish_files.read_polylines(arguments.guides)
    ]
    return [
        Stroke(line, arguments.guide_strength, kind)
        for kind in KINDS
        for line in joined_lines([line for other, line in lines if other == kind])
    ]


def _numbers(path: str | None, width: int, count: int) -> FloatArray | None:
    """`width` numbers for each of `count` vertices, from a file."""
    if path is None:
        return None
    rows = wish_files.read_rows(path, width)
    if len(rows) != count:
        raise file_places.MeshFileError(f"{path}: has {len(rows)} lines of numbers for {count} vertices")
    return rows


def _write(arguments: argparse.Namespace, result: RemeshResult, mesh: PartRemesh | None) -> None:
    # The report first: where it cannot be written, no result must be left behind. From here on, a signal that comes
    # while the files are put in place would leave one of the two; it is held back for these few milliseconds.
    held = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        for number in held:
            signal.signal(number, signal.SIG_IGN)
    except ValueError:
        held = {}  # not in the main thread, which alone is interrupted
    try:
        if arguments.report:
            with file_places.replacing(arguments.report) as file:
                file.write(report.as_text(result.report).encode())
        if mesh is None:
            mesh_io.write_mesh(arguments.output, result.vertices, result.quads)
        else:
            write_polygons(arguments.output, mesh.vertices, mesh.faces)
    finally:
        for number, handler in held.items():
            signal.signal(number, handler)


def _write_failure(arguments: argparse.Namespace, options: RemeshOptions, error: BaseException) -> None:
    if not arguments.report:
        return
    if isinstance(error, InputError):
        status = "input_error"
    elif isinstance(error, (file_places.MeshFileError, OSError)):
        status = "unreadable_file"
    elif isinstance(error, MemoryError):
        status = "memory_limit"
    elif isinstance(error, (Cancelled, KeyboardInterrupt)):
        status = getattr(error, "code", "cancelled")
    else:
        status = "internal_error"
    with file_places.replacing(arguments.report) as file:
        file.write(report.as_text(report.failed(status, error, options, __version__)).encode())
