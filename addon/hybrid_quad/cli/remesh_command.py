"""``hybrid-quad remesh``: a mesh file in, a quad mesh file out."""

from __future__ import annotations

import argparse
import math
import signal
import time
from typing import Any

from .. import __version__
from ..core import mesh_io, report
from ..core.errors import Cancelled, InputError, InternalError
from ..core.mesh_arrays import FloatArray
from ..core.options import SOLVERS, SYMMETRY_CENTERS, RemeshOptions
from ..core.parent_process import end_with_stdin
from ..core.part_files import write_polygons
from ..core.remesh import RemeshResult, remesh_with_options
from ..core.remesh_part import PartRemesh
from ..core.strokes import KINDS, Stroke, joined_lines, kind_of_name
from ..core.validation import violations
from . import exit_codes
from .messages import describe_defect, describe_symmetry, say, what_became_of
from .part_arguments import add_part, joined_mesh, part_solver
from .progress_bar import ProgressBar


class UsageProblem(Exception):
    """Options that make no sense, each of which argparse took for good."""


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


def add_settings(parser: argparse._ActionsContainer) -> None:
    """Adds what can be asked of a run."""
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--quads", type=int, metavar="N", help="number of quads to aim at (default 5000)")
    size.add_argument("--edge-length", type=float, metavar="L", help="length of the quads' edges instead")
    parser.add_argument(
        "--chord-error",
        type=float,
        metavar="E",
        help="instead of --quads: the largest distance of quads to the surface, by which the curvature sets their size; "
        "--edge-length is then the longest edge",
    )
    sharp = parser.add_mutually_exclusive_group()
    sharp.add_argument(
        "--sharp-angle",
        type=float,
        default=40.0,
        metavar="DEG",
        help="keep edges whose faces' normals differ by more than this (default 40)",
    )
    sharp.add_argument("--no-sharp", action="store_true", help="keep only the boundary, and what --features names")
    parser.add_argument("--features", metavar="FILE", help="edges to keep: two 0-based vertex indices of IN a line")
    parser.add_argument(
        "--curve-counts",
        metavar="FILE",
        help="chains of edges that get an exact number of quads: the number and 0-based vertex indices of IN a line; "
        "a loop repeats its first vertex",
    )
    parser.add_argument(
        "--guides",
        metavar="FILE",
        help="lines that guide the quads: an .obj file with l elements, or x y z a line, an empty line between two lines",
    )
    parser.add_argument(
        "--guide-kind",
        choices=KINDS,
        default=KINDS[0],
        help="what they are for: quads near them turn along them (default), they become chains of edges (loop), or they "
        "cross edges at right angles through their middles (ring); objects of an .obj file whose names begin with one of "
        "these and an underscore are of that kind",
    )
    parser.add_argument("--guide-radius", type=float, metavar="L", help="how far directions act (default: two quads)")
    parser.add_argument(
        "--guide-strength", type=float, default=1.0, metavar="S", help="how strongly directions do, 0 to 1 (default 1)"
    )
    parser.add_argument(
        "--field-smoothness",
        type=float,
        default=RemeshOptions.field_smoothness,
        metavar="S",
        help=f"0: edges follow the surface's bends, 1: as few irregular vertices as can be (default {RemeshOptions.field_smoothness})",
    )
    parser.add_argument(
        "--adaptivity",
        type=float,
        default=RemeshOptions.adaptivity,
        metavar="A",
        help=f"0: edges of even length, 1: as short as the curvature asks for (default {RemeshOptions.adaptivity})",
    )
    parser.add_argument(
        "--narrow-quads",
        type=int,
        choices=(1, 2),
        default=RemeshOptions.narrow_quads,
        help=f"rows of quads that narrow strips between features get at least (default {RemeshOptions.narrow_quads})",
    )
    parser.add_argument(
        "--anisotropy",
        type=float,
        default=RemeshOptions.anisotropy,
        metavar="R",
        help=f"stretch quads by at most R along the direction in which the surface bends less (default {RemeshOptions.anisotropy})",
    )
    parser.add_argument(
        "--size-fidelity",
        type=float,
        default=RemeshOptions.size_fidelity,
        metavar="F",
        help=f"where sizes vary, 0: few irregular vertices, 1: the asked sizes (default {RemeshOptions.size_fidelity})",
    )
    parser.add_argument(
        "--fit-limit",
        action="store_true",
        help="move vertices so that the Catmull-Clark limit surface, creased on features, lies on the surface",
    )
    parser.add_argument(
        "--density", metavar="FILE", help="a number for each vertex of IN: 2 asks for edges half as long as 1 does"
    )
    parser.add_argument(
        "--frames", metavar="FILE", help="six numbers for each vertex of IN: two edge vectors in edge lengths; 0: free"
    )
    parser.add_argument(
        "--symmetry",
        default="",
        metavar="xyz|auto",
        help="make the result exactly symmetric: letters of the directions in which to mirror, or auto for those in which "
        "the mesh itself is symmetric",
    )
    parser.add_argument(
        "--symmetry-center",
        default="origin",
        metavar="origin|bounds|X,Y,Z",
        help="where the mirror planes meet: the origin (default), the middle of the bounding box, or a point",
    )
    add_part(parser)
    parser.add_argument(
        "--solver",
        choices=SOLVERS,
        default=SOLVERS[0],
        help=f"how the periodic field is found; eigen is the slow reference (default {SOLVERS[0]})",
    )
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="same seed, same result (default 0)")
    parser.add_argument(
        "--threads", type=int, default=0, metavar="N", help="default: all; the result does not depend on it"
    )
    parser.add_argument("--time-limit", type=float, metavar="SECONDS", help="stop with status 4 after this time")
    parser.add_argument(
        "--memory-limit", type=float, metavar="MB", help="stop with status 4 where more memory is taken"
    )


def run(arguments: argparse.Namespace) -> int:
    """Remeshes, checks the result, writes it, and returns the exit status; failures are raised."""
    started = time.monotonic()
    if arguments.end_with_stdin:
        end_with_stdin()
    options = _options(arguments)
    mesh_io.check_writable(arguments.output)
    for path in filter(None, (arguments.report, arguments.picture)):
        mesh_io.check_place(path)
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


def _options(arguments: argparse.Namespace) -> RemeshOptions:
    if arguments.guide_radius is not None and not (
        math.isfinite(arguments.guide_radius) and arguments.guide_radius > 0
    ):
        raise UsageProblem(f"--guide-radius must be > 0, not {arguments.guide_radius}")
    if not 0 <= arguments.guide_strength <= 1:
        raise UsageProblem(f"--guide-strength must be between 0 and 1, not {arguments.guide_strength}")
    if arguments.chord_error is not None and arguments.quads is not None:
        raise UsageProblem("--chord-error and --quads exclude each other: the error decides how many quads there are")
    try:
        return RemeshOptions(
            quads=RemeshOptions.quads if arguments.quads is None else arguments.quads,
            edge_length=arguments.edge_length,
            sharp_angle=None if arguments.no_sharp else arguments.sharp_angle,
            field_smoothness=arguments.field_smoothness,
            adaptivity=arguments.adaptivity,
            chord_error=arguments.chord_error,
            narrow_quads=arguments.narrow_quads,
            anisotropy=arguments.anisotropy,
            size_fidelity=arguments.size_fidelity,
            fit_limit_surface=arguments.fit_limit,
            symmetry=arguments.symmetry,
            symmetry_center=_center(arguments.symmetry_center),
            solver=arguments.solver,
            seed=arguments.seed,
            threads=arguments.threads,
            time_limit=arguments.time_limit,
            memory_limit=arguments.memory_limit,
        )
    except ValueError as error:
        raise UsageProblem(str(error)) from error


def _center(text: str) -> str | tuple[float, float, float]:
    if text in SYMMETRY_CENTERS:
        return text
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise ValueError(f'symmetry_center must be "origin", "bounds" or X,Y,Z, not {text!r}') from None
    return x, y, z


def _remesh(
    arguments: argparse.Namespace, options: RemeshOptions, started: float
) -> tuple[RemeshResult, PartRemesh | None]:
    vertices, polygons = mesh_io.read_mesh(arguments.input)
    sharp_edges = None if arguments.features is None else mesh_io.read_edges(arguments.features)
    curve_counts = None if arguments.curve_counts is None else mesh_io.read_counts(arguments.curve_counts)
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
        (kind_of_name(name, arguments.guide_kind), line) for name, line in mesh_io.read_polylines(arguments.guides)
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
    rows = mesh_io.read_rows(path, width)
    if len(rows) != count:
        raise mesh_io.MeshFileError(f"{path}: has {len(rows)} lines of numbers for {count} vertices")
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
            with mesh_io.replacing(arguments.report) as file:
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
    elif isinstance(error, mesh_io.MeshFileError):
        status = "unreadable_file"
    elif isinstance(error, MemoryError):
        status = "memory_limit"
    elif isinstance(error, (Cancelled, KeyboardInterrupt)):
        status = getattr(error, "code", "cancelled")
    else:
        status = "internal_error"
    with mesh_io.replacing(arguments.report) as file:
        file.write(report.as_text(report.failed(status, error, options, __version__)).encode())
