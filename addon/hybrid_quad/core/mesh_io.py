"""Meshes from and to files: .obj, .ply, .stl and .off in; .obj, .ply and .off out.

Not by meshio, which takes only triangles from OFF, mistakes relative indices of OBJ and refuses files with more texture coordinates
or normals than vertices, and which Blender's Python does not have. Vertices are never merged or reordered, except those of STL, which
has none of its own. Texts of .obj files, which most meshes come in, are read by the compiled part, ten times as fast as Python can.
"""

from __future__ import annotations

import codecs
import contextlib
import itertools
import os
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np

from . import native
from .mesh_arrays import FloatArray, IntArray, Polygons, as_polygons
from .ply_file import read_ply
from .stl_file import read_stl

READABLE = (".obj", ".ply", ".stl", ".off")
WRITABLE = (".obj", ".ply", ".off")


class MeshFileError(Exception):
    """A file cannot be read or written as a mesh; the message names it and says why."""


def read_mesh(path: str | os.PathLike[str]) -> tuple[FloatArray, Polygons]:
    """Reads a polygon mesh.

    Parameters
    ----------
    path : path
        The format follows from the name's end, see `READABLE`.

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
    reader = {".obj": _read_obj, ".off": _read_off, ".ply": _read_ply, ".stl": _read_stl}.get(path.suffix.lower())
    if reader is None:
        raise MeshFileError(f"{path}: {_unknown_kind(path)}; read are {', '.join(READABLE)}")
    try:
        return reader(path)
    except OSError as error:
        raise MeshFileError(f"{path}: {error.strerror or error}") from error
    except (ValueError, IndexError, OverflowError) as error:
        raise MeshFileError(f"{path}: {error}") from error


def write_mesh(path: str | os.PathLike[str], vertices: FloatArray, quads: IntArray) -> None:
    """Writes a quad mesh so that the file is either whole or, on failure, as it was before.

    Parameters
    ----------
    path : path
        The format follows from the name's end, see `WRITABLE`.
    vertices : (n, 3) float64
        Written so that reading gives the same bits.
    quads : (m, 4) int32

    Raises
    ------
    MeshFileError
    """
    path = Path(path)
    check_writable(path)
    writer = {".obj": _write_obj, ".ply": _write_ply, ".off": _write_off}[path.suffix.lower()]
    with replacing(path) as file:
        writer(file, vertices, quads)


def check_writable(path: str | os.PathLike[str]) -> None:
    """Raises MeshFileError where `path` could never be written, so that no run is wasted on it."""
    path = Path(path)
    if path.suffix.lower() not in WRITABLE:
        raise MeshFileError(f"{path}: {_unknown_kind(path)}; written are {', '.join(WRITABLE)}")
    check_place(path)


def _unknown_kind(path: Path) -> str:
    if not path.suffix:
        return "the name has no ending, which would say of what kind the file is"
    return f"files of kind {path.suffix} are not known here"


def check_place(path: str | os.PathLike[str]) -> None:
    """Raises MeshFileError where no file could be put at `path`."""
    path = Path(path)
    if not path.parent.is_dir():
        raise MeshFileError(f"{path}: the folder {path.parent} does not exist")
    if path.is_dir():
        raise MeshFileError(f"{path}: is a folder")
    if path.exists() and not path.is_file():  # a device, say: it must not be replaced by a file
        raise MeshFileError(f"{path}: is no regular file")
    if not os.access(path.parent, os.W_OK):
        raise MeshFileError(f"{path}: the folder {path.parent} cannot be written to")


def check_apart(path: str | os.PathLike[str] | None, others: Iterable[str | os.PathLike[str] | None]) -> None:
    """Raises MeshFileError where `path`, which is to be written, is one of `others`, which are read or written by the same run."""
    if path is None:
        return
    place = os.path.normcase(os.path.realpath(path))
    if any(place == os.path.normcase(os.path.realpath(other)) for other in others if other):
        raise MeshFileError(f"{path}: is named twice, and would be written over")


@contextlib.contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[BinaryIO]:
    """A file that takes the place of `path` once everything is in it, and vanishes if anything goes wrong before."""
    path = Path(path)
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", suffix=".part", dir=path.parent)
    except OSError as error:
        raise MeshFileError(f"{path}: {error.strerror or error}") from error
    try:
        with os.fdopen(handle, "wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.chmod(name, 0o666 & ~_umask())
        os.replace(name, path)
    except BaseException as error:
        with contextlib.suppress(OSError):
            os.unlink(name)
        if isinstance(error, OSError):
            raise MeshFileError(f"{path}: {error.strerror or error}") from error
        raise


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

    Raises
    ------
    MeshFileError
    """
    path = Path(path)
    pairs: list[tuple[int, int]] = []
    latest = 0
    for line in read_text(path).splitlines() if path.suffix.lower() == ".obj" else ():
        latest += line.startswith(("v ", "v\t"))
        if line.startswith(("l ", "l\t")):
            try:
                indices = [int(token.partition("/")[0]) for token in line.split()[1:]]
            except ValueError:
                raise MeshFileError(f"{path}: {line.strip()!r} is no line of vertices") from None
            places = [index - 1 if index >= 0 else latest + index for index in indices]
            pairs += itertools.pairwise(places)
    return _as_int32([place for pair in pairs for place in pair]).reshape(-1, 2)


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
    rows = [(number, line.partition("#")[0].split()) for number, line in enumerate(text.splitlines(), 1)]
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


_Rows = list[tuple[int, list[str]]]


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


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def read_text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig", errors="replace")  # Windows' programs put a mark before the text
    except OSError as error:
        raise MeshFileError(f"{path}: {error.strerror or error}") from error


def _read_obj(path: Path) -> tuple[FloatArray, Polygons]:
    vertices, sizes, corners = native.load().parse_obj(path.read_bytes().removeprefix(codecs.BOM_UTF8))
    return vertices, Polygons(sizes, corners)


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


def _as_int32(values: list[int]) -> IntArray:
    limits = np.iinfo(np.int32)
    low, high = int(limits.min), int(limits.max)  # beyond the range of any mesh either way
    try:
        return np.clip(np.array(values, dtype=np.int64), low, high).astype(np.int32)
    except OverflowError:
        return np.array([min(max(value, low), high) for value in values], np.int32)


def _read_off(path: Path) -> tuple[FloatArray, Polygons]:
    lines = [tokens for line in read_text(path).splitlines() if (tokens := line.partition("#")[0].split())]
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
    sizes = _as_int32([int(face[0]) for face in faces])
    corners = [int(token) for face, size in zip(faces, sizes.tolist(), strict=True) for token in face[1 : 1 + size]]
    return _points_of_tokens(positions), Polygons(sizes, _as_int32(corners))


def _off_row(rows: Iterator[list[str]], width: Callable[[str], int]) -> list[str]:
    """The next row, with what follows on further lines where its own has fewer tokens than its first one calls for."""
    row: list[str] = []
    while not row or len(row) < width(row[0]):
        following = next(rows, None)
        if following is None:
            raise ValueError("ends before all of its vertices and faces")
        row = row + following if row else following
    return row


def _read_ply(path: Path) -> tuple[FloatArray, Polygons]:
    vertices, sizes, corners = read_ply(path.read_bytes())
    return vertices, Polygons(_as_int32(sizes.tolist()), _as_int32(corners.tolist()))


def _read_stl(path: Path) -> tuple[FloatArray, Polygons]:
    vertices, triangles = read_stl(path.read_bytes())
    return vertices, as_polygons(triangles)


def _write_obj(file: BinaryIO, vertices: FloatArray, quads: IntArray) -> None:
    _write_rows(file, "v %.17g %.17g %.17g\n", vertices)
    _write_rows(file, "f %d %d %d %d\n", quads + 1)


def _write_off(file: BinaryIO, vertices: FloatArray, quads: IntArray) -> None:
    file.write(f"OFF\n{len(vertices)} {len(quads)} 0\n".encode())
    _write_rows(file, "%.17g %.17g %.17g\n", vertices)
    _write_rows(file, "4 %d %d %d %d\n", quads)


def _write_rows(file: BinaryIO, row: str, values: FloatArray | IntArray) -> None:
    """One line a row, several times as fast as numpy writes text."""
    file.write((row * len(values) % tuple(values.ravel().tolist())).encode())


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
