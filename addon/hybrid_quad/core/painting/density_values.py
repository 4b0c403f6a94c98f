"""Densities as brushes change them, and densities from what layers of a mesh hold."""

from __future__ import annotations

import math

import numpy as np

from ..guide_values import sound_density
from ..mesh_arrays import FloatArray, IntArray
from ..wishes import DENSITY_BOUNDS

# Densities are factors: twice and half as dense are as far from neutral, which is zero here.
LOG_BOUNDS = (math.log(DENSITY_BOUNDS[0]), math.log(DENSITY_BOUNDS[1]))
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # of linear red, green and blue: Rec. 709


def log_density(values: FloatArray) -> FloatArray:
    """(n,) logarithms of densities as attributes hold them, within `LOG_BOUNDS`."""
    return np.log(np.clip(sound_density(values), *DENSITY_BOUNDS))


def density_between(low: float, high: float, shares: FloatArray) -> FloatArray:
    """(n,) densities from `low` where the share is 0 to `high` where it is 1, in equal factors for equal steps."""
    densities: FloatArray = low * (high / low) ** np.clip(shares, 0, 1)
    return densities


def brightness(colors: FloatArray) -> FloatArray:
    """(k,) how bright linear colors (k, 3) look, 0 to 1: black to white in steps that look alike (sRGB)."""
    linear = np.clip(colors @ _LUMINANCE, 0, 1)
    seen: FloatArray = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return seen


def means_of_vertices(values: FloatArray, vertices: IntArray, vertex_count: int) -> FloatArray:
    """(n,) for every vertex the mean of the values of its corners, `vertices` (C,) being theirs; 0 where there is none."""
    sums = np.bincount(vertices, values, vertex_count)
    means: FloatArray = sums / np.maximum(np.bincount(vertices, minlength=vertex_count), 1)
    return means
