"""Text files beside a mesh that say what is wished for: edges, numbers of quads along paths, rows a vertex, lines in space."""

from __future__ import annotations

import contextlib
import itertools
import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from .file_places import MeshFileError, read_text
from .mesh_arrays import FloatArray, IntArray, clipped_to_int32

_LINE_ELEMENT = re.compile(r"(?:\n|\A)\s*l[\s\\]")


def read_edges(path: str | os.PathLike[str]) -> IntArray:
    """Vertex pairs from a text file: two 0-based vertex indices a line; ``#`` starts a comment.

    Raises
    ------
    MeshFileError
        If a line holds anything else; names the line.
    """
    path = Path(path)
    pairs = []
    for number, line in enumerate(read_text(path).splitlines(), 1):
        tokens = line.partition("#")[0].split()
        if not tokens:
            continue
        try:
            first, second = (int(token) for token in tokens)
        except ValueError:
            raise MeshFileError(f"{path}: line {number} is not two vertex indices: {line.strip()!r}") from None
        pairs.append((first, second))
    return np.array(pairs, np.int64).reshape(-1, 2)  # type: ignore[return-value]


def read_counts(path: str | os.PathLike[str]) -> list[tuple[list[int], int]]:
    """Paths with a number from a text file: the number, then 0-based vertex indices, in one line; ``#`` starts a comment.

    Raises
    ------
    MeshFileError
        If a line holds anything else; names the line.
    """
    path = Path(path)
    counts = []
    for number, line in enumerate(read_text(path).splitlines(), 1):
        tokens = line.partition("#")[0].split()
        if not tokens:
            continue
        try:
            count, *vertices = (int(token) for token in tokens)
        except ValueError:
            raise MeshFileError(f"{path}: line {number} is not a number and vertex indices: {line.strip()!r}") from None
        counts.append((vertices, count))
    return counts


def read_line_elements(path: str | os.PathLike[str]) -> IntArray:
    """(k, 2) vertices of the edges that an .obj file has as lines (``l``), as its mesh counts them; others have none.

    Lines that are none of vertices are left out, as those who read the mesh leave out all lines.

    Raises
    ------
    MeshFileError
    """
    path = Path(path)
    pairs: list[tuple[int, int]] = []
    latest = 0
    text = read_text(path) if path.suffix.lower() == ".obj" else ""
    # Most files have none, and their words need not be looked at one by one.
    for _, tokens in _rows_of_obj(text) if _LINE_ELEMENT.search(text) else ():
        if tokens[:1] == ["v"]:
            latest += 1
        elif tokens[:1] == ["l"]:
            with contextlib.suppress(ValueError):
                indices = [int(token.partition("/")[0]) for token in tokens[1:]]
                pairs += itertools.pairwise(index - 1 if index >= 0 else latest + index for index in indices)
    return clipped_to_int32([place for pair in pairs for place in pair]).reshape(-1, 2)


def read_rows(path: str | os.PathLike[str], width: int) -> FloatArray:
    """(k, width) numbers from a text file, `width` a line; ``#`` starts a comment.

    Raises
    ------
    MeshFileError
        If a line holds anything else; names the line.
    """
    path = Path(path)
    rows = []
    for number, line in enumerate(read_text(path).splitlines(), 1):
        tokens = line.partition("#")[0].split()
        if not tokens:
            continue
        try:
            row = [float(token) for token in tokens]
        except ValueError:
            row = []
        if len(row) != width:
            raise MeshFileError(f"{path}: line {number} is not {width} numbers: {line.strip()!r}")
        rows.append(row)
    return np.array(rows, np.float64).reshape(-1, width)


def read_polylines(path: str | os.PathLike[str]) -> list[tuple[str, FloatArray]]:
    """Lines in space from a text file: the name of the object that each is of, and (k, 3) float64 points.

    Either the lines (``l``) of an .obj file, or three coordinates a line with an empty line between two lines in space,
    which have no names; ``#`` starts a comment.

    Raises
    ------
    MeshFileError
        If there is no line in the file, or a row of it is neither; names the row.
    """
    path = Path(path)
    text = read_text(path)
    rows = list(_rows_of_obj(text))
    read = _polylines_of_obj if any(tokens[:1] == ["l"] for _, tokens in rows) else _polylines_of_text
    try:
        lines = read(rows)
    except _BadRow as bad:
        raise MeshFileError(f"{path}: line {bad.number} {bad}") from None
    lines = [(name, line) for name, line in lines if len(line) > 1]
    if not lines:
        raise MeshFileError(f"{path}: has no line of two points or more")
    return lines


class _BadRow(Exception):
    def __init__(self, number: int, message: str) -> None:
        super().__init__(message)
        self.number = number


_Rows = Iterable[tuple[int, list[str]]]


def _rows_of_obj(text: str) -> Iterator[tuple[int, list[str]]]:
    """Number, from 1, and words of each line but its comment; a backslash at a line's end joins the next one to it."""
    number = 1
    for line in re.split(r"(?<!\\)\n", text):
        yield number, line.replace("\\\n", " ").partition("#")[0].split()
        number += 1 + line.count("\n")


def _polylines_of_obj(rows: _Rows) -> list[tuple[str, FloatArray]]:
    points: list[FloatArray] = []
    lines = []
    name = ""
    for number, tokens in rows:
        if tokens[:1] in (["o"], ["g"]):
            name = " ".join(tokens[1:])
        elif tokens[:1] == ["v"]:
            points.append(_point_of(number, tokens[1:4]))
        elif tokens[:1] == ["l"]:
            try:
                indices = [int(token.partition("/")[0]) for token in tokens[1:]]
            except ValueError:
                indices = [0]
            places = [index - 1 if index > 0 else len(points) + index for index in indices]
            if 0 in indices or not all(0 <= place < len(points) for place in places):
                raise _BadRow(number, "names a vertex that is not there")
            lines.append((name, np.array([points[place] for place in places]).reshape(-1, 3)))
    return lines


def _polylines_of_text(rows: _Rows) -> list[tuple[str, FloatArray]]:
    lines: list[list[FloatArray]] = [[]]
    for number, tokens in rows:
        if tokens:
            lines[-1].append(_point_of(number, tokens))
        elif lines[-1]:
            lines.append([])
    return [("", np.array(line).reshape(-1, 3)) for line in lines]


def _point_of(number: int, tokens: list[str]) -> FloatArray:
    try:
        point = np.array([float(token) for token in tokens])
    except ValueError:
        point = np.zeros(0)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise _BadRow(number, f"is not three coordinates: {' '.join(tokens)!r}")
    return point
