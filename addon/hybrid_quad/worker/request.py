"""All that one run is given, without Blender: it is solved here, or saved and solved in another process."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any, ClassVar

from ..core.curve_counts import CurveCount
from ..core.errors import InternalError
from ..core.guide_values import guides_of_vertices
from ..core.mesh_arrays import FloatArray, IntArray, Polygons
from ..core.options import RemeshOptions
from ..core.part_weld import PartResult
from ..core.remesh import CancelCallback, ProgressCallback, RemeshResult, remesh_with_options, usual_length
from ..core.remesh_part import PartChoice, remesh_part_with_options
from ..core.stage_cache import StageCache
from ..core.strokes import Stroke, guides_from_strokes, stronger_of
from ..core.validation import violations
from .bundle import Arrays, save_bundle


@dataclasses.dataclass(frozen=True, eq=False)
class RemeshRequest:
    """A surface and what is asked of it.

    Attributes
    ----------
    vertices : (n, 3) float64
    polygons : Polygons
    options : RemeshOptions
    sharp_edges : (k, 2) int32
        Vertex pairs of edges that are features whatever their angle.
    curve_counts : sequence of (path, count)
        Chains of edges that are to get a certain number of quads.
    guides : (n, 3) or (#F, 3) float64, or None
        Directions of vertices or polygons, as long as they are strong.
    guides_of_faces : bool
        Whether `guides` has one for each polygon.
    strokes : sequence of Stroke
        Lines that quads follow or cross.
    stroke_radius : float
        How far strokes of kind ``"direction"`` act, in edge lengths of the quads.
    density : (n,) float64 or None
        2 for edges half as long.
    part : PartChoice or None
        The faces to remesh, where that is not all.
    """

    vertices: FloatArray
    polygons: Polygons
    options: RemeshOptions
    sharp_edges: IntArray
    curve_counts: list[CurveCount] = dataclasses.field(default_factory=list)
    guides: FloatArray | None = None
    guides_of_faces: bool = False
    strokes: tuple[Stroke, ...] = ()
    stroke_radius: float = 2.0
    density: FloatArray | None = None
    part: PartChoice | None = None

    kind: ClassVar[str] = "remesh"

    @property
    def result_type(self) -> type[RemeshResult]:
        """The class of the result."""
        return RemeshResult if self.part is None else PartResult

    @property
    def time_limit(self) -> float | None:
        """Seconds after which the run stops."""
        return self.options.time_limit

    def directions(self) -> FloatArray | None:
        """(n, 3) or (#F, 3) directions, given and drawn; None where there are none. Takes its time."""
        given, vertex_count, face_count = self.guides, len(self.vertices), len(self.polygons.sizes)
        # One for each face is no good beside strokes, nor where it could be taken for one for each vertex.
        drawing = [stroke for stroke in self.strokes if stroke.kind == "direction"]
        if self.guides_of_faces and given is not None and (drawing or vertex_count == face_count):
            given = guides_of_vertices(given, self.polygons, vertex_count)
        if not drawing:
            return given
        length = usual_length(self.vertices, self.polygons, self.options)
        drawn = guides_from_strokes(self.vertices, self.polygons, drawing, self.stroke_radius * length)
        return stronger_of(given, drawn)

    def solve(
        self,
        progress: ProgressCallback | None = None,
        cancel: CancelCallback | None = None,
        cache: StageCache | None = None,
    ) -> RemeshResult:
        """Runs the method and checks what comes of it; any thread may call this.

        Raises
        ------
        InputError, Cancelled, InternalError
            As :func:`hybrid_quad.remesh` does; ``InternalError`` also where the result is no valid quad mesh.
        """
        if self.part is not None:
            return self._solve_part(self.part, progress, cancel)
        result = remesh_with_options(
            self.vertices,
            self.polygons,
            self.options,
            sharp_edges=self.sharp_edges,
            curve_counts=self.curve_counts,
            guides=self.directions(),
            strokes=[stroke for stroke in self.strokes if stroke.kind != "direction"],
            density=self.density,
            progress=progress,
            cancel=cancel,
            cache=cache,
        )
        problems = violations(result.vertices, result.quads)
        if problems:
            raise InternalError("the result is no valid quad mesh: " + "; ".join(problems), "validation")
        return result

    def _solve_part(
        self, part: PartChoice, progress: ProgressCallback | None, cancel: CancelCallback | None
    ) -> RemeshResult:
        asked = part.options_for(self.vertices, self.polygons, self.options)
        return remesh_part_with_options(
            self.vertices,
            self.polygons,
            asked,
            part=part.faces,
            odd_border=part.odd_border,
            sharp_edges=self.sharp_edges,
            curve_counts=self.curve_counts,
            guides=dataclasses.replace(self, options=asked).directions(),
            strokes=[stroke for stroke in self.strokes if stroke.kind != "direction"],
            density=self.density,
            progress=progress,
            cancel=cancel,
        )

    def save(self, path: Path) -> None:
        """Writes the request to a file for :func:`.kinds.load_request`."""
        arrays, values = self.as_bundle()
        save_bundle(path, arrays, {"kind": self.kind, **values})

    def as_bundle(self) -> tuple[Arrays, dict[str, Any]]:
        """All of it as arrays and values for JSON; :meth:`of_bundle` is the way back."""
        arrays = {
            "vertices": self.vertices,
            "face_sizes": self.polygons.sizes,
            "face_vertices": self.polygons.vertices,
            "sharp_edges": self.sharp_edges,
            "guides": self.guides,
            "density": self.density,
            "part": None if self.part is None else self.part.faces,
            **{f"stroke_{index}": stroke.points for index, stroke in enumerate(self.strokes)},
        }
        values = {
            "options": dataclasses.asdict(self.options),
            "curve_counts": self.curve_counts,
            "guides_of_faces": self.guides_of_faces,
            "strokes": [[stroke.strength, stroke.kind] for stroke in self.strokes],
            "stroke_radius": self.stroke_radius,
            "part": None if self.part is None else [self.part.odd_border, self.part.uses_border_length],
        }
        return {name: array for name, array in arrays.items() if array is not None}, values

    @classmethod
    def of_bundle(cls, arrays: Arrays, values: dict[str, Any]) -> RemeshRequest:
        """The request that :meth:`as_bundle` described, with the same bits."""
        options = values["options"]
        if isinstance(options["symmetry_center"], list):
            options["symmetry_center"] = tuple(options["symmetry_center"])
        return cls(
            vertices=arrays["vertices"],
            polygons=Polygons(arrays["face_sizes"], arrays["face_vertices"]),
            options=RemeshOptions(**options),
            sharp_edges=arrays["sharp_edges"],
            curve_counts=[(path, count) for path, count in values["curve_counts"]],
            guides=arrays.get("guides"),
            guides_of_faces=values["guides_of_faces"],
            strokes=tuple(
                Stroke(arrays[f"stroke_{index}"], strength, kind)
                for index, (strength, kind) in enumerate(values["strokes"])
            ),
            stroke_radius=values["stroke_radius"],
            density=arrays.get("density"),
            part=None if values["part"] is None else PartChoice(arrays["part"], *values["part"]),
        )
