"""The limit surface of a quad mesh and its distance to the surface it was made of, without Blender."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any, ClassVar

from ..core.mesh_arrays import FloatArray, IntArray, Polygons
from ..core.remesh import CancelCallback, ProgressCallback
from ..core.stage_cache import StageCache
from ..core.subdivision import subdivide, surface_distances
from .bundle import Arrays, save_bundle


@dataclasses.dataclass(frozen=True, eq=False)
class LimitSurface:
    """Points of a limit surface.

    Attributes
    ----------
    vertices, normals : (n, 3) float64
    quads : (m, 4) int32
    distances : (n,) float64
        How far each vertex is from the other surface; of length 0 where there is none.
    """

    vertices: FloatArray
    normals: FloatArray
    quads: IntArray
    distances: FloatArray


@dataclasses.dataclass(frozen=True, eq=False)
class LimitRequest:
    """A control mesh, and the surface that its limit is held against.

    Attributes
    ----------
    vertices : (n, 3) float64
    polygons : Polygons
    crease_edges : (k, 2) int32
    crease_sharpness : (k,) float64
    sharp_vertices : (j,) int32
    vertex_sharpness : (j,) float64
    source_vertices : (p, 3) float64
    source_polygons : Polygons
        Without polygons: no distances.
    levels : int
    """

    vertices: FloatArray
    polygons: Polygons
    crease_edges: IntArray
    crease_sharpness: FloatArray
    sharp_vertices: IntArray
    vertex_sharpness: FloatArray
    source_vertices: FloatArray
    source_polygons: Polygons
    levels: int = 2

    kind: ClassVar[str] = "limit"
    result_type: ClassVar[type[LimitSurface]] = LimitSurface
    time_limit: ClassVar[float | None] = None

    def solve(
        self,
        progress: ProgressCallback | None = None,
        cancel: CancelCallback | None = None,
        cache: StageCache | None = None,
    ) -> LimitSurface:
        """The limit surface; any thread may call this.

        Raises
        ------
        InputError, InternalError
            As :func:`hybrid_quad.subdivide` and :func:`hybrid_quad.surface_distances` do.
        """
        found = subdivide(
            self.vertices,
            self.polygons,
            levels=self.levels,
            crease_edges=self.crease_edges,
            crease_sharpness=self.crease_sharpness,
            sharp_vertices=self.sharp_vertices,
            vertex_sharpness=self.vertex_sharpness,
        )
        distances = found.vertices[:0, 0]
        if len(self.source_polygons.sizes):
            distances = surface_distances(found.vertices, self.source_vertices, self.source_polygons)
        return LimitSurface(found.vertices, found.normals, found.quads, distances)

    def save(self, path: Path) -> None:
        """Writes the request to a file for :func:`.kinds.load_request`."""
        arrays = {name: getattr(self, name) for name in _ARRAYS}
        for name, polygons in (("", self.polygons), ("source_", self.source_polygons)):
            arrays[f"{name}face_sizes"], arrays[f"{name}face_vertices"] = polygons.sizes, polygons.vertices
        save_bundle(path, arrays, {"kind": self.kind, "levels": self.levels})

    @classmethod
    def of_bundle(cls, arrays: Arrays, values: dict[str, Any]) -> LimitRequest:
        """The request that was saved."""
        return cls(
            **{name: arrays[name] for name in _ARRAYS},
            polygons=Polygons(arrays["face_sizes"], arrays["face_vertices"]),
            source_polygons=Polygons(arrays["source_face_sizes"], arrays["source_face_vertices"]),
            levels=values["levels"],
        )


_ARRAYS = ("vertices", "crease_edges", "crease_sharpness", "sharp_vertices", "vertex_sharpness", "source_vertices")
