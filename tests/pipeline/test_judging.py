"""What benchmarks ask about quads that point against a surface."""

import sys

import numpy as np
import pytest

pytest.importorskip("igl")

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
UP, DOWN = np.array([[0, 1, 2], [0, 2, 3]]), np.array([[0, 2, 1], [0, 3, 2]])


@pytest.fixture
def count_inverted(root, monkeypatch):
    monkeypatch.syspath_prepend(str(root / "benchmarks"))
    monkeypatch.delitem(sys.modules, "whole_surface", raising=False)
    import whole_surface

    return whole_surface.count_inverted


def count(count_inverted, triangles, size=0.3, height=0.0, vertices=SQUARE):
    centre, normal = np.array([[0.4, 0.3, height]]), np.array([[0.0, 0.0, 1.0]])
    return count_inverted(centre, normal, np.array([size]), vertices, triangles)


def test_a_quad_is_held_against_the_nearest_side(count_inverted):
    assert count(count_inverted, UP) == 0
    assert count(count_inverted, DOWN) == 1


def test_where_sheets_coincide_one_that_agrees_is_enough_however_small_the_quad(count_inverted):
    for size in (0.3, 1e-7):
        assert count(count_inverted, np.concatenate([DOWN, UP]), size) == 0
        assert count(count_inverted, np.concatenate([UP, DOWN]), size) == 0


def test_the_far_side_counts_within_a_third_of_an_edge(count_inverted):
    both = np.concatenate([SQUARE, SQUARE - [0, 0, 0.1]])
    sheets = np.concatenate([DOWN, UP + 4])
    assert count(count_inverted, sheets, 0.31, vertices=both) == 0
    assert count(count_inverted, sheets, 0.29, vertices=both) == 1
