"""Components are named by their least member, whatever the order of edges."""

from __future__ import annotations

import numpy as np
import pytest

from hybrid_quad.core.graph_components import component_labels


def labels_by_walking(count: int, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """From each node, least first, to all that can be reached from it."""
    neighbors: list[set[int]] = [set() for _ in range(count)]
    for one, other in zip(first.tolist(), second.tolist(), strict=True):
        neighbors[one].add(other)
        neighbors[other].add(one)
    label = np.full(count, -1)
    for start in range(count):
        todo = [start] if label[start] < 0 else []
        while todo:
            node = todo.pop()
            if label[node] < 0:
                label[node] = start
                todo += neighbors[node]
    return label


@pytest.mark.parametrize("share", [0.0, 0.3, 0.9, 3.0])
def test_random_graphs(share):
    rng = np.random.default_rng(7)
    for count in (1, 2, 50, 400):
        first, second = rng.integers(0, count, (2, int(share * count)))
        assert np.array_equal(component_labels(count, first, second), labels_by_walking(count, first, second))


def test_paths_and_stars_with_their_nodes_in_any_order():
    rng = np.random.default_rng(7)
    for order in (np.arange(300), np.arange(300)[::-1], rng.permutation(300)):
        assert not component_labels(300, order[:-1], order[1:]).any()
        assert not component_labels(300, np.full(299, order[0]), order[1:]).any()


def test_thirty_two_bit_nodes_of_large_graphs():
    first = np.arange(99_999, dtype=np.int32)
    assert not component_labels(100_000, first, first + 1).any()


def test_without_nodes_or_edges():
    none = np.zeros(0, np.int64)
    assert component_labels(0, none, none).tolist() == []
    assert component_labels(3, none, none).tolist() == [0, 1, 2]
