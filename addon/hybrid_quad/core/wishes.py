"""What a caller asks of places on the surface, as the arrays that the compiled module takes."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import InputError
from .mesh_arrays import FloatArray, Polygons, as_reals

DENSITY_BOUNDS = (0.1, 10.0)  # what lies beyond counts as these


def native_wishes(
    guides: npt.ArrayLike | None,
    density: npt.ArrayLike | None,
    frames: npt.ArrayLike | None,
    vertex_count: int,
    polygons: Polygons,
) -> dict[str, Any]:
    """Keyword arguments of the compiled module's ``remesh``; arrays without rows for what is not asked.

    Parameters
    ----------
    guides : (n, 3) or (m, 3) float, optional
    density : (n,) float, optional
    frames : (n, 2, 3) or (m, 2, 3) float, optional
        Of n vertices or m polygons; where there are as many of both, of the vertices. What vertices that no
        polygon uses have makes no difference.

    Raises
    ------
    ValueError
        If an array has another shape.
    InputError
        If a value is not finite; names the elements.
    """
    used = _used_vertices(vertex_count, polygons)
    face_count = len(polygons.sizes)
    vertex_guides, face_guides = _by_element("guides", guides, (3,), used, face_count)
    vertex_frames, face_frames = _by_element("frames", frames, (2, 3), used, face_count)
    densities, _ = _by_element("density", density, (), used, vertex_count)
    return {
        "vertex_guides": vertex_guides,
        "face_guides": face_guides,
        "density": densities,
        "vertex_frames": vertex_frames,
        "face_frames": face_frames,
    }


def _used_vertices(vertex_count: int, polygons: Polygons) -> npt.NDArray[np.bool_]:
    used = np.zeros(vertex_count, dtype=bool)
    vertices = polygons.vertices
    used[vertices[(vertices >= 0) & (vertices < vertex_count)]] = True
    return used


def _by_element(
    name: str,
    values: npt.ArrayLike | None,
    tail: tuple[int, ...],
    used: npt.NDArray[np.bool_],
    face_count: int,
) -> tuple[FloatArray, FloatArray]:
    none, vertex_count = np.zeros((0, *tail)), len(used)
    if values is None:
        return none, none
    array = as_reals(values, name)
    if array.ndim != 1 + len(tail) or array.shape[1:] != tail or len(array) not in (vertex_count, face_count):
        asked = ", ".join(str(size) for size in tail)
        counts = f"{vertex_count} vertices" + (f" or {face_count} faces" if face_count != vertex_count else "")
        raise ValueError(f"{name} must be of shape (k{', ' + asked if tail else ','}) for {counts}, not {array.shape}")
    of_vertices = len(array) == vertex_count
    finite = np.isfinite(array.reshape(len(array), -1)).all(axis=1)
    if of_vertices:
        finite |= ~used
    if not finite.all():
        bad = np.flatnonzero(~finite).tolist()
        kind = "vertex" if of_vertices else "face"
        what = "density is" if name == "density" else f"{name} are"
        raise InputError(f"non_finite_{name}", f"The {what} not finite at {kind} {bad[0]}.", kind, bad)
    if not of_vertices:
        return none, array
    neutral = 1.0 if name == "density" else 0.0
    return np.where(used.reshape(-1, *(1 for _ in tail)), array, neutral), none
