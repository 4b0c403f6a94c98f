"""What is wrong with a mesh, and what remeshing would do about it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import native
from .mesh_arrays import FacesLike, IntArray, as_polygons, as_vertices


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
        Whether :func:`~hybrid_quad.remesh` repairs it on the way.
    remedy : str
        What it does, or what the user can do.
    """

    code: str
    element_kind: str
    elements: IntArray
    repairable: bool
    remedy: str

    @classmethod
    def from_native(cls, row: dict[str, Any]) -> Defect:
        elements: IntArray = np.asarray(row["elements"], np.int32)
        if row["element_kind"] == "edge":
            elements = elements.reshape(-1, 2)
        return cls(row["code"], row["element_kind"], elements, row["repairable"], row["remedy"])

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
        }


def check(vertices: npt.ArrayLike, faces: FacesLike) -> list[Defect]:
    """Finds what is wrong with a mesh, without changing anything.

    Parameters
    ----------
    vertices : (n, 3) float
        Positions.
    faces : (m, k) int, or a sequence of sequences of int
        0-based vertices of each polygon.

    Returns
    -------
    list of Defect
        One for each kind of defect; empty for a sound mesh.
    """
    polygons = as_polygons(faces)
    rows = native.load().check(as_vertices(vertices), polygons.sizes, polygons.vertices)
    return [Defect.from_native(row) for row in rows]
