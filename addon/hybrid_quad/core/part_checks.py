"""What a part, and the quads in its place, must not be like."""

from __future__ import annotations

import numpy as np

from .edge_borders import edge_keys
from .errors import InputError
from .mesh_arrays import FloatArray, Polygons
from .part_parity import EvenPart
from .part_sheet import FREE, sides_of
from .part_weld import PartResult, rim_of
from .validation import violations


def require_welded(points: FloatArray, polygons: Polygons, even: EvenPart) -> None:
    """Raises InputError ``unwelded_border`` where vertices in one place would be merged.

    At the border that joins the rest, or across a crack beside the rest.
    """
    sheet, of_rest = even.sheet, np.repeat(~even.part, polygons.sizes)
    used = np.unique(polygons.vertices)
    places = np.full(len(points), -1, np.int64)
    places[used] = np.unique(points[used], axis=0, return_inverse=True)[1].reshape(-1)
    is_doubled = (np.bincount(places[used]) > 1)[places] & (places >= 0)
    rest = np.unique(polygons.vertices[of_rest])
    shared = np.unique(sheet.origin[sheet.shared])
    free = np.setdiff1d(sheet.origin[sheet.sides[sheet.kinds == FREE]], rest)
    found = np.union1d(shared[is_doubled[shared]], free[np.isin(places[free], places[rest])])
    if len(found):
        raise InputError(
            "unwelded_border",
            f"{len(found)} vertices at the border of the chosen faces lie in one place with others. Merge them first, or choose "
            "other faces.",
            "vertex",
            found.tolist(),
        )


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
