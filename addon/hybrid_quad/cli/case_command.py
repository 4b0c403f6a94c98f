"""``hybrid-quad case``: packs a mesh that goes wrong for a report, and runs such a report again."""

from __future__ import annotations

import argparse
import shlex
import sys
import tempfile
from pathlib import Path
from typing import Any

from ..batch_jobs.settings import KINDS, SettingError, canonical
from ..core.file_places import MeshFileError, check_apart, check_place
from . import exit_codes
from .messages import say
from .setting_arguments import UsageProblem, add_settings


def add_to(commands: Any) -> None:
    """Adds the command to the parser's subcommands."""
    parser: argparse.ArgumentParser = commands.add_parser(
        "case",
        help="pack a mesh that goes wrong for a report, or run such a report again",
        description="Remeshes a mesh once, whatever comes of it, and packs what the run read and what came of it into a zip "
        "file: the mesh as it was read (mesh.off) and the other files given, the settings, the report or error and the "
        "quads, what check says, the versions and the kind of machine. Also in it, unless --anonymous is given: the mesh file "
        "as it is (with names, comments, materials), its path and the command. With --replay such a file is run again.",
        epilog="What stays with --anonymous is the geometry: all coordinates and faces, at their place and in their size, and the "
        "numbers in the other files. Give away only what you may. Exit status: 0 the case was written, whatever came of the "
        "run, or the replay came to the same; 1 the replay came to something else; 2 wrong usage or files; 3 internal "
        "error; 4 interrupted.",
    )
    parser.add_argument("input", nargs="?", metavar="IN", help="mesh file: .obj, .ply, .stl or .off")
    parser.add_argument("-o", "--output", metavar="CASE.zip", help="where to write the case")
    parser.add_argument(
        "--anonymous",
        action="store_true",
        help="leave out names of files, folders, objects and materials, comments, and messages that hold a path",
    )
    parser.add_argument("--replay", metavar="CASE.zip", help="run a case again and say whether the same comes of it")
    parser.add_argument("--quiet", action="store_true", help="say nothing unless something is wrong")
    settings = parser.add_argument_group("settings", "those of remesh; the time limit is an hour where none is given")
    add_settings(settings)
    parser.set_defaults(run=run, **dict.fromkeys(KINDS))  # only what is given is put into the case


def run(arguments: argparse.Namespace) -> int:
    """Packs or replays a case and returns the exit status."""
    from ..batch_jobs.run_asset import BatchFault  # loads much that single runs, which start often, do without

    if (arguments.input is None) == (arguments.replay is None) or (arguments.replay is None) != bool(arguments.output):
        raise UsageProblem("case: give either IN and --output CASE.zip, or --replay CASE.zip")
    try:
        return _replay(arguments) if arguments.input is None else _pack(arguments)
    except (BatchFault, SettingError) as error:
        raise UsageProblem(str(error)) from error


def _pack(arguments: argparse.Namespace) -> int:
    from ..cases import case_file, case_inputs, case_run

    check_place(arguments.output)
    read = [getattr(arguments, name) for name, kind in KINDS.items() if kind == "file"]
    check_apart(arguments.output, [arguments.input, *read])
    source, origin = Path(arguments.input).absolute(), _origin(arguments)
    settings = canonical({name: getattr(arguments, name) for name in KINDS}, Path.cwd())
    case_inputs.require_files(source, settings)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        mesh = case_inputs.MESH
        try:
            packed = case_inputs.write_copies(source, settings, folder)
            if not arguments.anonymous:
                case_inputs.copy_original(source, folder)
        except (MeshFileError, ValueError, OverflowError) as error:
            if arguments.anonymous:
                raise MeshFileError(
                    f"{error}; what cannot be read can only be packed as it is, without --anonymous"
                ) from error
            mesh = case_inputs.original_name(source)
            packed = case_inputs.copy_originals(source, settings, folder)
        outcome = case_run.run_case(folder, mesh, packed)
        if arguments.anonymous:
            outcome = case_run.without_paths(outcome)
        files = {path.name: path.read_bytes() for path in folder.iterdir()}
    checked = case_run.check_report(source)
    if checked is not None:
        files["check.json"] = checked
    case_file.save_case(arguments.output, mesh, packed, files, outcome, origin)
    if not arguments.quiet:
        say(f"{arguments.output}: {_named(outcome.status, outcome.code)}, {outcome.seconds:.1f} s")
        names = "no names" if arguments.anonymous else "its file as it is, with names"
        say(f"the geometry of {arguments.input} is in it, and {names}")
    return exit_codes.OK


def _replay(arguments: argparse.Namespace) -> int:
    from .. import __version__
    from ..cases import case_file, case_run

    arguments.input = arguments.replay  # what messages speak of
    case = case_file.load_case(arguments.replay)
    with tempfile.TemporaryDirectory() as place:
        case_file.write_files(case, Path(place))
        outcome = case_run.run_case(Path(place), case.mesh, case.settings)
    is_same = outcome.is_as(case.status, case.code, case.result)
    if not arguments.quiet or not is_same:
        there = f"{case.machine.get('system')} {case.machine.get('machine')}"
        say(f"then: {_named(case.status, case.code)}, with hybrid-quad {case.version} on {there}")
        say(f"now:  {_named(outcome.status, outcome.code)}, with hybrid-quad {__version__}, {outcome.seconds:.1f} s")
        if outcome.message:
            say(outcome.message)
        same_kind = (outcome.status, outcome.code) == (case.status, case.code)
        say("the same" if is_same else "other quads" if same_kind else "something else")
    return exit_codes.OK if is_same else exit_codes.CANNOT_REMESH


def _origin(arguments: argparse.Namespace) -> dict[str, str]:
    if arguments.anonymous:
        return {}
    return {"input": str(Path(arguments.input).absolute()), "given": shlex.join(sys.argv[1:])}


def _named(status: str, code: str) -> str:
    return status.replace("_", " ") + (f" [{code}]" if code not in ("", status) else "")
