"""Remeshes some faces of a mesh and leaves the rest as it is, to the last bit."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .curve_counts import CurveCount, as_curve_counts
from .edge_borders import BoolArray
from .errors import InputError
from .mesh_arrays import (
    FacesLike,
    FloatArray,
    IntArray,
    Polygons,
    as_edges,
    as_polygons,
    as_vertices,
    require_edges,
    require_indices,
)
from .options import ODD_BORDERS, RemeshOptions
from .part_checks import require_sound, require_welded
from .part_parity import EvenPart, even_part
from .part_sheet import Indices, border_length, sheet_of
from .part_weld import PartResult, welded
from .part_wishes import PartWishes
from .remesh import CancelCallback, PathLike, ProgressCallback, remesh_with_options
from .run_limits import RunLimits
from .strokes import Stroke, checked_strokes

STAGE = "part"  # as errors call what is done here

_NUDGE = 2e-6  # of the diagonal: how far the banks of a cut are apart; nearer ones are taken for a crack and closed


@dataclasses.dataclass(frozen=True, eq=False)
class PartRemesh:
    """A mesh, part of which was remeshed.

    Attributes
    ----------
    vertices : (n, 3) float64
        First those of the input that the rest or the border has, with the same bits, then new ones.
    faces : Polygons
        First those of the rest, in their order, then the new quads.
    kept_vertices : (k,) int64
        The input's vertices that the first k are.
    kept_faces : (r,) int64
        The input's faces that the first r are.
    quads : (m, 4) int32
        The new faces.
    report : dict
        Of the part alone; see :mod:`hybrid_quad.core.report`.
    """

    vertices: FloatArray
    faces: Polygons
    kept_vertices: Indices
    kept_faces: Indices
    quads: IntArray
    report: dict[str, Any]


class PartChoice(NamedTuple):
    """Which faces are remeshed.

    Attributes
    ----------
    faces : (#F,) bool
    odd_border : {"refuse", "grow", "shrink"}
        See :func:`remesh_part`.
    uses_border_length : bool
        Whether the mean length of the edges between part and rest is the quads', whatever the options say.
    """

    faces: BoolArray
    odd_border: str = "refuse"
    uses_border_length: bool = False

    def options_for(
        self, points: FloatArray, polygons: Polygons, options: RemeshOptions, ask: Callable[[], object] = lambda: None
    ) -> RemeshOptions:
        """`options` with the size of this part's quads; `ask` is called between steps, and what it raises ends them.

        Raises
        ------
        InputError
            As :func:`remesh_part`.
        """
        require_indices(polygons, len(points))
        if not self.uses_border_length:
            return options
        length = border_length(points, sheet_of(polygons, len(points), self.faces, ask=ask))
        return dataclasses.replace(options, edge_length=length, chord_error=None)


def remesh_part(
    vertices: npt.ArrayLike,
    faces: FacesLike,
    part: npt.ArrayLike,
    *,
    quads: int | None = None,
    edge_length: float | None = None,
    odd_border: str = "refuse",
    sharp_edges: npt.ArrayLike | Iterable[Sequence[int]] | None = None,
    curve_counts: Iterable[CurveCount] | None = None,
    guides: npt.ArrayLike | None = None,
    strokes: Iterable[Stroke | npt.ArrayLike] | None = None,
    stroke_radius: float | None = None,
    density: npt.ArrayLike | None = None,
    frames: npt.ArrayLike | None = None,
    progress: ProgressCallback | None = None,
    cancel: CancelCallback | None = None,
    **options: Any,
) -> PartRemesh:
    """Remeshes some faces into quads that join the other faces edge to edge.

    Every edge between the part and the rest becomes the side of one quad, its ends where they are. All of the rest is as it was. Where
    the part reaches the mesh's own border, that is divided anew.

    Parameters
    ----------
    vertices : (n, 3) float
    faces : (m, k) int, or a sequence of sequences of int
        The whole mesh.
    part : (m,) bool, or (p,) int
        Which faces are remeshed, or their numbers.
    quads : int, optional
        Number of quads to aim at in the part.
    edge_length : float, optional
        Length of their edges instead. Without both: the mean length of the edges between part and rest.
    odd_border : {"refuse", "grow", "shrink"}
        What is done where a connected part has an odd number of edges at its border, which quads cannot fill: refuse it, or remesh
        one face with an odd number of sides more or less.
    sharp_edges, curve_counts, guides, strokes, stroke_radius, density, frames
        As of :func:`hybrid_quad.remesh`, for the whole mesh; what lies in the rest does nothing.
    **options
        Other settings of :class:`hybrid_quad.RemeshOptions`, but symmetry and fit_limit_surface.

    Returns
    -------
    PartRemesh

    Raises
    ------
    InputError
        ``no_part``, ``odd_border``, ``non_manifold_part``, ``flipped_part``, ``unwelded_border``, ``border_missed``,
        ``part_too_coarse``, and as :func:`hybrid_quad.remesh`; names elements of the whole mesh.
    Cancelled, InternalError, ValueError, TypeError
        As :func:`hybrid_quad.remesh`.
    """
    points, polygons = as_vertices(vertices), as_polygons(faces)
    if quads is not None:
        options["quads"] = quads
    asked = RemeshOptions(**options, edge_length=edge_length)
    is_free = quads is None and edge_length is None and asked.chord_error is None
    choice = PartChoice(as_part(part, len(polygons.sizes)), odd_border, is_free)
    limits = RunLimits(asked, cancel)
    result = remesh_part_with_options(
        points,
        polygons,
        choice.options_for(points, polygons, asked, lambda: limits.check(STAGE)),
        part=choice.faces,
        odd_border=odd_border,
        sharp_edges=sharp_edges,
        curve_counts=curve_counts,
        guides=guides,
        strokes=strokes,
        stroke_radius=stroke_radius,
        density=density,
        frames=frames,
        progress=progress,
        cancel=cancel,
    )
    return joined(points, polygons, result)


def remesh_part_with_options(
    points: FloatArray,
    polygons: Polygons,
    options: RemeshOptions,
    *,
    part: npt.ArrayLike,
    odd_border: str = "refuse",
    sharp_edges: npt.ArrayLike | Iterable[Sequence[int]] | None = None,
    curve_counts: Iterable[CurveCount] | None = None,
    guides: npt.ArrayLike | None = None,
    strokes: Iterable[Stroke | npt.ArrayLike] | None = None,
    stroke_radius: float | None = None,
    density: npt.ArrayLike | None = None,
    frames: npt.ArrayLike | None = None,
    progress: ProgressCallback | None = None,
    cancel: CancelCallback | None = None,
    dump_stages: PathLike | None = None,
) -> PartResult:
    """:func:`remesh_part` with the settings in one value, and the quads alone; :func:`joined` puts them into the mesh."""
    if options.symmetry or options.fit_limit_surface:
        raise ValueError(
            "symmetry and fit_limit_surface need the whole surface: switch them off to remesh a part of it"
        )
    if odd_border not in ODD_BORDERS:
        raise ValueError(f"odd_border must be one of {', '.join(ODD_BORDERS)}, not {odd_border!r}")
    limits = RunLimits(options, cancel)

    def ask() -> None:
        limits.check(STAGE)

    ask()
    chosen = as_part(part, len(polygons.sizes))
    require_indices(polygons, len(points))
    even = even_part(points, polygons, chosen, odd_border, ask)
    ask()
    require_welded(points, polygons, even)
    ask()
    sheet_points = _nudged(points, even)
    marked = as_edges(sharp_edges)
    require_edges(marked, polygons, len(points))
    own = PartWishes(even, points, polygons)
    ask()
    own_counts = own.curve_counts(as_curve_counts(curve_counts))
    own_strokes, crossing = own.strokes(checked_strokes(strokes))
    ask()
    borders = [([int(a), int(b)], 1) for a, b in even.sheet.shared]
    try:
        result = remesh_with_options(
            sheet_points,
            even.sheet.polygons,
            options,
            sharp_edges=own.edges(marked),
            curve_counts=[*own_counts, *borders, *own.cut_counts(sheet_points, options)],
            guides=own.values(guides),
            strokes=own_strokes,
            stroke_radius=stroke_radius,
            density=own.values(density),
            frames=own.values(frames),
            progress=progress,
            cancel=cancel,
            dump_stages=dump_stages,
        )
    except InputError as error:
        raise own.error_of_whole(error) from error
    ask()
    own.complete_report(result.report, len(own_counts), crossing, int(chosen.sum()))
    found = welded(result, points, even, sheet_points)
    ask()
    require_sound(found, points, polygons)
    return found


def as_part(part: npt.ArrayLike, face_count: int) -> BoolArray:
    """(#F,) bool of faces given as such, or by their numbers."""
    array = np.asarray(part)
    if array.dtype == np.bool_:
        if array.shape != (face_count,):
            raise ValueError(f"part must have one Boolean for each of {face_count} faces, not the shape {array.shape}")
        return array
    if array.size and array.dtype.kind not in "iu":
        raise TypeError(f"part must be Booleans or face numbers, not {array.dtype}")
    outside = (array < 0) | (array >= face_count)
    if outside.any():
        raise InputError(
            "unknown_face", f"{int(outside.sum())} of the chosen faces do not exist.", "face", array[outside].tolist()
        )
    chosen = np.zeros(face_count, np.bool_)
    chosen[array.astype(np.int64)] = True
    return chosen


def joined(points: FloatArray, polygons: Polygons, result: PartResult) -> PartRemesh:
    """The whole mesh with a part's quads in it."""
    kept_faces = np.flatnonzero(~result.part)
    of_rest = np.repeat(~result.part, polygons.sizes)
    is_kept = np.ones(len(points), np.bool_)
    is_kept[polygons.vertices[~of_rest]] = False
    is_kept[polygons.vertices[of_rest]] = True
    is_new = result.whole_vertices < 0
    is_kept[result.whole_vertices[~is_new]] = True
    kept = np.flatnonzero(is_kept)
    number = np.full(len(points), -1, np.int64)
    number[kept] = np.arange(len(kept))
    of_result = np.where(is_new, len(kept) - 1 + np.cumsum(is_new), number[result.whole_vertices])
    quads = of_result[result.quads].astype(np.int32)
    return PartRemesh(
        vertices=np.concatenate([points[kept], result.vertices[is_new]]),
        faces=Polygons(
            np.concatenate([polygons.sizes[kept_faces], np.full(len(quads), 4, np.int32)]),
            np.concatenate([number[polygons.vertices[of_rest]].astype(np.int32), quads.reshape(-1)]),
        ),
        kept_vertices=kept,
        kept_faces=kept_faces,
        quads=quads,
        report=result.report,
    )


def _nudged(points: FloatArray, even: EvenPart) -> FloatArray:
    """(s, 3) the sheet's vertices; those along cuts a little off from all others of their places."""
    origin = even.sheet.origin
    sheet_points = points[origin]
    if not even.cuts:
        return sheet_points
    along = np.unique(np.concatenate([origin[list(bank)] for cut in even.cuts for bank in cut]))
    copies = np.flatnonzero(np.isin(origin, along))
    copies = copies[np.argsort(origin[copies], kind="stable")]
    _, first, count = np.unique(origin[copies], return_index=True, return_counts=True)
    rank = np.arange(len(copies)) - np.repeat(first, count)
    diagonal = float(np.linalg.norm(np.ptp(sheet_points, axis=0)))
    sheet_points[copies] += (_NUDGE * diagonal * rank)[:, None]
    return sheet_points
