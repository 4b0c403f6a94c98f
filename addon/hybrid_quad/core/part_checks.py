"""What a part, and the quads in its place, must not be like."""

from __future__ import annotations

import numpy as np

from .edge_borders import BoolArray, edge_keys
from .equal_points import merged_points
from .errors import InputError
from .mesh_arrays import FloatArray, Polygons
from .part_parity import EvenPart
from .part_sheet import FREE, Indices, sides_among
from .part_weld import PartResult, rim_of
from .validation import violations


def require_welded(points: FloatArray, polygons: Polygons, even: EvenPart) -> None:
    """Raises InputError ``unwelded_border`` where vertices in one place would be merged.

    At the border that joins the rest, or across a crack beside the rest.
    """
    sheet, of_rest = even.sheet, np.repeat(~even.part, polygons.sizes)
    is_used, is_of_rest = (np.zeros(len(points), np.bool_) for _ in range(2))
    is_used[polygons.vertices] = True
    is_of_rest[polygons.vertices[of_rest]] = True
    shared = np.unique(sheet.origin[sheet.shared])
    free = np.unique(sheet.origin[sheet.sides[sheet.kinds == FREE]])
    free = free[~is_of_rest[free]]
    near = _with_x_of(points, np.union1d(shared, free), is_used)
    places = np.full(len(points), -1, np.int64)
    places[near] = merged_points(points[near])[1]
    is_doubled = np.bincount(places[near], minlength=1) > 1
    at_rest = np.unique(places[near[is_of_rest[near]]])
    found = np.union1d(shared[is_doubled[places[shared]]], free[np.isin(places[free], at_rest)])
    if len(found):
        raise InputError(
            "unwelded_border",
            f"{len(found)} vertices at the border of the chosen faces lie in one place with others. Merge them first, or choose "
            "other faces.",
            "vertex",
            found.tolist(),
        )


def _with_x_of(points: FloatArray, some: Indices, is_used: BoolArray) -> Indices:
    """`some` and those of the used vertices that have a first coordinate with one of them in common."""
    values = np.unique(points[some, 0])
    at = np.minimum(np.searchsorted(values, points[:, 0]), max(len(values) - 1, 0))
    is_near = is_used & (values[at] == points[:, 0]) if len(values) else np.zeros(len(points), np.bool_)
    is_near[some] = True
    return np.flatnonzero(is_near)


def require_sound(result: PartResult, points: FloatArray, polygons: Polygons) -> None:
    """Raises InputError ``part_too_coarse`` where quads are not valid, or an edge inside them is one of the rest's already."""
    problems = violations(result.vertices, result.quads)
    if problems:
        raise InputError(
            "part_too_coarse",
            f"The chosen faces are too few for quads of this size ({'; '.join(problems)}). Ask for smaller ones.",
        )
    sides = result.whole_vertices[np.stack([result.quads, np.roll(result.quads, -1, axis=1)], axis=-1).reshape(-1, 2)]
    keys = edge_keys(sides[(sides >= 0).all(axis=1)], len(points))  # type: ignore[arg-type]
    rim = edge_keys(result.whole_vertices[rim_of(result.quads)], len(points))  # type: ignore[arg-type]
    inner = np.setdiff1d(keys, rim)
    is_end = np.zeros(len(points), np.bool_)
    is_end[np.concatenate(np.divmod(inner, len(points)))] = True
    corners, ends = sides_among(polygons, is_end)
    of_rest = np.repeat(~result.part, polygons.sizes)[corners]
    doubled = np.intersect1d(inner, edge_keys(ends[of_rest], len(points)))  # type: ignore[arg-type]
    if len(doubled):
        raise InputError(
            "part_too_coarse",
            f"{len(doubled)} edges of the quads would join vertices that an edge of the rest joins already. Ask for smaller "
            "quads, or choose more faces.",
            "edge",
            np.stack(np.divmod(doubled, len(points)), axis=1).reshape(-1).tolist(),
        )
