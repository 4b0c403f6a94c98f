"""What is wrong with a mesh, and what remeshing would do about it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import native
from .mesh_arrays import FacesLike, IntArray, as_edges, as_polygons, as_vertices, edges_without_face
from .mesh_objects import MeshLike, vertices_and_faces


@dataclass(frozen=True, eq=False)
class Defect:
    """One kind of defect and where it is.

    Attributes
    ----------
    code : str
        Stable and machine-readable, for example ``"non_manifold_edge"``.
    element_kind : {"vertex", "edge", "face", ""}
        What `elements` are.
    elements : (k,) or, for edges, (k, 2) int32
        0-based vertices, vertex pairs or faces of the input.
    repairable : bool
        Whether :func:`~hybrid_quad.remesh` takes the mesh all the same: it repairs this on the way, or leaves it.
    remedy : str
        What it does, or what the user can do.
    kept : bool
        Whether it leaves it as it is: nobody but the mesh's owner knows whether it is meant.
    """

    code: str
    element_kind: str
    elements: IntArray
    repairable: bool
    remedy: str
    kept: bool = False

    @classmethod
    def from_native(cls, row: dict[str, Any]) -> Defect:
        elements: IntArray = np.asarray(row["elements"], np.int32)
        if row["element_kind"] == "edge":
            elements = elements.reshape(-1, 2)
        return cls(row["code"], row["element_kind"], elements, row["repairable"], row["remedy"], row["kept"])

    def __len__(self) -> int:
        return len(self.elements)

    def as_json(self) -> dict[str, Any]:
        """The same as plain lists and strings."""
        return {
            "code": self.code,
            "element_kind": self.element_kind,
            "elements": self.elements.tolist(),
            "repairable": self.repairable,
            "remedy": self.remedy,
            "kept": self.kept,
        }


def check(
    vertices: npt.ArrayLike | MeshLike,
    faces: FacesLike | None = None,
    *,
    edges: npt.ArrayLike | Iterable[Sequence[int]] | None = None,
) -> list[Defect]:
    """Finds what is wrong with a mesh, without changing anything.

    Parameters
    ----------
    vertices : (n, 3) float, or a mesh
        Positions; without `faces`, a mesh of trimesh, meshio or alike, see :func:`mesh_arrays`.
    faces : (m, k) int, or a sequence of sequences of int
        0-based vertices of each polygon.
    edges : (k, 2) int, optional
        Edges of the mesh, where it has some besides those of its faces.

    Returns
    -------
    list of Defect
        One for each kind of defect; empty for a sound mesh.
    """
    positions, corners = vertices_and_faces(vertices, faces)
    points, polygons = as_vertices(positions), as_polygons(corners)
    rows = native.load().check(points, polygons.sizes, polygons.vertices)
    defects = [Defect.from_native(row) for row in rows]
    loose = edges_without_face(as_edges(edges), polygons, len(points))
    if len(loose):
        defects.append(Defect("loose_edge", "edge", loose, True, "left out"))
    return defects
