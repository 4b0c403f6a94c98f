"""What the batch command can be told about remeshing part of a mesh."""

from __future__ import annotations

import argparse

import bpy

from .part_properties import ODD_BORDERS, REGIONS


def add_part(parser: argparse.ArgumentParser) -> None:
    """Adds the options."""
    parser.add_argument(
        "--part",
        choices=[_word(region[0]) for region in REGIONS],
        help="the faces to remesh; all others stay as they are",
    )
    parser.add_argument("--part-face-set", type=int, metavar="N", help="the face set, for --part face-set")
    parser.add_argument("--part-attribute", metavar="NAME", help="the Boolean face attribute, for --part attribute")
    parser.add_argument(
        "--part-inverted", action=argparse.BooleanOptionalAction, help="remesh all faces but these, or do not"
    )
    parser.add_argument(
        "--border-size",
        action=argparse.BooleanOptionalAction,
        help="make the part's quads as large as the edges at its border are long, or as is asked for",
    )
    parser.add_argument(
        "--odd-border",
        choices=[_word(each[0]) for each in ODD_BORDERS],
        help="where a border has an odd number of edges, which quads cannot fill: refuse it, or remesh one triangle more or less",
    )


def apply_part(obj: bpy.types.Object, options: argparse.Namespace) -> None:
    """Sets what is given. A size that is given counts, but where the border's is asked for as well."""
    settings = obj.hybrid_quad.part
    if options.part is not None:
        settings.region = _name(options.part)
    if options.part_face_set is not None:
        settings.face_set = options.part_face_set
    if options.part_attribute is not None:
        settings.attribute = options.part_attribute
    if options.part_inverted is not None:
        settings.use_inverted = options.part_inverted
    if options.odd_border is not None:
        settings.odd_border = _name(options.odd_border)
    sizes = (options.quads, options.ratio, options.edge_length, options.chord_error)
    has_size = any(value is not None for value in sizes)
    if options.border_size is not None or has_size:
        settings.use_border_length = bool(options.border_size)


def _word(name: str) -> str:
    return name.lower().replace("_", "-")


def _name(word: str) -> str:
    return word.upper().replace("-", "_")
