"""What ``hybrid-quad remesh`` can be told about remeshing some faces of a mesh only."""

from __future__ import annotations

import argparse

from ..core.options import ODD_BORDERS


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
