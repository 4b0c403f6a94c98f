"""Edges marked on smooth surfaces, where no angle asks for them, are chains of edges of the result."""

from collections import Counter

import numpy as np
import pytest

import hybrid_quad
from support import surfaces

AROUND, ACROSS, TUBE = 60, 30, 0.4


def _ring_of_torus(around: int) -> np.ndarray:
    """Vertices around the tube, closed."""
    first = around * ACROSS
    return np.append(np.arange(first, first + ACROSS), first)


def _line_along_torus(across: int, begin: int, end: int) -> np.ndarray:
    """Vertices along the ring, open."""
    return np.arange(begin, end + 1) * ACROSS + across


def _sections(line: np.ndarray) -> np.ndarray:
    return np.stack([line[:-1], line[1:]], axis=1)


def _distances(points: np.ndarray, begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    """From each point to the nearest of some segments."""
    along = end - begin
    share = np.einsum("pij,ij->pi", points[:, None] - begin, along) / (along**2).sum(axis=1)
    nearest = begin + np.clip(share, 0, 1)[:, :, None] * along
    return np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1)


def _middles_and_ends(points: np.ndarray, edges: np.ndarray) -> np.ndarray:
    begin, end = points[edges[:, 0]], points[edges[:, 1]]
    return np.concatenate([begin, 0.5 * (begin + end), end])


LINES = {
    "closed": (_ring_of_torus(7),),
    "open": (_line_along_torus(4, 10, 30),),
    "crossing": (_ring_of_torus(20), _line_along_torus(0, 10, 30)),
}


@pytest.mark.parametrize("name", sorted(LINES))
@pytest.mark.parametrize("quads", [500, 2000])
def test_a_line_on_a_smooth_surface_becomes_a_chain(name, quads):
    vertices, faces = surfaces.torus(AROUND, ACROSS, TUBE)
    marked = np.concatenate([_sections(line) for line in LINES[name]])
    result = hybrid_quad.remesh(vertices, faces, quads=quads, sharp_angle=40.0, sharp_edges=marked)
    chain, points = result.feature_edges, result.vertices
    sides = np.sort(np.concatenate([result.quads[:, [i, (i + 1) % 4]] for i in range(4)]), axis=1)
    assert set(map(tuple, np.sort(chain, axis=1).tolist())) <= set(map(tuple, sides.tolist()))
    degrees = Counter(Counter(chain.ravel().tolist()).values())
    expected = {"closed": {}, "open": {1: 2}, "crossing": {1: 2, 4: 1}}[name]
    assert {degree: count for degree, count in degrees.items() if degree != 2} == expected
    begin, end = vertices[marked[:, 0]], vertices[marked[:, 1]]
    assert _distances(points[np.unique(chain)], begin, end).max() < 1e-9
    # Between its vertices a straight edge leaves a circle as large as the tube by a known height; both have edges.
    given = np.linalg.norm(begin - end, axis=1).max()
    longest = np.linalg.norm(points[chain[:, 0]] - points[chain[:, 1]], axis=1).max()
    back = _distances(_middles_and_ends(vertices, marked), points[chain[:, 0]], points[chain[:, 1]])
    assert back.max() < 1.1 * (longest**2 + given**2) / (8 * TUBE)
    assert longest < 2.5 * np.linalg.norm(points[sides[:, 0]] - points[sides[:, 1]], axis=1).mean()
