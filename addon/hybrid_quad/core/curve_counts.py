"""Chains of edges that are to get a certain number of quads."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import numpy.typing as npt

from .mesh_arrays import IntArray

CurveCount = tuple[Sequence[int], int]
"""A path of vertices, each joined to the next by an edge, and the number of quads along. A loop repeats its first."""


def as_curve_counts(curve_counts: Iterable[CurveCount] | None) -> list[tuple[list[int], int]]:
    """Plain lists for the compiled module, which checks the rest.

    Raises
    ------
    TypeError
        If a path or a number is not of integers.
    """
    counts = []
    for each in () if curve_counts is None else curve_counts:
        if not hasattr(each, "__len__") or len(each) != 2:
            raise TypeError(f"curve_counts must be pairs of a path and a number, not {each!r}")
        path, count = each
        vertices = np.asarray(path)
        if vertices.ndim != 1 or (vertices.size and vertices.dtype.kind not in "iu"):
            raise TypeError(f"a path of curve_counts must be vertex indices, not {path!r}")
        if not hasattr(count, "__index__") or isinstance(count, bool):
            raise TypeError(f"a number of curve_counts must be whole, not {count!r}")
        low, high = np.iinfo(np.int32).min, np.iinfo(np.int32).max
        counts.append(([min(max(v, -1), high) for v in vertices.tolist()], min(max(int(count), low), high)))
    return counts


def chains_of_edges(edges: IntArray, numbers: npt.ArrayLike) -> list[tuple[list[int], int]]:
    """Paths through the edges that ask for the same number, each as long as it can be.

    Parameters
    ----------
    edges : (k, 2) int
        Vertex pairs.
    numbers : (k,) int
        What each edge asks for the chain it is part of; 0 and less: nothing.

    Returns
    -------
    list of (path, number)
        A path ends where none, or more than one, other edge of its number goes on. A loop repeats its first vertex.
    """
    wanted = np.asarray(numbers)
    found: list[tuple[list[int], int]] = []
    for number in np.unique(wanted[wanted > 0]).tolist():
        found += [(path, number) for path in _paths(edges[wanted == number].tolist())]
    return found


def _paths(edges: list[list[int]]) -> list[list[int]]:
    at: dict[int, list[int]] = {}
    for index, (a, b) in enumerate(edges):
        at.setdefault(a, []).append(index)
        at.setdefault(b, []).append(index)
    used = [False] * len(edges)

    def follow(start: int, index: int) -> list[int]:
        path = [start]
        while not used[index]:
            used[index] = True
            a, b = edges[index]
            path.append(b if path[-1] == a else a)
            around = at[path[-1]]
            if len(around) != 2 or path[-1] == start:
                break
            index = around[0] if around[1] == index else around[1]
        return path

    paths = []
    for vertex in sorted(at):
        if len(at[vertex]) != 2:
            paths += [follow(vertex, index) for index in at[vertex] if not used[index]]
    for index, edge in enumerate(edges):  # what is left are loops
        if not used[index]:
            paths.append(follow(edge[0], index))
    return paths
