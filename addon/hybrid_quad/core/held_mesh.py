"""Runs from file to file of meshes that stay in the compiled part: without NumPy, whose import takes a fifth of a short run."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import native, report
from .file_places import FilesTogether, reading, replacing
from .mesh_formats import check_writable
from .obj_file import read_obj
from .options import RemeshOptions

if TYPE_CHECKING:
    from .mesh_arrays import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class HeldQuads:
    """What a run gave: as :class:`hybrid_quad.RemeshResult`, but for arrays, which are made where they are asked for.

    Attributes
    ----------
    mesh : the compiled part's ``QuadMesh``
    report : dict
        See :mod:`hybrid_quad.core.report`.
    """

    mesh: Any
    report: dict[str, Any]

    @property
    def vertices(self) -> FloatArray:
        """(n, 3) positions."""
        vertices: FloatArray = self.mesh.vertices
        return vertices

    @property
    def quads(self) -> IntArray:
        """(m, 4) vertices, 0-based."""
        quads: IntArray = self.mesh.quads
        return quads


def can_hold(path: str | os.PathLike[str], options: RemeshOptions) -> bool:
    """Whether a file and what is asked of a run need no arrays."""
    needs_area = options.edge_length is not None and options.chord_error is None
    moves = bool(options.symmetry) and options.symmetry_center != "origin"
    return Path(path).suffix.lower() == ".obj" and not needs_area and not moves


def read_held(path: str | os.PathLike[str]) -> Any:
    """A mesh file of a kind that :func:`can_hold` takes.

    Raises
    ------
    MeshFileError
    """
    with reading(path):
        return read_obj(Path(path))


def remesh_held(
    mesh: Any, options: RemeshOptions, progress: Callable[[str, float], object], *, measure_distances: bool = True
) -> HeldQuads:
    """:func:`hybrid_quad.core.remesh.remesh_with_options` without wishes; the result is the same, bit for bit.

    Parameters
    ----------
    measure_distances : bool
        Whether the report is to say how far the quads are from the surface, which takes a tenth of a run.
    """
    from .. import __version__

    asked = options.for_native()
    found = native.load().remesh(mesh, **asked, measure_distances=measure_distances, progress=progress)
    return HeldQuads(found, report.finished(found.report, options, __version__))


def write_held(path: str | os.PathLike[str], result: HeldQuads, together: FilesTogether | None = None) -> None:
    """:func:`hybrid_quad.core.mesh_io.write_mesh`.

    Raises
    ------
    MeshFileError
    """
    if Path(path).suffix.lower() != ".obj":
        from .mesh_io import write_mesh

        write_mesh(path, result.vertices, result.quads, together)
        return
    check_writable(path)
    with together.replacing(path) if together else replacing(path) as file:
        file.write(result.mesh.obj_text())
