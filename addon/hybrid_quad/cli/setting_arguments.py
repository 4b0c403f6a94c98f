"""What can be asked of a run on the command line, for all commands that remesh."""

from __future__ import annotations

import argparse
import math

from ..core.options import SOLVERS, STROKE_KINDS, SYMMETRY_CENTERS, RemeshOptions
from .part_arguments import add_part


class UsageProblem(Exception):
    """Options that make no sense, each of which argparse took for good."""


def add_settings(parser: argparse._ActionsContainer) -> None:
    """Adds what can be asked of a run."""
    _add_size(parser)
    _add_features(parser)
    _add_guides(parser)
    _add_flow(parser)
    _add_symmetry(parser)
    add_part(parser)
    _add_run(parser)


def options_of(arguments: argparse.Namespace) -> RemeshOptions:
    """What the arguments ask of a run; raises UsageProblem where that makes no sense."""
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


def _add_size(parser: argparse._ActionsContainer) -> None:
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


def _add_features(parser: argparse._ActionsContainer) -> None:
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


def _add_guides(parser: argparse._ActionsContainer) -> None:
    parser.add_argument(
        "--guides",
        metavar="FILE",
        help="lines that guide the quads: an .obj file with l elements, or x y z a line, an empty line between two lines",
    )
    parser.add_argument(
        "--guide-kind",
        choices=STROKE_KINDS,
        default=STROKE_KINDS[0],
        help="what they are for: quads near them turn along them (default), they become chains of edges (loop), or they "
        "cross edges at right angles through their middles (ring); objects of an .obj file whose names begin with one of "
        "these and an underscore are of that kind",
    )
    parser.add_argument("--guide-radius", type=float, metavar="L", help="how far directions act (default: two quads)")
    parser.add_argument(
        "--guide-strength", type=float, default=1.0, metavar="S", help="how strongly directions do, 0 to 1 (default 1)"
    )


def _add_flow(parser: argparse._ActionsContainer) -> None:
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


def _add_symmetry(parser: argparse._ActionsContainer) -> None:
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


def _add_run(parser: argparse._ActionsContainer) -> None:
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
