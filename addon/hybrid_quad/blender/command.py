"""Remeshing from a shell: what ``batch.py`` and, from Blender 4.2 on, ``blender -c hybrid_quad`` do."""

from __future__ import annotations

import argparse
import contextlib
import json
import math
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
from ..core.mesh_io import MeshFileError, check_apart, check_place, replacing
from ..core.options import AXES, RemeshOptions
from ..core.parent_process import end_with_stdin
from ..core.strokes import KINDS
from . import case_command, part_arguments
from .edge_marks import SOURCES
from .operators import message_of
from .remesh_task import RemeshTask, prepare_task
from .result_mesh import place_result
from .transfer.kinds import KINDS as TRANSFER_KINDS

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
        options = _parser().parse_args(list(arguments))
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
            _apply_settings(obj, options)
            task = _prepare(obj, options)
            asked = task.options
            result = task.solve(progress=_printer(options.quiet))
            target = place_result(bpy.context, obj, task, result)
            record = {**result.report, "object": target.name, "source_object": obj.name}
            if options.picture:
                picture.write_picture(options.picture, result.vertices, result.quads)
            _write_report(options.report, record)
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


class UsageError(Exception):
    """Arguments that name something that is not there."""


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="hybrid_quad",
        description="Turns an object's surface into pure quads and saves the file under another name. What is not "
        "given here is taken from the object's own settings.",
        epilog="Exit status: 0 done; 1 the object cannot be remeshed; 2 wrong usage; 3 internal error; 4 cancelled or "
        "time or memory limit. The output is written only with 0.",
    )
    parser.add_argument("--object", metavar="NAME", help="mesh object to remesh")
    parser.add_argument("--output", metavar="OUT.blend", help="file to save the result to")
    parser.add_argument(
        "--only-result", action="store_true", help="save only the object that has the result, for linking or appending"
    )
    parser.add_argument(
        "--list-objects", metavar="FILE.json", help="only write the names of visible mesh objects there"
    )
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--quads", type=_positive_integer, metavar="N", help="number of quads to aim at")
    size.add_argument("--ratio", type=_positive_number, metavar="R", help="number of quads to aim at for each face")
    size.add_argument(
        "--edge-length", type=_positive_number, metavar="L", help="length of the quads' edges, in scene units"
    )
    size.add_argument(
        "--chord-error", type=_positive_number, metavar="E", help="largest distance to the surface, in scene units"
    )
    sharp = parser.add_mutually_exclusive_group()
    sharp.add_argument("--sharp-angle", type=_angle, metavar="DEG", help="keep edges that bend by more than this")
    sharp.add_argument("--no-sharp", action="store_true", help="keep only the boundary and marked edges")
    for source in SOURCES:
        parser.add_argument(
            f"--{source.argument}",
            dest=source.setting,
            action=argparse.BooleanOptionalAction,
            help=f"keep edges by {source.label.lower()}, or do not",
        )
    parser.add_argument("--guide-object", metavar="NAME", help="object whose lines quads follow")
    parser.add_argument("--guide-collection", metavar="NAME", help="collection of objects whose lines quads follow")
    parser.add_argument(
        "--guide-annotations",
        dest="use_guide_annotations",
        action=argparse.BooleanOptionalAction,
        help="let quads follow annotation strokes, or do not",
    )
    for name in ("guide", "density"):
        parser.add_argument(
            f"--{name}-attribute",
            dest=f"use_{name}_attribute",
            action=argparse.BooleanOptionalAction,
            help=f'use the attribute "hybrid_quad_{name}", or do not',
        )
    for name, what in (("guide-kind", "guide objects"), ("annotations-kind", "annotations")):
        parser.add_argument(f"--{name}", choices=KINDS, help=f"what {what} are for: a direction, a loop or a ring")
    parser.add_argument("--guide-radius", type=_positive_number, metavar="N", help="how far guides act, in quads")
    parser.add_argument("--adaptivity", type=_share, metavar="A", help="0: quads of one size; 1: by curvature")
    parser.add_argument(
        "--field-smoothness", type=_share, metavar="S", help="0: follow detail; 1: fewest singularities"
    )
    parser.add_argument("--anisotropy", type=_stretch, metavar="R", help="longest ratio of a quad's sides (1: squares)")
    parser.add_argument(
        "--narrow-quads", type=int, choices=(1, 2), help="least rows of quads in narrow strips between kept edges"
    )
    parser.add_argument(
        "--fit-limit",
        dest="fit_limit_surface",
        action=argparse.BooleanOptionalAction,
        help="move vertices so that a subdivision surface lies on the surface, or do not",
    )
    parser.add_argument(
        "--symmetry",
        metavar="xyz|auto|none",
        type=_symmetry,
        help="mirror along these axes of the object, or along those along which it is symmetric",
    )
    for kind in TRANSFER_KINDS:
        parser.add_argument(
            f"--{kind.argument}",
            dest=kind.argument,
            action=argparse.BooleanOptionalAction,
            help=f"take along {kind.label.lower()}, or do not",
        )
    part_arguments.add_part(parser)
    place = parser.add_mutually_exclusive_group()
    place.add_argument(
        "--new-object", dest="result_mode", action="store_const", const="NEW", help="result in a new object"
    )
    place.add_argument("--replace", dest="result_mode", action="store_const", const="REPLACE", help="result in place")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="same seed, same result (default 0)")
    parser.add_argument(
        "--threads", type=int, default=0, metavar="N", help="default: all; the result does not depend on it"
    )
    parser.add_argument(
        "--time-limit", type=_positive_number, metavar="SECONDS", help="stop with status 4 after this time"
    )
    parser.add_argument(
        "--memory-limit",
        type=_positive_number,
        metavar="MB",
        help="stop with status 4 where Blender takes more memory",
    )
    parser.add_argument("--report", metavar="R.json", help="write counts, quality, timings and warnings there")
    parser.add_argument("--picture", metavar="FILE.png", help="draw a small picture of the result there")
    parser.add_argument("--quiet", action="store_true", help="say nothing unless something is wrong")
    parser.add_argument(
        "--end-with-stdin",
        action="store_true",
        help="end as soon as the standard input is closed, as by a parent's end",
    )
    return parser


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


def _positive_integer(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is not 1 or more")
    return value


def _positive_number(text: str) -> float:
    value = float(text)
    if not (math.isfinite(value) and value > 0):
        raise argparse.ArgumentTypeError(f"{text} is not more than 0")
    return value


def _angle(text: str) -> float:
    value = float(text)
    if not 0 <= value <= 180:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 and 180 degrees")
    return value


def _share(text: str) -> float:
    value = float(text)
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text} is not between 0 and 1")
    return value


def _stretch(text: str) -> float:
    value = float(text)
    if not 1 <= value <= 10:
        raise argparse.ArgumentTypeError(f"{text} is not between 1 and 10")
    return value


def _symmetry(text: str) -> str:
    if text in ("auto", "none") or (text and len(set(text) & set(AXES)) == len(text)):
        return text
    raise argparse.ArgumentTypeError(f'{text} is neither "auto" nor "none" nor letters of "{AXES}"')


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


def _apply_settings(obj: bpy.types.Object, options: argparse.Namespace) -> None:
    settings = obj.hybrid_quad
    if options.quads is not None:
        settings.target_mode, settings.quads = "COUNT", options.quads
    if options.ratio is not None:
        settings.target_mode, settings.ratio = "RATIO", options.ratio
    if options.edge_length is not None:
        settings.target_mode, settings.edge_length = "LENGTH", options.edge_length
    if options.chord_error is not None:
        settings.target_mode, settings.chord_error = "CHORD", options.chord_error
    if options.sharp_angle is not None:
        settings.use_sharp_angle, settings.sharp_angle = True, math.radians(options.sharp_angle)
    if options.no_sharp:
        settings.use_sharp_angle = False
    for name in (*(source.setting for source in SOURCES), *_SAME_NAMES):
        if getattr(options, name) is not None:
            setattr(settings, name, getattr(options, name))
    for kind in TRANSFER_KINDS:
        if getattr(options, kind.argument) is not None:
            setattr(settings.transfer, kind.setting, getattr(options, kind.argument))
    if options.guide_object is not None:
        settings.guide_object = _named(bpy.data.objects, options.guide_object, "object")
    if options.guide_kind is not None:
        settings.guide_objects_kind = options.guide_kind.upper()
    if options.annotations_kind is not None:
        settings.guide_annotations_kind = options.annotations_kind.upper()
    if options.guide_collection is not None:
        settings.guide_collection = _named(bpy.data.collections, options.guide_collection, "collection")
    if options.symmetry is not None:
        settings.use_auto_symmetry = options.symmetry == "auto"
        if options.symmetry != "auto":
            settings.symmetry_axes = [letter in options.symmetry.replace("none", "") for letter in AXES]
    if options.result_mode is not None:
        settings.result_mode = options.result_mode
    part_arguments.apply_part(obj, options)


# Arguments that are settings of the same name.
_SAME_NAMES = (
    "use_guide_annotations",
    "use_guide_attribute",
    "use_density_attribute",
    "guide_radius",
    "adaptivity",
    "field_smoothness",
    "anisotropy",
    "narrow_quads",
    "fit_limit_surface",
)


def _named(found: Any, name: str, kind: str) -> Any:
    if name not in found:
        raise UsageError(f'no {kind} "{name}" in the file')
    return found[name]


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


def _write_report(path: str | None, record: dict[str, Any]) -> None:
    if path:
        with replacing(path) as file:
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
