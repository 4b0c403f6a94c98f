"""What is asked of a whole mesh, for the sheet of a part; and what comes back, for the whole mesh."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from .edge_borders import BoolArray, edge_keys
from .errors import InputError
from .guide_values import guides_of_vertices
from .mesh_arrays import FloatArray, IntArray, Polygons, as_edges
from .options import RemeshOptions
from .part_parity import EvenPart
from .part_sheet import INNER, Indices
from .remesh import usual_length
from .strokes import Stroke
from .surface_points import fan_triangles, nearest_on_surface


class PartWishes:
    """What is asked of the whole mesh, for the sheet of a part."""

    def __init__(self, even: EvenPart, points: FloatArray, polygons: Polygons) -> None:
        self._sheet, self._cuts = even.sheet, even.cuts
        self._points, self._polygons, self._part = points, polygons, even.part
        sides = even.sheet.sides
        keys = edge_keys(even.sheet.origin[sides], len(points))  # type: ignore[arg-type]
        order = np.argsort(keys, kind="stable")
        self._keys, self._sides = keys[order], sides[order]
        self._inner = np.sort(keys[even.sheet.kinds == INNER])

    def edges(self, edges: IntArray) -> IntArray:
        """Those of some edges that are inside the part."""
        keys = edge_keys(edges, len(self._points))
        return as_edges(self._sides_of(keys[self._are_inner(keys)]))

    def curve_counts(self, counts: list[tuple[list[int], int]]) -> list[tuple[list[int], int]]:
        """Those of some paths all of whose edges are inside the part."""
        found = []
        for path, count in counts:
            pairs = np.stack([path[:-1], path[1:]], axis=1).astype(np.int64)
            keys = edge_keys(pairs, len(self._points))  # type: ignore[arg-type]
            if not len(keys) or not self._are_inner(keys).all():
                continue
            edges = self._sides_of(keys).tolist()
            own = [
                edge[0] if self._sheet.origin[edge[0]] == v else edge[1]
                for edge, v in zip(edges, path[:-1], strict=True)
            ]
            own.append(edges[-1][0] if self._sheet.origin[edges[-1][0]] == path[-1] else edges[-1][1])
            found.append((own, count))
        return found

    def _are_inner(self, keys: Indices) -> BoolArray:
        """Whether edges are inside the part."""
        if not len(self._inner):
            return np.zeros(len(keys), np.bool_)
        place = np.minimum(np.searchsorted(self._inner, keys), len(self._inner) - 1)
        are: BoolArray = self._inner[place] == keys
        return are

    def _sides_of(self, keys: Indices) -> Indices:
        """(k, 2) sheet vertices of edges of the part; of several sides of an edge, the last."""
        sides: Indices = self._sides[np.searchsorted(self._keys, keys, "right") - 1]
        return sides

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
        given = list(strokes)
        if any(stroke.kind != "direction" for stroke in given):
            triangles = fan_triangles(self._polygons)
            owner = np.repeat(np.arange(len(self._polygons.sizes)), np.maximum(self._polygons.sizes - 2, 0))
        for stroke in given:
            if stroke.kind == "direction":
                inside.append(stroke)
                continue
            with np.errstate(over="ignore"):  # of a line that is far off any place will do
                nearest = nearest_on_surface(stroke.points, self._points, triangles).triangles
            is_in = self._part[owner[nearest]]
            if is_in.all():
                inside.append(stroke)
            elif is_in.any():
                crossing += 1
        return inside, crossing

    def complete_report(self, report: dict[str, Any], asked_counts: int, crossing: int, chosen: int) -> None:
        """Names elements of the whole mesh, and leaves out the counts that only the border asked for."""
        report["curve_counts"] = report["curve_counts"][:asked_counts]
        own = [w for w in report["warnings"] if not _is_of_border(w, asked_counts)]
        report["warnings"] = own
        if crossing:
            own.append(f"{crossing} loops and rings cross the border of the part, and are left out")
        more = len(self._sheet.faces) - chosen
        if more:
            what = f"{more} faces were taken in" if more > 0 else f"{-more} of the chosen faces were left out"
            own.append(f"{what}, so that borders have even numbers of edges")
        for defect in report["defects"]:
            defect["elements"] = self._of_whole(defect["element_kind"], defect["elements"])
        report["part"] = {
            "faces": len(self._sheet.faces),
            "chosen_faces": chosen,
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
    _, name, rest = warning.partition("Curve ")
    return bool(name) and "of curve_counts" in rest and int(rest.split(" ", 1)[0]) >= asked_counts
