"""Chains of edges with a number: how they are read, checked, and found in an attribute of edges."""

import itertools

import numpy as np
import pytest

from hybrid_quad.core.curve_counts import as_curve_counts, chains_of_edges
from hybrid_quad.core.file_places import MeshFileError
from hybrid_quad.core.wish_files import read_counts


def _edges_of(path):
    return {frozenset(pair) for pair in itertools.pairwise(path)}


def test_edges_of_one_number_are_one_chain_whatever_their_order():
    edges = np.array([(3, 2), (0, 1), (5, 6), (2, 1), (6, 7), (7, 5), (8, 9)])
    chains = chains_of_edges(edges, [4, 4, 6, 4, 6, 6, 0])
    assert sorted(number for _, number in chains) == [4, 6]
    by_number = {number: path for path, number in chains}
    assert by_number[4] in ([0, 1, 2, 3], [3, 2, 1, 0])
    assert by_number[6][0] == by_number[6][-1]
    assert _edges_of(by_number[6]) == {frozenset((5, 6)), frozenset((6, 7)), frozenset((7, 5))}


def test_chains_end_where_they_fork():
    edges = np.array([(0, 1), (1, 2), (2, 3), (2, 4), (4, 5)])
    chains = chains_of_edges(edges, np.full(5, 3))
    assert len(chains) == 3
    assert set().union(*(_edges_of(path) for path, _ in chains)) == {frozenset(edge) for edge in edges.tolist()}
    assert all(2 in (path[0], path[-1]) for path, _ in chains)


def test_touching_chains_of_different_numbers_stay_apart():
    chains = chains_of_edges(np.array([(0, 1), (1, 2), (2, 3)]), [5, 5, 7])
    assert sorted((len(path), number) for path, number in chains) == [(2, 7), (3, 5)]


@pytest.mark.parametrize("wrong", [[([0.5, 1], 3)], [([0, 1], 2.5)], [([0, 1], True)], [("ab", 3)]])
def test_what_is_no_whole_number_is_refused(wrong):
    with pytest.raises(TypeError):
        as_curve_counts(wrong)


def test_a_file_holds_a_curve_a_line(tmp_path):
    file = tmp_path / "counts.txt"
    file.write_text("# two of them\n6 0 1 2\n\n12 5 6 7 5  # a loop\n")
    assert read_counts(file) == [([0, 1, 2], 6), ([5, 6, 7, 5], 12)]
    file.write_text("6 0 1\nsix 0 1\n")
    with pytest.raises(MeshFileError, match="line 2"):
        read_counts(file)
