"""Weights of a rig's bones on vertices."""

from __future__ import annotations

import numpy as np

from .mesh_arrays import FloatArray


def with_fewer_influences(weights: FloatArray, most: int) -> FloatArray:
    """`weights` with at most `most` above zero in each row: the largest, scaled so that the row's sum stays.

    Parameters
    ----------
    weights : (n, g) float64
        Of g groups on n vertices, none negative.
    """
    if most >= weights.shape[1]:
        return weights
    crowded = np.flatnonzero((weights > 0).sum(axis=1) > most)
    rows = weights[crowded]
    total = rows.sum(axis=1, keepdims=True)
    np.put_along_axis(rows, np.argsort(-rows, axis=1, kind="stable")[:, most:], 0.0, axis=1)
    left = rows.sum(axis=1, keepdims=True)
    result: FloatArray = weights.copy()
    result[crowded] = rows * np.divide(total, left, out=np.ones_like(total), where=left > 0)
    return result
