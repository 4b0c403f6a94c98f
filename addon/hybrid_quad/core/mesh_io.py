"""Meshes from and to files: .obj, .ply, .stl and .off in; .obj, .ply and .off out.

Not by meshio, which takes only triangles from OFF, mistakes relative indices of OBJ and refuses files with more texture coordinates
or normals than vertices, and which Blender's Python does not have. Vertices are never merged or reordered, except those of STL, which
has none of its own.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import BinaryIO

import numpy as np

from . import native
from .file_places import FilesTogether, read_text, reading, replacing
from .mesh_arrays import FloatArray, IntArray, Polygons, as_polygons, clipped_to_int32
from .mesh_formats import check_readable, check_writable
from .obj_file import read_obj
from .off_file import read_off
from .ply_file import read_ply
from .stl_file import read_stl

_ROWS_AT_ONCE = 50_000


def read_mesh(path: str | os.PathLike[str]) -> tuple[FloatArray, Polygons]:
    """Reads a polygon mesh.

    Parameters
    ----------
    path : path
        The format follows from the name's end, see `mesh_formats.READABLE`.

    Returns
    -------
    vertices : (n, 3) float64
    polygons : Polygons
        Indices as the file has them, 0-based; they may be out of range where the file is wrong.

    Raises
    ------
    MeshFileError
    """
    path = Path(path)
    check_readable(path)
    reader = {".obj": _read_obj, ".off": _read_off, ".ply": _read_ply, ".stl": _read_stl}[path.suffix.lower()]
    with reading(path):
        return reader(path)


def write_mesh(
    path: str | os.PathLike[str], vertices: FloatArray, quads: IntArray, together: FilesTogether | None = None
) -> None:
    """Writes a quad mesh so that the file is either whole or, on failure, as it was before.

    Parameters
    ----------
    path : path
        The format follows from the name's end, see `mesh_formats.WRITABLE`.
    vertices : (n, 3) float64
        Written so that reading gives the same bits.
    quads : (m, 4) int32
    together : FilesTogether, optional
        Files with which it takes its place.

    Raises
    ------
    MeshFileError
    """
    path = Path(path)
    check_writable(path)
    writer = {".obj": _write_obj, ".ply": _write_ply, ".off": _write_off}[path.suffix.lower()]
    with together.replacing(path) if together else replacing(path) as file:
        writer(file, vertices, quads)


def _read_obj(path: Path) -> tuple[FloatArray, Polygons]:
    mesh = read_obj(path)
    return mesh.vertices, Polygons(mesh.face_sizes, mesh.face_vertices)


def _read_off(path: Path) -> tuple[FloatArray, Polygons]:
    return read_off(read_text(path))


def _read_ply(path: Path) -> tuple[FloatArray, Polygons]:
    vertices, sizes, corners = read_ply(path.read_bytes())
    return vertices, Polygons(clipped_to_int32(sizes.tolist()), clipped_to_int32(corners.tolist()))


def _read_stl(path: Path) -> tuple[FloatArray, Polygons]:
    vertices, triangles = read_stl(path.read_bytes())
    return vertices, as_polygons(triangles)


def _write_obj(file: BinaryIO, vertices: FloatArray, quads: IntArray) -> None:
    file.write(native.load().obj_text(vertices, quads))


def _write_off(file: BinaryIO, vertices: FloatArray, quads: IntArray) -> None:
    file.write(f"OFF\n{len(vertices)} {len(quads)} 0\n".encode())
    _write_rows(file, "%.17g %.17g %.17g\n", vertices)
    _write_rows(file, "4 %d %d %d %d\n", quads)


def _write_rows(file: BinaryIO, row: str, values: FloatArray | IntArray) -> None:
    """One line a row, several times as fast as numpy writes text; some at a time, between which a signal can act."""
    for begin in range(0, len(values), _ROWS_AT_ONCE):
        some = values[begin : begin + _ROWS_AT_ONCE]
        file.write((row * len(some) % tuple(some.ravel().tolist())).encode())


def _write_ply(file: BinaryIO, vertices: FloatArray, quads: IntArray) -> None:
    # Not by meshio: it writes the time into the file, and the same mesh must give the same bytes.
    header = (
        f"ply\nformat binary_{sys.byteorder}_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty double x\nproperty double y\nproperty double z\n"
        f"element face {len(quads)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    faces = np.empty(len(quads), dtype=[("size", "u1"), ("vertices", "=i4", (4,))])
    faces["size"] = 4
    faces["vertices"] = quads
    file.write(header.encode())
    file.write(np.ascontiguousarray(vertices, "=f8").tobytes())
    file.write(faces.tobytes())
