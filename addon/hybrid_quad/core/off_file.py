"""Text of .off files, with or without colours, normals and texture coordinates, rows over one line or several."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from .mesh_arrays import FloatArray, Polygons, clipped_to_int32
from .number_words import coordinates, whole_number


def read_off(text: str) -> tuple[FloatArray, Polygons]:
    """Vertices (n, 3) and polygons of an OFF file's whole text.

    Raises
    ------
    ValueError
        If it is no OFF file of points in space, ends before all that its header announces, has a face
        with a negative number of corners, or a word that is no number where one belongs.
    """
    lines = [tokens for line in text.splitlines() if (tokens := line.partition("#")[0].split())]
    if not lines or not lines[0][0].upper().endswith("OFF"):
        raise ValueError("no OFF header")
    if lines[0][0].upper() not in ("OFF", "COFF", "NOFF", "CNOFF", "STOFF"):
        raise ValueError(f"files of kind {lines[0][0]} hold no points in space")
    lines[0] = lines[0][1:]
    if not lines[0]:
        del lines[0]
    vertex_count, face_count = _counts(lines[0] if lines else [])
    rows = iter(lines[1:])
    positions = [token for _ in range(vertex_count) for token in _off_row(rows, lambda _: 3)[:3]]
    faces: list[list[str]] = []
    for _ in range(face_count):
        faces.append(_off_row(rows, lambda size: 1 + whole_number(size, _SIZE, len(faces))))
    sizes = clipped_to_int32([int(face[0]) for face in faces])
    if (negative := np.flatnonzero(sizes < 0)).size:
        raise ValueError(f"face {negative[0]}, counted from 0, has {sizes[negative[0]]} corners")
    corners = [
        whole_number(token, _CORNER, number)
        for number, (face, size) in enumerate(zip(faces, sizes.tolist(), strict=True))
        for token in face[1 : 1 + size]
    ]
    return coordinates(positions, 3).reshape(-1, 3), Polygons(sizes, clipped_to_int32(corners))


_SIZE = "the number of corners of face {}, counted from 0,"
_CORNER = "a corner of face {}, counted from 0,"


def _counts(row: list[str]) -> tuple[int, int]:
    """Numbers of vertices and faces in the row behind the header's first word."""
    if [token.upper() for token in row[:1]] == ["BINARY"]:
        raise ValueError("binary OFF files are not read")
    if len(row) < 2:
        raise ValueError("the OFF header does not say how many vertices and faces there are")
    vertices, faces = (
        whole_number(token, "the number of {}", kind) for token, kind in zip(row, ("vertices", "faces"), strict=False)
    )
    if vertices < 0 or faces < 0:
        raise ValueError(f"the OFF header announces {vertices} vertices and {faces} faces")
    return vertices, faces


def _off_row(rows: Iterator[list[str]], width: Callable[[str], int]) -> list[str]:
    """The next row, with what follows on further lines where its own has fewer tokens than its first one calls for."""
    row: list[str] = []
    while not row or len(row) < width(row[0]):
        following = next(rows, None)
        if following is None:
            raise ValueError("ends before all of its vertices and faces")
        if row:
            row += following  # in place: a row may go on in very many lines
        else:
            row = following
    return row
