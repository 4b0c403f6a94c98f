"""What each stage saw, and files of it that a person can open."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .mesh_arrays import FloatArray, IntArray


@dataclass(frozen=True, eq=False, repr=False)
class Snapshot:
    """A polygon mesh with named arrays.

    Attributes
    ----------
    stage : str
        Name of the stage that made it.
    points : (n, 3) float64
        Positions.
    face_sizes, face_vertices : int32
        Corners of each face, and their vertices one face after the other.
    vertex_values, face_values : dict of (n,) and (#F,) float64
        Named values.
    face_vectors : dict of (#F, 3) float64
        Named directions.
    lines : (k, 2) int32
        Edges worth drawing, features for example.
    """

    stage: str
    points: FloatArray
    face_sizes: IntArray
    face_vertices: IntArray
    vertex_values: dict[str, FloatArray]
    face_values: dict[str, FloatArray]
    face_vectors: dict[str, FloatArray]
    lines: IntArray


class SnapshotFolder:
    """Writes snapshots as numbered VTU files.

    Parameters
    ----------
    folder : path
        Made where it does not exist.

    Raises
    ------
    ImportError
        If ``meshio`` is missing (it is not part of Blender).
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        try:
            import meshio  # noqa: F401
        except ImportError as error:
            raise ImportError("writing the stages to files needs the package 'meshio'") from error
        self._folder = Path(folder)
        self._folder.mkdir(parents=True, exist_ok=True)
        self._count = 0

    def write(self, snapshot: Snapshot) -> Path:
        """Writes one file and returns its path; OSError names it."""
        name = re.sub(r"[^A-Za-z0-9_-]+", "_", snapshot.stage) or "stage"
        path = self._folder / f"{self._count:02d}_{name}.vtu"
        try:
            _as_meshio(snapshot).write(path)
        except OSError as error:  # of a full disk the system does not say where it is
            raise OSError(error.errno, error.strerror or str(error), str(path)) from error
        self._count += 1
        return path


def _as_meshio(snapshot: Snapshot) -> Any:
    import meshio

    starts = np.cumsum(snapshot.face_sizes) - snapshot.face_sizes
    blocks: list[tuple[str, Any]] = []
    faces_of_block = []
    for size in np.unique(snapshot.face_sizes):
        faces = np.flatnonzero(snapshot.face_sizes == size)
        corners = snapshot.face_vertices[starts[faces, None] + np.arange(size)]
        blocks.append(({3: "triangle", 4: "quad"}.get(int(size), "polygon"), corners))
        faces_of_block.append(faces)
    if len(snapshot.lines):
        blocks.append(("line", snapshot.lines))
    cell_data = {
        name: _per_block(values, faces_of_block, len(snapshot.lines))
        for name, values in {**snapshot.face_values, **snapshot.face_vectors}.items()
    }
    return meshio.Mesh(snapshot.points, blocks, point_data=snapshot.vertex_values, cell_data=cell_data)


def _per_block(values: FloatArray, faces_of_block: list[Any], line_count: int) -> list[FloatArray]:
    data = [values[faces] for faces in faces_of_block]
    if line_count:
        data.append(np.zeros((line_count, *values.shape[1:])))
    return data
