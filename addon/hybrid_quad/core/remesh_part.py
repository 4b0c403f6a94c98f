"""Remeshes some faces of a mesh and leaves the rest as it is, to the last bit."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .curve_counts import CurveCount, as_curve_counts
from .edge_borders import BoolArray, edge_keys
from .errors import InputError
from .guide_values import guides_of_vertices
from .mesh_arrays import FacesLike, FloatArray, IntArray, Polygons, as_edges, as_polygons, as_vertices, require_edges
from .options import RemeshOptions
from .part_parity import ODD_BORDERS, EvenPart, even_part
from .part_sheet import INNER, Indices, border_length, sides_of
from .part_weld import PartResult, rim_of, welded
from .remesh import CancelCallback, ProgressCallback, remesh_with_options, usual_length
from .strokes import Stroke
from .surface_points import fan_triangles, nearest_on_surface
from .validation import violations

_NUDGE = 1e-9  # of the diagonal: how far the banks of a cut are apart, so that nobody takes them for a crack to close


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
    strokes: Iterable[Stroke] = (),
    density: npt.ArrayLike | None = None,
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
    sharp_edges, curve_counts, guides, strokes, density
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
    asked = RemeshOptions(**options, **({} if quads is None else {"quads": quads}), edge_length=edge_length)
    result = remesh_part_with_options(
        points,
        polygons,
        part,
        asked,
        uses_border_length=quads is None and edge_length is None and asked.chord_error is None,
        odd_border=odd_border,
        sharp_edges=sharp_edges,
        curve_counts=curve_counts,
        guides=guides,
        strokes=strokes,
        density=density,
        progress=progress,
        cancel=cancel,
    )
    return joined(points, polygons, result)


def remesh_part_with_options(
    points: FloatArray,
    polygons: Polygons,
    part: npt.ArrayLike,
    options: RemeshOptions,
    *,
    uses_border_length: bool = False,
    odd_border: str = "refuse",
    sharp_edges: npt.ArrayLike | Iterable[Sequence[int]] | None = None,
    curve_counts: Iterable[CurveCount] | None = None,
    guides: npt.ArrayLike | None = None,
    strokes: Iterable[Stroke] = (),
    density: npt.ArrayLike | None = None,
    progress: ProgressCallback | None = None,
    cancel: CancelCallback | None = None,
) -> PartResult:
    """:func:`remesh_part` with the settings in one value, and the quads alone; :func:`joined` puts them into the mesh.

    Parameters
    ----------
    uses_border_length : bool
        Whether the mean length of the edges between part and rest is the quads', whatever `options` say.
    """
    if options.symmetry or options.fit_limit_surface:
        raise ValueError("symmetry and fit_limit_surface need the whole surface: switch them off to remesh a part of it")
    if odd_border not in ODD_BORDERS:
        raise ValueError(f"odd_border must be one of {', '.join(ODD_BORDERS)}, not {odd_border!r}")
    chosen = as_part(part, len(polygons.sizes))
    _require_indices(points, polygons)
    even = even_part(points, polygons, chosen, odd_border)
    _require_welded(points, even)
    length = border_length(points, even.sheet)
    if uses_border_length:
        options = dataclasses.replace(options, edge_length=length)
    sheet_points = _nudged(points, even)
    marked = as_edges(sharp_edges)
    require_edges(marked, polygons, len(points))
    own = _OfSheet(even, points, polygons)
    own_counts = own.curve_counts(as_curve_counts(curve_counts))
    own_strokes, crossing = own.strokes(strokes)
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
            density=own.values(density),
            progress=progress,
            cancel=cancel,
        )
    except InputError as error:
        raise own.error_of_whole(error) from error
    own.complete_report(result.report, len(own_counts), crossing)
    found = welded(result, points, even, sheet_points)
    _require_sound(found, points, polygons)
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
        raise InputError("unknown_face", f"{int(outside.sum())} of the chosen faces do not exist.", "face", array[outside])
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


class _OfSheet:
    """What is asked of the whole mesh, for the sheet of a part."""

    def __init__(self, even: EvenPart, points: FloatArray, polygons: Polygons) -> None:
        self._sheet, self._cuts = even.sheet, even.cuts
        self._points, self._polygons, self._part = points, polygons, even.part
        sides = even.sheet.sides
        keys = edge_keys(even.sheet.origin[sides], len(points))  # type: ignore[arg-type]
        self._is_inner = even.sheet.kinds == INNER
        self._edge_of = {int(key): (int(a), int(b)) for key, (a, b) in zip(keys, sides, strict=True)}
        self._inner = set(keys[self._is_inner].tolist())

    def edges(self, edges: IntArray) -> IntArray:
        """Those of some edges that are inside the part."""
        keys = edge_keys(edges, len(self._points)).tolist() if len(edges) else []
        return as_edges([self._edge_of[key] for key in keys if key in self._inner])

    def curve_counts(self, counts: list[tuple[list[int], int]]) -> list[tuple[list[int], int]]:
        """Those of some paths all of whose edges are inside the part."""
        found = []
        for path, count in counts:
            pairs = np.stack([path[:-1], path[1:]], axis=1).astype(np.int64)
            keys = edge_keys(pairs, len(self._points)).tolist()  # type: ignore[arg-type]
            if not keys or any(key not in self._inner for key in keys):
                continue
            edges = [self._edge_of[key] for key in keys]
            own = [edge[0] if self._sheet.origin[edge[0]] == v else edge[1] for edge, v in zip(edges, path[:-1], strict=True)]
            own.append(edges[-1][0] if self._sheet.origin[edges[-1][0]] == path[-1] else edges[-1][1])
            found.append((own, count))
        return found

    def cut_counts(self, sheet_points: FloatArray, options: RemeshOptions) -> list[tuple[list[int], int]]:
        """Both banks of every cut, with one number of quads."""
        edge_length = usual_length(sheet_points, self._sheet.polygons, options)
        counts = []
        for cut in self._cuts:
            along = sheet_points[list(cut.forward)]
            length = float(np.linalg.norm(np.diff(along, axis=0), axis=1).sum())
            count = max(1, round(length / edge_length))
            counts += [(list(cut.forward), count), (list(cut.backward), count)]
        return counts

    def values(self, values: npt.ArrayLike | None) -> FloatArray | None:
        """(s, ...) values of vertices, or directions of faces, for the sheet's vertices."""
        if values is None:
            return None
        array = np.asarray(values, np.float64)
        if len(array) == len(self._part) != len(self._points) and array.shape[1:] == (3,):
            array = guides_of_vertices(array, self._polygons, len(self._points))
        if len(array) != len(self._points):
            raise ValueError(f"values must be one for each of {len(self._points)} vertices, not of shape {array.shape}")
        return array[self._sheet.origin]

    def strokes(self, strokes: Iterable[Stroke]) -> tuple[list[Stroke], int]:
        """Directions, and the loops and rings that lie in the part; how many are partly in it, and left out."""
        inside, crossing = [], 0
        triangles = fan_triangles(self._polygons)
        owner = np.repeat(np.arange(len(self._polygons.sizes)), np.maximum(self._polygons.sizes - 2, 0))
        for stroke in strokes:
            if stroke.kind == "direction":
                inside.append(stroke)
                continue
            nearest = nearest_on_surface(stroke.points, self._points, triangles).triangles
            is_in = self._part[owner[nearest]]
            if is_in.all():
                inside.append(stroke)
            elif is_in.any():
                crossing += 1
        return inside, crossing

    def complete_report(self, report: dict[str, Any], asked_counts: int, crossing: int) -> None:
        """Names elements of the whole mesh, and leaves out the counts that only the border asked for."""
        report["curve_counts"] = report["curve_counts"][:asked_counts]
        own = [w for w in report["warnings"] if not _is_of_border(w, asked_counts)]
        report["warnings"] = own
        if crossing:
            own.append(f"{crossing} loops and rings cross the border of the part, and are left out")
        for defect in report["defects"]:
            defect["elements"] = self._of_whole(defect["element_kind"], defect["elements"])
        report["part"] = {
            "faces": len(self._sheet.faces),
            "border_edges": len(self._sheet.shared),
            "cuts": len(self._cuts),
        }

    def error_of_whole(self, error: InputError) -> InputError:
        """An error of the sheet's run, with the elements of the whole mesh."""
        elements = list(error.elements)
        if error.element_kind == "edge":
            pairs = [list(pair) for pair in zip(elements[0::2], elements[1::2], strict=True)]
            elements = [v for pair in self._of_whole("edge", pairs) for v in pair]
        else:
            elements = self._of_whole(error.element_kind, elements)
        return InputError(error.code, str(error), error.element_kind, elements)

    def _of_whole(self, kind: str, elements: list[Any]) -> list[Any]:
        table = {"vertex": self._sheet.origin, "edge": self._sheet.origin, "face": self._sheet.faces}.get(kind)
        if table is None or not elements:
            return elements
        whole: list[Any] = table[np.array(elements, np.int64)].tolist()
        return whole


def _is_of_border(warning: str, asked_counts: int) -> bool:
    """Whether a warning is of a number that the caller did not ask for; a missed one is an error later on."""
    head, name, rest = warning.partition("Curve ")
    return bool(name) and "of curve_counts" in rest and int(rest.split(" ", 1)[0]) >= asked_counts


def _nudged(points: FloatArray, even: EvenPart) -> FloatArray:
    """(s, 3) the sheet's vertices; those on one bank of each cut a little off."""
    sheet_points = points[even.sheet.origin]
    if even.cuts:
        diagonal = float(np.linalg.norm(np.ptp(sheet_points, axis=0)))
        for cut in even.cuts:
            sheet_points[list(cut.backward)] += _NUDGE * diagonal
    return sheet_points


def _require_indices(points: FloatArray, polygons: Polygons) -> None:
    outside = (polygons.vertices < 0) | (polygons.vertices >= len(points))
    if outside.any():
        faces = np.unique(np.repeat(np.arange(len(polygons.sizes)), polygons.sizes)[outside])
        raise InputError("index_out_of_range", "Faces have vertices that do not exist.", "face", faces.tolist())


def _require_welded(points: FloatArray, even: EvenPart) -> None:
    """Vertices that share the border's places would be merged with it."""
    sheet = even.sheet
    used = np.unique(sheet.origin)
    _, place, count = np.unique(points[used], axis=0, return_inverse=True, return_counts=True)
    doubled = used[count[place.reshape(-1)] > 1]
    found = np.intersect1d(doubled, sheet.origin[sheet.shared])
    if len(found):
        raise InputError(
            "unwelded_border",
            f"{len(found)} vertices at the border of the chosen faces lie in one place with others. Merge them first, or choose "
            "other faces.",
            "vertex",
            found.tolist(),
        )


def _require_sound(result: PartResult, points: FloatArray, polygons: Polygons) -> None:
    """The quads are valid by themselves, and none of their edges inside is one of the rest's."""
    problems = violations(result.vertices, result.quads)
    if problems:
        raise InputError(
            "part_too_coarse",
            f"The chosen faces are too few for quads of this size ({'; '.join(problems)}). Ask for smaller ones.",
        )
    sides = result.whole_vertices[np.stack([result.quads, np.roll(result.quads, -1, axis=1)], axis=-1).reshape(-1, 2)]
    keys = edge_keys(sides[(sides >= 0).all(axis=1)], len(points))  # type: ignore[arg-type]
    rim = edge_keys(result.whole_vertices[rim_of(result.quads)], len(points))  # type: ignore[arg-type]
    of_rest = np.repeat(~result.part, polygons.sizes)
    rest = edge_keys(sides_of(polygons)[of_rest], len(points))  # type: ignore[arg-type]
    doubled = np.intersect1d(np.setdiff1d(keys, rim), rest)
    if len(doubled):
        raise InputError(
            "part_too_coarse",
            f"{len(doubled)} edges of the quads would join vertices that an edge of the rest joins already. Ask for smaller "
            "quads, or choose more faces.",
            "edge",
            np.stack(np.divmod(doubled, len(points)), axis=1).reshape(-1).tolist(),
        )
