"""Some faces of a mesh as a surface of their own, and what their border has to be like for quads to fit in."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .corner_fans import fans_of_corners
from .edge_borders import BoolArray, edge_keys, following_corners
from .errors import InputError
from .graph_components import component_labels
from .mesh_arrays import FloatArray, Polygons

Indices = npt.NDArray[np.int64]

INNER, SHARED, FREE, CUT = range(4)
"""Kinds of a polygon's sides: between two faces of the part; beside a face of the rest; the mesh's own border; cut."""


@dataclass(frozen=True)
class PartSheet:
    """The faces of a part, joined only where they have a common edge, and not across cuts.

    Attributes
    ----------
    faces : (f,) int64
        Of the whole mesh.
    polygons : Polygons
        The same faces, of the sheet's vertices.
    origin : (s,) int64
        The whole mesh's vertex that each vertex of the sheet is. Where the part touches itself in a vertex, and along cuts,
        several are one.
    kinds : (C,) int64
        Of the side from each corner to the next one.
    components : (f,) int64
        The connected part that each face is in.
    """

    faces: Indices
    polygons: Polygons
    origin: Indices
    kinds: Indices
    components: Indices

    @property
    def sides(self) -> Indices:
        """(C, 2) sheet vertices at which the side of each corner begins and ends."""
        return sides_of(self.polygons)

    @property
    def shared(self) -> Indices:
        """(k, 2) sides beside the rest, as the part's faces run through them."""
        shared: Indices = self.sides[self.kinds == SHARED]
        return shared

    def loops(self) -> list[Indices]:
        """The sides (corners) around each border, cuts among them, in order."""
        rim = np.flatnonzero(self.kinds != INNER)
        sides = self.sides
        side_from = np.full(len(self.origin), -1, np.int64)
        side_from[sides[rim, 0]] = rim
        left = np.zeros(len(self.kinds), np.bool_)
        left[rim] = True
        loops = []
        for start in rim.tolist():
            loop = []
            side = start
            while left[side]:
                left[side] = False
                loop.append(side)
                side = int(side_from[sides[side, 1]])
            if loop:
                loops.append(np.array(loop, np.int64))
        return loops

    def component_of(self, corner: int) -> int:
        """The connected part that a corner's face is in."""
        return int(self.components[np.searchsorted(np.cumsum(self.polygons.sizes), corner, "right")])


def sheet_of(
    polygons: Polygons,
    vertex_count: int,
    part: BoolArray,
    cuts: Iterable[int] = (),
    ask: Callable[[], object] = lambda: None,
) -> PartSheet:
    """The sheet of a part.

    Parameters
    ----------
    polygons : Polygons
        Of the whole mesh.
    part : (#F,) bool
    cuts : iterable of int
        Inner sides (corners of the part's faces, counted among these) that are cut; both sides of an edge.
    ask : callable()
        Called between steps; what it raises ends this.

    Raises
    ------
    InputError
        ``no_part``, ``non_manifold_part``, ``flipped_part``; names the edges.
    """
    if not part.any():
        raise InputError("no_part", "No face is chosen: there is nothing to remesh.")
    sides = _Sides.of(polygons, vertex_count, part)
    ask()
    _require_manifold(sides, vertex_count)
    ask()
    inside = np.repeat(part, polygons.sizes)
    own = Polygons(polygons.sizes[part], polygons.vertices[inside])
    kinds = _kinds_of_sides(sides)
    kinds[list(cuts)] = CUT
    ask()
    fans = fans_of_corners(own, kinds != INNER)
    ask()
    origin = np.zeros(int(fans.max()) + 1, np.int64)
    origin[fans] = own.vertices
    sheet = Polygons(own.sizes, fans.astype(np.int32))
    return PartSheet(np.flatnonzero(part), sheet, origin, kinds, _components(own, vertex_count))


def sides_of(polygons: Polygons) -> Indices:
    """(C, 2) vertices at which the side of each corner begins and ends."""
    sides: Indices = np.stack([polygons.vertices, polygons.vertices[following_corners(polygons)]], axis=1)
    return sides.astype(np.int64)


def sides_among(polygons: Polygons, is_among: BoolArray) -> tuple[Indices, Indices]:
    """Corners at which sides begin both of whose ends are among some vertices, in their order, and (k, 2) these sides."""
    near = is_among[polygons.vertices]
    following = following_corners(polygons)
    corners = np.flatnonzero(near & near[following])
    sides = np.stack([polygons.vertices[corners], polygons.vertices[following[corners]]], axis=1)
    return corners, sides.astype(np.int64)


class _Sides(NamedTuple):
    """Sides of the part's faces, and those of the rest that may be on them: of two vertices of the part."""

    ends: Indices  # (k, 2)
    keys: Indices
    inside: BoolArray  # of the part's faces; these are all there, in their order

    @classmethod
    def of(cls, polygons: Polygons, vertex_count: int, part: BoolArray) -> _Sides:
        of_part = np.repeat(part, polygons.sizes)
        is_vertex = np.zeros(vertex_count, np.bool_)
        is_vertex[polygons.vertices[of_part]] = True
        corners, ends = sides_among(polygons, is_vertex)
        return cls(ends, edge_keys(ends, vertex_count), of_part[corners])  # type: ignore[arg-type]


def _kinds_of_sides(sides: _Sides) -> Indices:
    """(C,) kinds of the sides at the part's corners."""
    own, others = sides.keys[sides.inside], np.sort(sides.keys[~sides.inside])
    _, edge, uses = np.unique(own, return_inverse=True, return_counts=True)
    is_single = uses[edge.reshape(-1)] == 1
    place = np.minimum(np.searchsorted(others, own), max(len(others) - 1, 0))
    is_shared = others[place] == own if len(others) else np.zeros(len(own), np.bool_)
    kinds: Indices = np.where(is_single, np.where(is_shared, SHARED, FREE), INNER)
    return kinds


def _require_manifold(sides: _Sides, vertex_count: int) -> None:
    ends, keys, inside = sides
    edges, edge = np.unique(keys, return_inverse=True)
    edge = edge.reshape(-1)
    uses = np.bincount(edge, minlength=len(edges))
    own = np.bincount(edge[inside], minlength=len(edges))
    # One face of the part may meet several of the rest: for the part that is a border as any other.
    bad = (own > 1) & (uses > 2)
    if bad.any():
        raise InputError(
            "non_manifold_part",
            f"{int(bad.sum())} edges of the chosen faces have more than two faces, so it is not clear how these go together. "
            "Choose fewer faces there.",
            "edge",
            _vertex_pairs(edges[bad], vertex_count),
        )
    forward = np.bincount(edge[inside & (ends[:, 0] < ends[:, 1])], minlength=len(edges))
    against = (own == 2) & (forward != 1)
    if against.any():
        raise InputError(
            "flipped_part",
            f"At {int(against.sum())} edges of the chosen faces, neighbours face opposite ways. Make them face one way first.",
            "edge",
            _vertex_pairs(edges[against], vertex_count),
        )


def _vertex_pairs(keys: npt.NDArray[np.int64], vertex_count: int) -> list[int]:
    pairs: list[int] = np.stack(np.divmod(keys, vertex_count), axis=1).reshape(-1).tolist()
    return pairs


def _components(polygons: Polygons, vertex_count: int) -> Indices:
    """(f,) number of the edge-connected component of each face."""
    owner = np.repeat(np.arange(len(polygons.sizes)), polygons.sizes)
    keys = edge_keys(sides_of(polygons), vertex_count)  # type: ignore[arg-type]
    order = np.argsort(keys, kind="stable")
    same = keys[order][1:] == keys[order][:-1]
    one, other = owner[order][:-1][same], owner[order][1:][same]
    return component_labels(len(polygons.sizes), one, other)


def border_length(points: FloatArray, sheet: PartSheet) -> float:
    """Mean length of the edges that a part shares with the rest; of all its edges, where it shares none."""
    sides = sheet.shared if len(sheet.shared) else sheet.sides
    ends = points[sheet.origin[sides]]
    return float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean())
