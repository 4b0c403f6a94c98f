"""A run of ``hybrid-quad remesh`` for what needs arrays: wishes from other files, parts of a mesh, other files than .obj."""

from __future__ import annotations

import argparse
import functools
from collections.abc import Callable
from typing import Any, NamedTuple

from ..core import mesh_io, wish_files
from ..core.file_places import FilesTogether, MeshFileError
from ..core.mesh_arrays import FloatArray, Polygons
from ..core.options import STROKE_KINDS, RemeshOptions
from ..core.part_files import read_part, write_polygons
from ..core.part_sheet import Indices
from ..core.part_weld import PartResult
from ..core.remesh import RemeshResult, remesh_with_options
from ..core.remesh_part import STAGE, PartChoice, PartRemesh, as_part, joined, remesh_part_with_options
from ..core.run_limits import RunLimits
from ..core.strokes import Stroke, joined_lines, kind_of_name
from ..core.validation import violations
from .progress_bar import ProgressBar
from .run_checks import check_valid
from .watched_work import watched


class _Inputs(NamedTuple):
    """What a run reads."""

    vertices: FloatArray
    polygons: Polygons
    wishes: dict[str, Any]  # arguments of what remeshes
    part: Indices | None  # numbers of the faces that are remeshed; None: all


def remesh_arrays(
    arguments: argparse.Namespace, options: RemeshOptions, limits: RunLimits
) -> tuple[RemeshResult, PartRemesh | None]:
    """The quads, checked, and, where they are those of a part, the whole mesh with them in it."""
    vertices, polygons, wishes, part = watched(lambda: _read(arguments), lambda: limits.check("reading"))
    limits.check("reading")
    solve, asked = _part_solver(arguments, vertices, polygons, part, options, limits) or (remesh_with_options, options)
    with ProgressBar(arguments.quiet) as bar:
        result = solve(vertices, polygons, asked, **wishes, progress=bar.update, dump_stages=arguments.dump_stages)
    check_valid(violations(result.vertices, result.quads))
    return result, _joined_mesh(vertices, polygons, result)


def _read(arguments: argparse.Namespace) -> _Inputs:
    vertices, polygons = mesh_io.read_mesh(arguments.input)
    density = _numbers(arguments.density, 1, len(vertices))
    frames = _numbers(arguments.frames, 6, len(vertices))
    wishes = {
        "sharp_edges": None if arguments.features is None else wish_files.read_edges(arguments.features),
        "curve_counts": None if arguments.curve_counts is None else wish_files.read_counts(arguments.curve_counts),
        "density": None if density is None else density.reshape(-1),
        "frames": None if frames is None else frames.reshape(-1, 2, 3),
        "strokes": None if arguments.guides is None else _strokes(arguments),
        "stroke_radius": arguments.guide_radius,
    }
    part = None if arguments.part is None else read_part(arguments.part)
    return _Inputs(vertices, polygons, wishes, part)


def write_arrays(
    path: str, result: RemeshResult, mesh: PartRemesh | None, together: FilesTogether | None = None
) -> None:
    """What :func:`remesh_arrays` gave, to a file that may take its place together with others.

    Raises
    ------
    MeshFileError
    """
    if mesh is None:
        mesh_io.write_mesh(path, result.vertices, result.quads, together)
    else:
        write_polygons(path, mesh.vertices, mesh.faces, together)


def _part_solver(
    arguments: argparse.Namespace,
    vertices: FloatArray,
    polygons: Polygons,
    part: Indices | None,
    options: RemeshOptions,
    limits: RunLimits,
) -> tuple[Callable[..., RemeshResult], RemeshOptions] | None:
    """What remeshes the part, and the options for it; None where the whole mesh is remeshed.

    Raises
    ------
    InputError
        If faces are named that are not there.
    """
    if part is None:
        return None
    faces = as_part(part, len(polygons.sizes))
    is_free = arguments.quads is None and arguments.edge_length is None and arguments.chord_error is None
    choice = PartChoice(faces, arguments.odd_border, is_free)

    def ask() -> bool:  # here too the time counts from the start of the run
        limits.check(STAGE)
        return False

    solve = functools.partial(remesh_part_with_options, part=faces, odd_border=choice.odd_border, cancel=ask)
    return solve, choice.options_for(vertices, polygons, options, ask)


def _joined_mesh(vertices: FloatArray, polygons: Polygons, result: RemeshResult) -> PartRemesh | None:
    """The whole mesh with the quads of a part in it; None for a result that is the whole."""
    return joined(vertices, polygons, result) if isinstance(result, PartResult) else None


def _strokes(arguments: argparse.Namespace) -> list[Stroke]:
    """The lines of a file, each of the kind that its object's name or the option says."""
    lines = [
        (kind_of_name(name, arguments.guide_kind), line) for name, line in wish_files.read_polylines(arguments.guides)
    ]
    return [
        Stroke(line, arguments.guide_strength, kind)
        for kind in STROKE_KINDS
        for line in joined_lines([line for other, line in lines if other == kind])
    ]


def _numbers(path: str | None, width: int, count: int) -> FloatArray | None:
    """`width` numbers for each of `count` vertices, from a file."""
    if path is None:
        return None
    rows = wish_files.read_rows(path, width)
    if len(rows) != count:
        raise MeshFileError(f"{path}: has {len(rows)} lines of numbers for {count} vertices")
    return rows
