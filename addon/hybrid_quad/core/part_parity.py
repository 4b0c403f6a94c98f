"""Borders of a part, each with an even number of edges: the boundary of a surface of quads has no other.

A part's border is odd where an odd number of its faces have an odd number of sides, so that one triangle more or less makes it
even. Two odd borders of one piece become an even one by a cut from one to the other, which is closed again afterwards.
"""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .edge_borders import BoolArray, edge_keys
from .errors import InputError
from .mesh_arrays import FloatArray, Polygons
from .part_sheet import CUT, FREE, INNER, SHARED, Indices, PartSheet, sheet_of, sides_among


class Cut(NamedTuple):
    """A path along which a sheet was cut.

    Attributes
    ----------
    forward, backward : tuple of int
        Sheet vertices along both banks, as the faces beside run through them: `backward` begins where `forward` ends.
    """

    forward: tuple[int, ...]
    backward: tuple[int, ...]


class EvenPart(NamedTuple):
    """A part that quads can fill.

    Attributes
    ----------
    part : (#F,) bool
        As it was chosen, or with faces more or less.
    sheet : PartSheet
    cuts : tuple of Cut
    """

    part: BoolArray
    sheet: PartSheet
    cuts: tuple[Cut, ...]


def even_part(
    points: FloatArray,
    polygons: Polygons,
    part: BoolArray,
    odd_border: str = "refuse",
    ask: Callable[[], object] = lambda: None,
) -> EvenPart:
    """A part all of whose borders are even, or partly the mesh's own and so free to be.

    Parameters
    ----------
    points : (n, 3) float64
    polygons : Polygons
    part : (#F,) bool
    odd_border : {"refuse", "grow", "shrink"}
        What to do about a piece whose borders have an odd number of edges in all: refuse, or take in or leave out a face
        with an odd number of sides at its border.
    ask : callable()
        Called between steps; what it raises ends this.

    Raises
    ------
    InputError
        ``odd_border``, ``no_way_between_borders``, and what :func:`sheet_of` raises; names the edges.
    """
    part = part.copy()
    for _ in range(int(part.sum()) + 1):
        ask()
        sheet = sheet_of(polygons, len(points), part, ask=ask)
        ask()
        odd = _odd_pieces(sheet)
        if not len(odd):
            return EvenPart(part, *_cut(points, polygons, part, sheet, ask))
        if odd_border == "refuse":
            raise _odd_error(sheet, odd[0], odd_border)
        candidates = _odd_faces(polygons, len(points), part, sheet, odd_border)
        for piece in odd:
            face = candidates.get(piece)
            if face is None:
                raise _odd_error(sheet, piece, odd_border)
            part[face] = odd_border == "grow"
    raise _odd_error(sheet, odd[0], odd_border)  # not reached: each round takes or gives a face


def _odd_pieces(sheet: PartSheet) -> list[int]:
    """Components whose borders have an odd number of edges in all, none of which may change."""
    owner = np.repeat(sheet.components, sheet.polygons.sizes)
    count = np.bincount(owner[sheet.kinds == SHARED], minlength=len(sheet.faces))
    is_free = np.bincount(owner[sheet.kinds == FREE], minlength=len(sheet.faces)) > 0
    pieces: list[int] = np.flatnonzero((count % 2 == 1) & ~is_free).tolist()
    return pieces


def _odd_error(sheet: PartSheet, piece: int, odd_border: str) -> InputError:
    owner = np.repeat(sheet.components, sheet.polygons.sizes)
    edges = sheet.origin[sheet.sides[(sheet.kinds == SHARED) & (owner == piece)]]
    hint = {
        "refuse": "Choose one triangle more or less at it",
        "grow": "There is no triangle beside it that could be taken in; choose other faces",
        "shrink": "There is no triangle at it that could be left out; choose other faces",
    }[odd_border]
    return InputError(
        "odd_border",
        f"The border of the chosen faces has {len(edges)} edges, and quads need an even number. {hint}.",
        "edge",
        edges.reshape(-1).tolist(),
    )


def _odd_faces(
    polygons: Polygons, vertex_count: int, part: BoolArray, sheet: PartSheet, odd_border: str
) -> dict[int, int]:
    """By piece the face with an odd number of sides that shares most edges with its border, from outside or inside."""
    shared = sheet.kinds == SHARED
    piece = np.repeat(sheet.components, sheet.polygons.sizes)[shared]
    border = edge_keys(sheet.origin[sheet.shared], vertex_count)  # type: ignore[arg-type]
    order = np.argsort(border)
    is_at_border = np.zeros(vertex_count, np.bool_)
    is_at_border[sheet.origin[sheet.shared]] = True
    corners, ends = sides_among(polygons, is_at_border)
    sides = edge_keys(ends, vertex_count)  # type: ignore[arg-type]
    face = np.searchsorted(np.cumsum(polygons.sizes), corners, "right")
    fits = np.isin(sides, border) & ((part if odd_border == "shrink" else ~part) & (polygons.sizes % 2 == 1))[face]
    own = piece[order][np.searchsorted(border[order], sides[fits])]
    pairs, common = np.unique(np.stack([own, face[fits]], axis=1), axis=0, return_counts=True)
    best: dict[int, tuple[int, int]] = {}
    for (of_piece, candidate), count in zip(pairs.tolist(), common.tolist(), strict=True):
        if of_piece not in best or count > best[of_piece][0]:
            best[of_piece] = (count, candidate)
    return {of_piece: candidate for of_piece, (_, candidate) in best.items()}


def _cut(
    points: FloatArray, polygons: Polygons, part: BoolArray, sheet: PartSheet, ask: Callable[[], object]
) -> tuple[PartSheet, tuple[Cut, ...]]:
    """The sheet, cut from each odd border to another odd one of its piece, or to one that is partly free."""
    paths: list[tuple[Indices, Indices]] = []  # sides along both banks
    while True:
        ask()
        loops = sheet.loops()
        odd = [_is_odd(sheet, loop) for loop in loops]
        if not any(odd):
            return sheet, tuple(_banks(sheet, *path) for path in paths)
        first = odd.index(True)
        piece = sheet.component_of(int(loops[first][0]))
        others = [
            (loop, odd[index] or (sheet.kinds[loop] == FREE).any())
            for index, loop in enumerate(loops)
            if index != first and sheet.component_of(int(loop[0])) == piece
        ]
        path = _shortest_path(points, sheet, loops[first], [loop for loop, is_end in others if is_end])
        if path is None:  # even borders are in the way: one of them becomes part of this one
            path = _shortest_path(points, sheet, loops[first], [loop for loop, _ in others])
        if path is None:
            edges = sheet.origin[sheet.sides[loops[first]]]
            raise InputError(
                "no_way_between_borders",
                f"A border of {len(edges)} edges needs a way along edges to another border of the chosen faces. Choose other faces.",
                "edge",
                edges.reshape(-1).tolist(),
            )
        paths.append(path)
        sheet = sheet_of(
            polygons, len(points), part, np.concatenate([bank for both in paths for bank in both]).tolist(), ask
        )


def _is_odd(sheet: PartSheet, loop: Indices) -> bool:
    kinds = sheet.kinds[loop]
    return not (kinds == FREE).any() and int((kinds == SHARED).sum()) % 2 == 1


def _shortest_path(
    points: FloatArray, sheet: PartSheet, start: Indices, targets: list[Indices]
) -> tuple[Indices, Indices] | None:
    """Inner sides from one border to others that pass no border between: along the way, and back on the other side.

    They begin and end where a side is that was a border before all cuts: the banks of a cut are to stay in one piece.
    """
    if not targets:
        return None
    sides = sheet.sides
    on_rim = np.zeros(len(sheet.origin), np.bool_)
    on_rim[sides[sheet.kinds != INNER]] = True
    is_target = np.zeros(len(sheet.origin), np.bool_)
    is_target[sides[_ends_for_cuts(sheet, np.concatenate(targets))]] = True
    inner = np.flatnonzero(sheet.kinds == INNER)
    side_between = {(int(a), int(b)): int(side) for side, (a, b) in zip(inner, sides[inner], strict=True)}
    ways: dict[int, list[int]] = {}
    for a, b in side_between:
        ways.setdefault(a, []).append(b)
    place = points[sheet.origin]
    distance = dict.fromkeys(sides[_ends_for_cuts(sheet, start)].ravel().tolist(), 0.0)
    before: dict[int, int] = {}
    queue = [(0.0, vertex) for vertex in sorted(distance)]
    while queue:
        so_far, vertex = heapq.heappop(queue)
        if so_far > distance[vertex]:
            continue
        if is_target[vertex]:
            path = [vertex]
            while path[-1] in before:
                path.append(before[path[-1]])
            path.reverse()
            pairs = list(itertools.pairwise(path))
            there = np.array([side_between[pair] for pair in pairs], np.int64)
            back = np.array([side_between[b, a] for a, b in reversed(pairs)], np.int64)
            return there, back
        for other in ways.get(vertex, ()):
            if on_rim[other] and not is_target[other]:
                continue
            reached = so_far + float(np.linalg.norm(place[other] - place[vertex]))
            if reached < distance.get(other, np.inf):
                distance[other] = reached
                before[other] = vertex
                heapq.heappush(queue, (reached, other))
    return None


def _ends_for_cuts(sheet: PartSheet, loop: Indices) -> Indices:
    own: Indices = loop[sheet.kinds[loop] != CUT]
    return own


def _banks(sheet: PartSheet, there: Indices, back: Indices) -> Cut:
    sides = sheet.sides
    assert (sheet.kinds[there] == CUT).all()
    forward, backward = ((*sides[bank, 0].tolist(), int(sides[bank[-1], 1])) for bank in (there, back))
    return Cut(forward, backward)
