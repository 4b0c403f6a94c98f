"""What the batch command understands, and how it changes an object's settings."""

from __future__ import annotations

import argparse
import math
from typing import Any

import bpy

from ..core.options import AXES, STROKE_KINDS
from . import part_arguments
from .edge_marks import SOURCES
from .transfer.kinds import KINDS as TRANSFER_KINDS


class UsageError(Exception):
    """Arguments that name something that is not there."""


def command_parser() -> argparse.ArgumentParser:
    """All that the command understands."""
    parser = argparse.ArgumentParser(
        prog="hybrid_quad",
        description="Turns an object's surface into pure quads and saves the file under another name. What is not "
        "given here is taken from the object's own settings.",
        epilog="Exit status: 0 done; 1 the object cannot be remeshed; 2 wrong usage; 3 internal error; 4 cancelled or "
        "time or memory limit. The output is written only with 0.",
    )
    _add_input(parser)
    _add_size(parser)
    _add_kept_edges(parser)
    _add_guides(parser)
    _add_flow(parser)
    _add_result(parser)
    _add_run(parser)
    return parser


def apply_settings(obj: bpy.types.Object, options: argparse.Namespace) -> None:
    """Sets what is given; raises UsageError where that names something that is not in the file."""
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


def _add_input(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--object", metavar="NAME", help="mesh object to remesh")
    parser.add_argument("--output", metavar="OUT.blend", help="file to save the result to")
    parser.add_argument(
        "--only-result", action="store_true", help="save only the object that has the result, for linking or appending"
    )
    parser.add_argument(
        "--list-objects", metavar="FILE.json", help="only write the names of visible mesh objects there"
    )


def _add_size(parser: argparse.ArgumentParser) -> None:
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--quads", type=_positive_integer, metavar="N", help="number of quads to aim at")
    size.add_argument("--ratio", type=_positive_number, metavar="R", help="number of quads to aim at for each face")
    size.add_argument(
        "--edge-length", type=_positive_number, metavar="L", help="length of the quads' edges, in scene units"
    )
    size.add_argument(
        "--chord-error", type=_positive_number, metavar="E", help="largest distance to the surface, in scene units"
    )


def _add_kept_edges(parser: argparse.ArgumentParser) -> None:
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


def _add_guides(parser: argparse.ArgumentParser) -> None:
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
        parser.add_argument(
            f"--{name}", choices=STROKE_KINDS, help=f"what {what} are for: a direction, a loop or a ring"
        )
    parser.add_argument("--guide-radius", type=_positive_number, metavar="N", help="how far guides act, in quads")


def _add_flow(parser: argparse.ArgumentParser) -> None:
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


def _add_result(parser: argparse.ArgumentParser) -> None:
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


def _add_run(parser: argparse.ArgumentParser) -> None:
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
