"""What ``hybrid-quad remesh`` can be told about remeshing some faces of a mesh only."""

from __future__ import annotations

import argparse
import functools
from collections.abc import Callable

from ..core.mesh_arrays import FloatArray, Polygons
from ..core.options import RemeshOptions
from ..core.part_files import read_part
from ..core.part_parity import ODD_BORDERS
from ..core.part_weld import PartResult
from ..core.remesh import RemeshResult
from ..core.remesh_part import PartChoice, PartRemesh, as_part, joined, remesh_part_with_options


def add_part(parser: argparse._ActionsContainer) -> None:
    """Adds the options."""
    parser.add_argument(
        "--part",
        metavar="FILE",
        help="remesh only some faces: 0-based face numbers of IN; all others stay as they are. Without --quads, --edge-length "
        "and --chord-error, quads are as large as the edges at the border are long",
    )
    parser.add_argument(
        "--odd-border",
        choices=ODD_BORDERS,
        default=ODD_BORDERS[0],
        help="where a border has an odd number of edges, which quads cannot fill: refuse (default), or remesh one triangle more "
        "or less",
    )


def part_solver(
    arguments: argparse.Namespace, vertices: FloatArray, polygons: Polygons, options: RemeshOptions
) -> tuple[Callable[..., RemeshResult], RemeshOptions] | None:
    """What remeshes the part, and the options for it; None where the whole mesh is remeshed.

    Raises
    ------
    MeshFileError, InputError
        If the file cannot be read, or names faces that are not there.
    """
    if arguments.part is None:
        return None
    faces = as_part(read_part(arguments.part), len(polygons.sizes))
    is_free = arguments.quads is None and arguments.edge_length is None and arguments.chord_error is None
    choice = PartChoice(faces, arguments.odd_border, is_free)
    solve = functools.partial(remesh_part_with_options, part=faces, odd_border=choice.odd_border)
    return solve, choice.options_for(vertices, polygons, options)


def joined_mesh(vertices: FloatArray, polygons: Polygons, result: RemeshResult) -> PartRemesh | None:
    """The whole mesh with the quads of a part in it; None for a result that is the whole."""
    return joined(vertices, polygons, result) if isinstance(result, PartResult) else None
