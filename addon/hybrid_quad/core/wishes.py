"""What a caller asks of places on the surface, as the arrays that the compiled module takes."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from .errors import InputError
from .mesh_arrays import FloatArray, as_reals

DENSITY_BOUNDS = (0.1, 10.0)  # what lies beyond counts as these


def native_wishes(
    guides: npt.ArrayLike | None,
    density: npt.ArrayLike | None,
    frames: npt.ArrayLike | None,
    vertex_count: int,
    face_count: int,
) -> dict[str, Any]:
    """Keyword arguments of the compiled module's ``remesh``; arrays without rows for what is not asked.

    Parameters
    ----------
    guides : (n, 3) or (m, 3) float, optional
    density : (n,) float, optional
    frames : (n, 2, 3) or (m, 2, 3) float, optional
        Of n vertices or m polygons; where there are as many of both, of the vertices.

    Raises
    ------
    ValueError
        If an array has another shape.
    InputError
        If a value is not finite; names the elements.
    """
    vertex_guides, face_guides = _by_element("guides", guides, (3,), vertex_count, face_count)
    vertex_frames, face_frames = _by_element("frames", frames, (2, 3), vertex_count, face_count)
    densities, _ = _by_element("density", density, (), vertex_count, vertex_count)
    return {
        "vertex_guides": vertex_guides,
        "face_guides": face_guides,
        "density": densities,
        "vertex_frames": vertex_frames,
        "face_frames": face_frames,
    }


def _by_element(
    name: str, values: npt.ArrayLike | None, tail: tuple[int, ...], vertex_count: int, face_count: int
) -> tuple[FloatArray, FloatArray]:
    none = np.zeros((0, *tail))
    if values is None:
        return none, none
    array = as_reals(values, name)
    if array.ndim != 1 + len(tail) or array.shape[1:] != tail or len(array) not in (vertex_count, face_count):
        asked = ", ".join(str(size) for size in tail)
        counts = f"{vertex_count} vertices" + (f" or {face_count} faces" if face_count != vertex_count else "")
        raise ValueError(f"{name} must be of shape (k{', ' + asked if tail else ','}) for {counts}, not {array.shape}")
    of_vertices = len(array) == vertex_count
    finite = np.isfinite(array.reshape(len(array), -1)).all(axis=1)
    if not finite.all():
        bad = np.flatnonzero(~finite).tolist()
        kind = "vertex" if of_vertices else "face"
        raise InputError(f"non_finite_{name}", f"The {name} must be finite, and are not at {kind} {bad[0]}.", kind, bad)
    return (array, none) if of_vertices else (none, array)
