"""Remeshing from a shell: what ``batch.py`` and, from Blender 4.2 on, ``blender -c hybrid_quad`` do."""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import bpy

from ..cli import exit_codes
from ..cli.main import main as package_main
from ..cli.messages import describe_defect, describe_symmetry, what_became_of
from ..core import picture, report
from ..core.errors import Cancelled, InputError, InternalError
from ..core.file_places import (
    FilesTogether,
    MeshFileError,
    UnwritableFileError,
    check_apart,
    check_place,
    replacing,
)
from ..core.options import RemeshOptions
from ..core.parent_process import end_with_stdin
from . import case_command
from .command_arguments import UsageError, apply_settings, command_parser
from .operators import message_of
from .remesh_task import RemeshTask, prepare_task
from .result_mesh import place_result

NAME = "hybrid_quad"

# Blender's handle of the registered command, kept because only it can take the command away.
_handles: list[Any] = []


def register() -> None:
    """Adds the command where Blender knows commands (4.2)."""
    if hasattr(bpy.utils, "register_cli_command"):
        _handles.append(bpy.utils.register_cli_command(NAME, main))


def unregister() -> None:
    """Takes the command away again."""
    while _handles:
        bpy.utils.unregister_cli_command(_handles.pop())


def main(arguments: Sequence[str]) -> int:
    """Remeshes one object of the open file, saves the file under another name, and returns the exit status.

    Nothing is written unless the run succeeds, except a report that says why it did not. Where the first word is ``batch``
    or ``case``, the rest is that of the command ``hybrid-quad batch`` or ``case``; ``case --object`` packs an object of the file.

    Parameters
    ----------
    arguments : sequence of str
        See ``--help``.
    """
    if arguments[:1] == ["batch"]:
        program = bpy.app.binary_path  # none where Blender is a Python module
        return package_main([*arguments, *(["--blender", program] if program and "--blender" not in arguments else [])])
    if arguments[:1] == ["case"]:
        return _pack_object(arguments[1:]) if case_command.is_of_object(arguments) else package_main(arguments)
    try:
        options = command_parser().parse_args(list(arguments))
    except SystemExit as stop:  # argparse has printed usage or help
        return int(stop.code or 0)
    if options.end_with_stdin:
        end_with_stdin()
    if options.list_objects:
        return list_objects(options.list_objects)
    if not (options.object and options.output):
        print("hybrid_quad: --object and --output are needed", file=sys.stderr)
        return exit_codes.WRONG_USAGE
    asked: RemeshOptions | None = None
    try:
        _check_places(options)
    except MeshFileError as error:  # not even a report of it can be written
        print(f"hybrid_quad: {error}", file=sys.stderr)
        return exit_codes.WRONG_USAGE
    try:
        with _interruptible():
            obj = _find_object(options.object)
            _check_output(options.output)
            apply_settings(obj, options)
            task = _prepare(obj, options)
            asked = task.options
            result = task.solve(progress=_printer(options.quiet))
            target = place_result(bpy.context, obj, task, result)
            record = {**result.report, "object": target.name, "source_object": obj.name}
            with FilesTogether() as files:
                if options.picture:
                    picture.write_picture(options.picture, result.vertices, result.quads, files)
                _write_report(options.report, record, files)
                # Last: the others take their places only if this is written.
                if options.only_result:
                    _save_object(options.output, target)
                else:
                    _save(options.output)
    except Exception as error:
        return _fail(options, asked, error)
    except KeyboardInterrupt:
        return _fail(options, asked, Cancelled("interrupted"))
    if not options.quiet:
        print(_summary(options, record), flush=True)
    return exit_codes.OK


def _pack_object(arguments: Sequence[str]) -> int:
    try:
        return case_command.main(arguments, _find_object)
    except (UsageError, InputError) as error:
        print(f"hybrid_quad: {error}", file=sys.stderr)
        return exit_codes.WRONG_USAGE


def list_objects(path: str) -> int:
    """Writes the names of the visible mesh objects with faces as JSON, and returns the exit status."""
    objects = (obj for obj in bpy.context.view_layer.objects if obj.type == "MESH" and obj.library is None)
    names = sorted(obj.name for obj in objects if not obj.hide_get() and len(obj.data.polygons))
    try:
        with replacing(path) as file:
            file.write(json.dumps(names).encode())
    except MeshFileError as error:
        print(f"hybrid_quad: {error}", file=sys.stderr)
        return exit_codes.WRONG_USAGE
    return exit_codes.OK


def _find_object(name: str) -> bpy.types.Object:
    obj = bpy.context.view_layer.objects.get(name)
    if obj is None:
        meshes = sorted(each.name for each in bpy.context.view_layer.objects if each.type == "MESH")
        known = ", ".join(f'"{each}"' for each in meshes) or "none"
        raise UsageError(
            f'no object "{name}" in the view layer "{bpy.context.view_layer.name}"; mesh objects are: {known}'
        )
    if obj.type != "MESH":
        raise UsageError(f'"{name}" is no mesh object but a {obj.type.lower()}')
    if obj.library is not None:
        raise UsageError(f'"{name}" is linked from another file')
    return obj


def _check_places(options: argparse.Namespace) -> None:
    """Raises MeshFileError where a report or picture cannot be written, or not without loss of another file."""
    named = [options.output, bpy.data.filepath]
    for path in filter(None, (options.report, options.picture)):
        check_place(path)
        check_apart(path, named)
        named.append(path)


def _check_output(path: str) -> None:
    folder = os.path.dirname(os.path.abspath(path))
    if not path.endswith(".blend"):
        raise UsageError(f"{path}: the output is a Blender file, so its name has to end in .blend")
    if not os.path.isdir(folder):
        raise UsageError(f"{path}: the folder {folder} does not exist")
    if os.path.isdir(path) or not os.access(folder, os.W_OK):
        raise UsageError(f"{path}: cannot be written")


def _prepare(obj: bpy.types.Object, options: argparse.Namespace) -> RemeshTask:
    if obj.mode != "OBJECT":
        # A file saved in Edit Mode opens in it; what was edited reaches the mesh on the way out.
        bpy.context.view_layer.objects.active = obj
        bpy.ops.object.mode_set(mode="OBJECT")
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return prepare_task(
        obj,
        depsgraph,
        seed=options.seed,
        threads=options.threads,
        time_limit=options.time_limit,
        memory_limit=options.memory_limit,
    )


def _save(path: str) -> None:
    preferences = bpy.context.preferences.filepaths
    versions = preferences.save_version
    preferences.save_version = 0  # no ".blend1" beside an output that is written again
    try:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(path), copy=True, compress=True, check_existing=False)
    except RuntimeError as error:
        raise MeshFileError(f"{path}: {str(error).strip()}") from error
    finally:
        preferences.save_version = versions


def _save_object(path: str, obj: bpy.types.Object) -> None:
    """Writes a Blender file that holds an object and what it needs, whole or not at all."""
    part = f"{os.path.abspath(path)}.part.blend"
    try:
        bpy.data.libraries.write(part, {obj}, fake_user=True, compress=True)
        os.replace(part, path)
    except (OSError, RuntimeError) as error:
        raise MeshFileError(f"{path}: {error}") from error


def _write_report(path: str | None, record: dict[str, Any], together: FilesTogether | None = None) -> None:
    if path:
        with together.replacing(path) if together else replacing(path) as file:
            file.write(report.as_text(record).encode())


def _fail(options: argparse.Namespace, asked: RemeshOptions | None, error: Exception) -> int:
    from .. import __version__

    status, code = _STATUS_OF_ERROR.get(type(error), ("internal_error", exit_codes.BUG))
    if isinstance(error, Cancelled):
        status = error.code
    say_error = str(error) if code == exit_codes.WRONG_USAGE else message_of(error)
    print(f"hybrid_quad: {options.object}: {say_error}", file=sys.stderr, flush=True)
    with contextlib.suppress(MeshFileError):
        _write_report(options.report, report.failed(status, error, asked, __version__))
    return code


_STATUS_OF_ERROR: dict[type, tuple[str, int]] = {
    InputError: ("input_error", exit_codes.CANNOT_REMESH),
    UsageError: ("wrong_usage", exit_codes.WRONG_USAGE),
    MeshFileError: ("unwritable_file", exit_codes.WRONG_USAGE),
    UnwritableFileError: ("unwritable_file", exit_codes.WRONG_USAGE),
    ValueError: ("wrong_usage", exit_codes.WRONG_USAGE),
    Cancelled: ("cancelled", exit_codes.CANCELLED),
    MemoryError: ("memory_limit", exit_codes.CANCELLED),
    InternalError: ("internal_error", exit_codes.BUG),
}


def _printer(quiet: bool) -> Callable[[str, float], None] | None:
    if quiet:
        return None
    shown = [""]

    def show(stage: str, fraction: float) -> None:
        if stage != shown[0]:
            shown[0] = stage
            print(f"hybrid_quad: {100 * fraction:3.0f} % {stage.replace('_', ' ')}", file=sys.stderr, flush=True)

    return show


def _summary(options: argparse.Namespace, record: dict[str, Any]) -> str:
    lines = [f"hybrid_quad: {what_became_of(defect)} {describe_defect(defect)}" for defect in record["defects"]]
    lines += [f"hybrid_quad: warning: {warning}" for warning in record["warnings"]]
    if record["symmetry"]["deviation_percent"]:
        lines.append(f"hybrid_quad: {describe_symmetry(record['symmetry'])}")
    quality = record["scaled_jacobian"]
    lines.append(
        f'hybrid_quad: {options.output}: "{record["object"]}" has {record["quads"]} quads, '
        f"{record['irregular_vertices']} irregular vertices, scaled Jacobian {quality['mean']:.3f} in the mean and "
        f"{quality['min']:.3f} at worst"
    )
    return "\n".join(lines)


@contextlib.contextmanager
def _interruptible() -> Iterator[None]:
    """Ctrl-C and "terminate" raise KeyboardInterrupt; Blender's own handlers ignore them or end it at once."""

    def interrupt(_number: int, _frame: Any) -> None:
        raise KeyboardInterrupt

    former = {}
    for number in (signal.SIGINT, signal.SIGTERM):
        with contextlib.suppress(ValueError):  # not in the main thread
            former[number] = signal.signal(number, interrupt)
    try:
        yield
    finally:
        for number, handler in former.items():
            signal.signal(number, handler if handler is not None else signal.SIG_DFL)
