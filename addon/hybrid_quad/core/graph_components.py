"""Connected components of a graph, by numpy alone."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Indices = npt.NDArray[np.int64]


def component_labels(count: int, first: Indices, second: Indices) -> Indices:
    """The smallest member of each node's component.

    Parameters
    ----------
    count : int
        Nodes.
    first, second : (e,) int
        Nodes at the ends of each edge.

    Returns
    -------
    (count,) int64
    """
    label = np.arange(count, dtype=np.int64)
    while True:
        low, high = np.minimum(first, second).astype(np.int64), np.maximum(first, second).astype(np.int64)
        apart = low < high
        if not apart.any():
            return label
        # Every root goes to the least of those next to it that are less; sorted, that is the first of its own.
        keys = np.sort(high[apart] * count + low[apart])
        root, least = keys // count, keys % count
        is_first = np.append(True, root[1:] != root[:-1])
        label[root[is_first]] = least[is_first]
        while True:
            above = label[label]
            if np.array_equal(above, label):
                break
            label = above
        # On with the graph of the roots, which soon is small.
        first, second = label[root], label[least]
