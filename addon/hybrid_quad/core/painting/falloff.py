"""How a brush's strength falls off from its middle to its rim."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..mesh_arrays import FloatArray

# Of the distance as a part of the radius; named as Blender names them.
FALLOFFS: dict[str, Callable[[FloatArray], FloatArray]] = {
    "smooth": lambda part: 1 - part * part * (3 - 2 * part),
    "sphere": lambda part: np.sqrt(1 - part * part),
    "linear": lambda part: 1 - part,
    "sharp": lambda part: (1 - part) ** 2,
    "constant": lambda part: np.where(part < 1, 1.0, 0.0),
}


def falloff_at(distances: FloatArray, radius: float, falloff: str) -> FloatArray:
    """(k,) from 1 in the middle to 0 at the radius and beyond.

    Parameters
    ----------
    distances : (k,) float64
    falloff : str
        One of `FALLOFFS`.
    """
    return FALLOFFS[falloff](np.clip(distances / radius, 0, 1))
