"""Copies of what a run reads, under plain names, with the numbers that the run sees and nothing else."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np

from ..batch_jobs.settings import Settings, files_of
from ..core.errors import InternalError
from ..core.file_places import MeshFileError, require_regular
from ..core.mesh_formats import READABLE
from ..core.mesh_io import read_mesh
from ..core.part_files import read_part, write_polygons
from ..core.strokes import kind_of_name
from ..core.wish_files import read_counts, read_edges, read_polylines, read_rows

MESH = "mesh.off"  # of the formats the one that keeps wrong indices as they are
ORIGINAL = "original"  # the mesh file as it is, with its own suffix
_FILE_NAMES = {"guides": "guides.obj"}  # of settings; others are NAME.txt


def require_files(source: Path, settings: Settings) -> None:
    """Raises MeshFileError where the mesh is of a format that is never read, or a file cannot be opened."""
    if source.suffix.lower() not in READABLE:
        raise MeshFileError(f"{source}: cannot read '{source.suffix}' files, only {', '.join(READABLE)}")
    for path in (source, *files_of(settings).values()):
        try:
            require_regular(path)
            with path.open("rb"):
                pass
        except OSError as error:
            raise MeshFileError(f"{path}: {error.strerror or error}") from error


def write_copies(source: Path, settings: Settings, folder: Path) -> Settings:
    """Writes what a run reads to a folder: the mesh as `MESH`, and each file of the settings.

    Names of objects and groups, comments, materials, texture coordinates and normals are not in the copies, as no run reads
    them. Of a guide's name only the kind is kept.

    Parameters
    ----------
    source : Path
        The mesh file.
    settings : Settings
        See :mod:`hybrid_quad.batch_jobs.settings`.
    folder : Path
        Is there, and empty.

    Returns
    -------
    Settings
        With the copies' names instead of the files' paths.

    Raises
    ------
    MeshFileError, ValueError, OverflowError
        If a file cannot be read.
    """
    vertices, polygons = read_mesh(source)
    write_polygons(folder / MESH, vertices, polygons)
    again, same = read_mesh(folder / MESH)
    if not (np.array_equal(vertices, again, equal_nan=True) and all(map(np.array_equal, polygons, same))):
        raise InternalError("the copy of the mesh is not the same mesh", "case")
    names = {}
    for setting, path in files_of(settings).items():
        names[setting] = _FILE_NAMES.get(setting, f"{setting}.txt")
        (folder / names[setting]).write_text("".join(f"{line}\n" for line in _LINES[setting](path)))
    return {**settings, **names}


def copy_original(source: Path, folder: Path) -> None:
    """The mesh file itself, as it is."""
    shutil.copyfile(source, folder / original_name(source))


def copy_originals(source: Path, settings: Settings, folder: Path) -> Settings:
    """As :func:`write_copies` with the files as they are, for those that cannot be read; their names are plain all the same."""
    copy_original(source, folder)
    names = {setting: _FILE_NAMES.get(setting, f"{setting}.txt") for setting in files_of(settings)}
    for setting, path in files_of(settings).items():
        shutil.copyfile(path, folder / names[setting])
    return {**settings, **names}


def original_name(source: Path) -> str:
    """What the mesh file itself is called."""
    return ORIGINAL + source.suffix.lower()


def _rows(rows: Iterable[Sequence[float]]) -> list[str]:
    return [" ".join(f"{value:.17g}" for value in row) for row in rows]


def _lines_of_guides(path: Path) -> list[str]:
    """An .obj file's lines; those without a kind in their name have none here either."""
    lines, count = [], 0
    for name, points in read_polylines(path):
        kind = kind_of_name(name, "")
        lines += [f"o {kind}_" if kind else "o guide", *(f"v {row}" for row in _rows(points.tolist()))]
        lines.append("l " + " ".join(str(count + place) for place in range(1, len(points) + 1)))
        count += len(points)
    return lines


_LINES: dict[str, Callable[[Path], list[str]]] = {
    "features": lambda path: [f"{a} {b}" for a, b in read_edges(path).tolist()],
    "curve_counts": lambda path: [" ".join(map(str, (n, *vertices))) for vertices, n in read_counts(path)],
    "guides": _lines_of_guides,
    "density": lambda path: _rows(read_rows(path, 1).tolist()),
    "frames": lambda path: _rows(read_rows(path, 6).tolist()),
    "part": lambda path: [str(face) for face in read_part(path).tolist()],
}
