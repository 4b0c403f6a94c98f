"""The quads of a part's sheet, closed along its cuts and matched with the border, vertex by vertex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .edge_borders import BoolArray, edge_keys
from .errors import InputError
from .mesh_arrays import FloatArray, IntArray
from .part_parity import Cut, EvenPart
from .part_sheet import FREE, Indices, PartSheet
from .remesh import RemeshResult


@dataclass(frozen=True, eq=False)
class PartResult(RemeshResult):
    """The quads of a part alone, as :class:`RemeshResult`, and how they fit into the whole mesh.

    Attributes
    ----------
    whole_vertices : (n,) int64
        The whole mesh's vertex that each vertex is, or -1. Where the part touches itself in a vertex, several are that one.
    part : (#F,) bool
        The faces of the whole mesh in whose place the quads are.
    """

    whole_vertices: Indices
    part: BoolArray


def welded(result: RemeshResult, points: FloatArray, even: EvenPart, sheet_points: FloatArray) -> PartResult:
    """The quads of a sheet as a part of the whole mesh.

    Parameters
    ----------
    result : RemeshResult
        Of the sheet, with exactly one quad edge along each shared side, and equal numbers along both banks of cuts.
    points : (n, 3) float64
        The whole mesh's vertices.
    sheet_points : (s, 3) float64
        The sheet's vertices as they were remeshed; those along cuts all different.

    Raises
    ------
    InputError
        ``border_missed``, where the quads are not as they were asked to be; names the edges.
    """
    sheet = even.sheet
    rim = rim_of(result.quads)
    following = dict(rim.tolist())
    ends = np.unique(np.concatenate([sheet.shared.reshape(-1), *(np.array(_ends(cut)) for cut in even.cuts)]))
    number_at = {sheet_points[number].tobytes(): number for number in ends.astype(np.int64).tolist()}
    sheet_vertex = {vertex: number_at.get(result.vertices[vertex].tobytes(), -1) for vertex in following}
    vertex_of = {number: vertex for vertex, number in sheet_vertex.items() if number >= 0}
    label = np.arange(len(result.vertices))
    for cut in even.cuts:
        banks = [_walk(following, vertex_of, bank) for bank in cut]
        if not banks[0] or len(banks[0]) != len(banks[1]):
            raise _missed(sheet, sheet.shared)
        for one, other in zip(banks[0], reversed(banks[1]), strict=True):
            label[label == label[other]] = label[one]
    whole = np.full(len(result.vertices), -1, np.int64)
    for vertex, number in sheet_vertex.items():
        if number >= 0:
            whole[vertex] = sheet.origin[number]
    glued = _glued(result, label, whole, points, even.part)
    _require_border(glued, sheet)
    return glued


def rim_of(quads: IntArray) -> Indices:
    """(k, 2) sides that no other quad has, as their quads run."""
    sides = np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2).astype(np.int64)
    keys = edge_keys(sides, int(quads.max()) + 1)  # type: ignore[arg-type]
    _, edge, uses = np.unique(keys, return_inverse=True, return_counts=True)
    rim: Indices = sides[uses[edge.reshape(-1)] == 1]
    return rim


def _ends(cut: Cut) -> list[int]:
    return [cut.forward[0], cut.forward[-1], cut.backward[0], cut.backward[-1]]


def _walk(following: dict[int, int], vertex_of: dict[int, int], bank: tuple[int, ...]) -> list[int]:
    """The quads' vertices along a bank; none where it can't be followed."""
    if bank[0] not in vertex_of or bank[-1] not in vertex_of:
        return []
    path, last = [vertex_of[bank[0]]], vertex_of[bank[-1]]
    while path[-1] != last and len(path) <= len(following):
        path.append(following[path[-1]])
    return path if path[-1] == last else []


def _glued(result: RemeshResult, label: Indices, whole: Indices, points: FloatArray, part: BoolArray) -> PartResult:
    """The result with vertices of one label made one, in the middle of them or where the whole mesh has them."""
    _, first, group = np.unique(label, return_index=True, return_inverse=True)
    group = group.reshape(-1)
    vertices = np.zeros((len(first), 3))
    np.add.at(vertices, group, result.vertices)
    count = np.bincount(group)
    vertices /= count[:, None]
    vertices[count == 1] = result.vertices[first[count == 1]]
    of_group = np.full(len(first), -1, np.int64)
    np.maximum.at(of_group, group, whole)
    known = of_group >= 0
    vertices[known] = points[of_group[known]]
    kinds = np.zeros(len(first), np.uint8)
    np.maximum.at(kinds, group, result.vertex_kinds)
    return PartResult(
        vertices=vertices,
        quads=group[result.quads].astype(np.int32),
        feature_edges=group[result.feature_edges].astype(np.int32).reshape(-1, 2),
        feature_curves=result.feature_curves,
        vertex_kinds=kinds,
        report=result.report,
        whole_vertices=of_group,
        part=part,
    )


def _require_border(glued: PartResult, sheet: PartSheet) -> None:
    """Each shared side is a side of one quad that runs the same way, and nothing else is open but the mesh's own border."""
    rim = glued.whole_vertices[rim_of(glued.quads)].tolist()
    got = {(a, b) for a, b in rim}
    asked = sheet.origin[sheet.shared].tolist()
    missed = np.array([(a, b) not in got for a, b in asked], np.bool_)
    if missed.any():
        raise _missed(sheet, sheet.shared[missed])
    if not (sheet.kinds == FREE).any() and len(rim) != len(asked):
        raise _missed(sheet, sheet.shared)


def _missed(sheet: PartSheet, sides: Indices) -> InputError:
    edges = sheet.origin[sides]
    return InputError(
        "border_missed",
        f"The quads do not fit the border of the chosen faces at {len(edges)} edges, so nothing was joined. Choose other faces "
        "or another size.",
        "edge",
        edges.reshape(-1).tolist(),
    )
