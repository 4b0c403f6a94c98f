"""Text of .off files, with or without colours, normals and texture coordinates, rows over one line or several."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from .mesh_arrays import FloatArray, Polygons, clipped_to_int32


def read_off(text: str) -> tuple[FloatArray, Polygons]:
    """Vertices (n, 3) and polygons of an OFF file's whole text.

    Raises
    ------
    ValueError
        If it is no OFF file of points in space, ends before all that its header announces, or has a face
        with a negative number of corners.
    """
    lines = [tokens for line in text.splitlines() if (tokens := line.partition("#")[0].split())]
    if not lines or not lines[0][0].upper().endswith("OFF"):
        raise ValueError("no OFF header")
    if lines[0][0].upper() not in ("OFF", "COFF", "NOFF", "CNOFF", "STOFF"):
        raise ValueError(f"files of kind {lines[0][0]} hold no points in space")
    lines[0] = lines[0][1:]
    if not lines[0]:
        del lines[0]
    vertex_count, face_count = int(lines[0][0]), int(lines[0][1])
    rows = iter(lines[1:])
    positions = [token for _ in range(vertex_count) for token in _off_row(rows, lambda _: 3)[:3]]
    faces = [_off_row(rows, lambda size: 1 + int(size)) for _ in range(face_count)]
    sizes = clipped_to_int32([int(face[0]) for face in faces])
    if (negative := np.flatnonzero(sizes < 0)).size:
        raise ValueError(f"face {negative[0]}, counted from 0, has {sizes[negative[0]]} corners")
    corners = [int(token) for face, size in zip(faces, sizes.tolist(), strict=True) for token in face[1 : 1 + size]]
    return _points_of_tokens(positions), Polygons(sizes, clipped_to_int32(corners))


def _off_row(rows: Iterator[list[str]], width: Callable[[str], int]) -> list[str]:
    """The next row, with what follows on further lines where its own has fewer tokens than its first one calls for."""
    row: list[str] = []
    while not row or len(row) < width(row[0]):
        following = next(rows, None)
        if following is None:
            raise ValueError("ends before all of its vertices and faces")
        row = row + following if row else following
    return row


def _points_of_tokens(tokens: list[str]) -> FloatArray:
    try:
        return np.array(tokens, dtype=object).astype(np.float64).reshape(-1, 3)
    except ValueError:
        for place, token in enumerate(tokens):
            try:
                float(token)
            except ValueError:
                raise ValueError(
                    f"vertex {place // 3}, counted from 0, has a coordinate that is no number: {token!r}"
                ) from None
        raise
