"""Files that say which faces are remeshed, and files of meshes with faces of any size."""

from __future__ import annotations

import os
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from .file_places import FilesTogether, MeshFileError, read_text, replacing
from .mesh_arrays import FloatArray, Polygons
from .mesh_formats import check_writable
from .part_sheet import Indices


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
    ends = np.cumsum(polygons.sizes)
    faces = [
        polygons.vertices[end - size : end].tolist() for size, end in zip(polygons.sizes.tolist(), ends, strict=True)
    ]
    with together.replacing(path) if together else replacing(path) as file:
        file.writelines(line.encode() for line in _LINES[path.suffix.lower()](vertices, faces))


def _lines_of_obj(vertices: FloatArray, faces: list[list[int]]) -> Iterable[str]:
    yield from (f"v {x:.17g} {y:.17g} {z:.17g}\n" for x, y, z in vertices.tolist())
    yield from (f"f {' '.join(str(vertex + 1) for vertex in face)}\n" for face in faces)


def _lines_of_off(vertices: FloatArray, faces: list[list[int]]) -> Iterable[str]:
    yield f"OFF\n{len(vertices)} {len(faces)} 0\n"
    yield from _rows(vertices, faces)


def _lines_of_ply(vertices: FloatArray, faces: list[list[int]]) -> Iterable[str]:
    yield (
        f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    yield from _rows(vertices, faces)


def _rows(vertices: FloatArray, faces: list[list[int]]) -> Iterable[str]:
    yield from (f"{x:.17g} {y:.17g} {z:.17g}\n" for x, y, z in vertices.tolist())
    yield from (f"{len(face)} {' '.join(map(str, face))}\n" for face in faces)


_LINES = {".obj": _lines_of_obj, ".off": _lines_of_off, ".ply": _lines_of_ply}
