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
        least = np.minimum(label[first], label[second])
        updated = label.copy()
        # The labels themselves are hooked on as well: the number of rounds is logarithmic.
        for nodes in (first, second, label[first], label[second]):
            np.minimum.at(updated, nodes, least)
        updated = updated[updated]
        if np.array_equal(updated, label):
            return label
        label = updated
