"""``hybrid-quad check``: what is wrong with a mesh, where, and what remesh would do about it."""

from __future__ import annotations

import argparse
import json
from typing import Any

from ..core.check import Defect, check
from ..core.mesh_io import read_mesh, replacing
from . import exit_codes
from .messages import list_elements


def add_to(commands: Any) -> None:
    """Adds the command to the parser's subcommands."""
    parser = commands.add_parser(
        "check",
        help="what is wrong with a mesh, and where",
        description="Says what is wrong with a mesh, where, and what remesh would do about it. Exit status 1 if remesh "
        "would refuse it.",
    )
    parser.add_argument("input", metavar="IN", help="mesh file: .obj, .ply, .stl or .off")
    parser.add_argument("--report", metavar="FILE.json", help="also write the defects there, with every element")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Prints the defects of the input and returns the exit status."""
    vertices, polygons = read_mesh(arguments.input)
    defects = check(vertices, polygons)
    print(f"{arguments.input}: {len(vertices)} vertices, {len(polygons.sizes)} faces")
    for defect in defects:
        print(_line(defect))
    if not defects:
        print("nothing is wrong with it")
    if arguments.report:
        text = json.dumps({"defects": [defect.as_json() for defect in defects]}, indent=2) + "\n"
        with replacing(arguments.report) as file:
            file.write(text.encode())
    return exit_codes.OK if all(defect.repairable for defect in defects) else exit_codes.CANNOT_REMESH


def _line(defect: Defect) -> str:
    if defect.element_kind == "edge":
        names = [f"{a}-{b}" for a, b in defect.elements.tolist()]
    else:
        names = [str(element) for element in defect.elements.tolist()]
    where = list_elements(defect.element_kind, names)
    verdict = "repaired by remesh" if defect.repairable else "remesh refuses it"
    return f"  {defect.code}: {where}{'; ' if where else ''}{verdict}: {defect.remedy}"
