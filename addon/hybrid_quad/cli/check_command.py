"""``hybrid-quad check``: what is wrong with a mesh, where, and what remesh would do about it."""

from __future__ import annotations

import argparse
import json
from typing import TYPE_CHECKING, Any

from ..core.file_places import check_apart, check_place, replacing
from . import exit_codes
from .messages import describe_defect, show, verdict_on

if TYPE_CHECKING:
    from ..core.check import Defect
    from ..core.mesh_arrays import FloatArray, Polygons


def add_to(commands: Any) -> None:
    """Adds the command to the parser's subcommands."""
    parser = commands.add_parser(
        "check",
        help="what is wrong with a mesh, and where",
        description="Says what is wrong with a mesh, where, and what remesh would do about it. Elements are "
        "counted from 0. Exit status 1 if remesh would refuse it.",
    )
    parser.add_argument("input", metavar="IN", help="mesh file: .obj, .ply, .stl or .off")
    parser.add_argument("--report", metavar="FILE.json", help="also write the defects there, with every element")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Prints the defects of the input and returns the exit status."""
    from ..core.check import check  # loads NumPy, which not all commands need
    from ..core.mesh_io import read_mesh
    from ..core.wish_files import read_line_elements
    from .watched_work import watched

    if arguments.report:
        check_place(arguments.report)
        check_apart(arguments.report, [arguments.input])

    def find() -> tuple[FloatArray, Polygons, list[Defect]]:
        vertices, polygons = read_mesh(arguments.input)
        return vertices, polygons, check(vertices, polygons, edges=read_line_elements(arguments.input))

    vertices, polygons, defects = watched(find, lambda: None)
    if arguments.report:
        text = json.dumps({"defects": [defect.as_json() for defect in defects]}, indent=2) + "\n"
        with replacing(arguments.report) as file:
            file.write(text.encode())
    show(f"{arguments.input}: {len(vertices)} vertices, {len(polygons.sizes)} faces")
    for defect in defects:
        show(f"  {describe_defect(defect.as_json(), verdict_on(defect.as_json()))}")
    if not defects:
        show("nothing is wrong with it")
    return exit_codes.OK if all(defect.repairable for defect in defects) else exit_codes.CANNOT_REMESH
