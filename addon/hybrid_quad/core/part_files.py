"""Files that say which faces are remeshed, and files of meshes with faces of any size."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np

from .file_places import FilesTogether, MeshFileError, read_text, replacing
from .mesh_arrays import FloatArray, Polygons
from .mesh_formats import check_writable
from .part_sheet import Indices

_AT_ONCE = 20_000  # rows


def read_part(path: str | os.PathLike[str]) -> Indices:
    """Numbers of faces from a text file: whole numbers from 0 on, as many as one likes a line; ``#`` starts a comment.

    Raises
    ------
    MeshFileError
        If a line holds anything else; names the line.
    """
    path = Path(path)
    numbers: list[int] = []
    for number, line in enumerate(read_text(path).splitlines(), 1):
        tokens = line.partition("#")[0].split()
        if not all(token.isascii() and token.isdigit() for token in tokens):
            raise MeshFileError(f"{path}: line {number} is not of face numbers: {line.strip()!r}")
        numbers += map(int, tokens)
    return np.array([min(number, np.iinfo(np.int64).max) for number in numbers], np.int64)


def write_polygons(
    path: str | os.PathLike[str], vertices: FloatArray, polygons: Polygons, together: FilesTogether | None = None
) -> None:
    """Writes a mesh so that the file is either whole or, on failure, as it was before.

    Parameters
    ----------
    path : path
        The format follows from the name's end: .obj, .ply or .off.
    vertices : (n, 3) float64
        Written so that reading gives the same bits.
    polygons : Polygons
    together : FilesTogether, optional
        Files with which it takes its place.

    Raises
    ------
    MeshFileError
    """
    path = Path(path)
    check_writable(path)
    with together.replacing(path) if together else replacing(path) as file:
        file.writelines(line.encode() for line in _LINES[path.suffix.lower()](vertices, polygons))


def _lines_of_obj(vertices: FloatArray, polygons: Polygons) -> Iterable[str]:
    yield from (f"v {x:.17g} {y:.17g} {z:.17g}\n" for x, y, z in _points(vertices))
    yield from (f"f {' '.join(str(vertex + 1) for vertex in face)}\n" for face in _faces(polygons))


def _lines_of_off(vertices: FloatArray, polygons: Polygons) -> Iterable[str]:
    yield f"OFF\n{len(vertices)} {len(polygons.sizes)} 0\n"
    yield from _rows(vertices, polygons)


def _lines_of_ply(vertices: FloatArray, polygons: Polygons) -> Iterable[str]:
    yield (
        f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(polygons.sizes)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    yield from _rows(vertices, polygons)


def _rows(vertices: FloatArray, polygons: Polygons) -> Iterable[str]:
    yield from (f"{x:.17g} {y:.17g} {z:.17g}\n" for x, y, z in _points(vertices))
    yield from (f"{len(face)} {' '.join(map(str, face))}\n" for face in _faces(polygons))


def _points(vertices: FloatArray) -> Iterator[list[float]]:
    """As lists, some at a time: those of all would take many times the memory."""
    for begin in range(0, len(vertices), _AT_ONCE):
        yield from vertices[begin : begin + _AT_ONCE].tolist()


def _faces(polygons: Polygons) -> Iterator[list[int]]:
    """Likewise."""
    end = 0
    for begin in range(0, len(polygons.sizes), _AT_ONCE):
        sizes = polygons.sizes[begin : begin + _AT_ONCE].tolist()
        at, end = end, end + sum(sizes)
        corners = polygons.vertices[at:end].tolist()
        place = 0
        for size in sizes:
            yield corners[place : place + size]
            place += size


_LINES = {".obj": _lines_of_obj, ".off": _lines_of_off, ".ply": _lines_of_ply}
