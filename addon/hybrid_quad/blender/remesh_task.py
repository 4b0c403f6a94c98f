"""One run, cut off from Blender: made on the main thread, solved on any."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..core.curve_counts import chains_of_edges
from ..core.mesh_arrays import FloatArray, IntArray
from ..core.options import MOST_QUADS, RemeshOptions
from ..core.remesh import RemeshResult
from ..core.remesh_part import PartChoice
from ..core.strokes import Stroke, strokes_of_segments
from ..worker.request import RemeshRequest
from . import edge_marks, guide_lines
from .mesh_source import MeshSource, read_source
from .part_source import choice_of, read_part_source
from .transfer import kinds

if TYPE_CHECKING:
    from .properties import HybridQuadSettings


# Settings that are passed on as they are.
_NUMBERS = tuple(
    name
    for name in ("field_smoothness", "anisotropy", "narrow_quads", "fit_limit_surface")
    if name in RemeshOptions.__dataclass_fields__
)


@dataclass(frozen=True)
class RemeshTask:
    """A mesh, the features and guides on it, and what is asked.

    Attributes
    ----------
    source : MeshSource
    options : RemeshOptions
    feature_marks : int
        Those of `edge_marks` that make an edge a feature.
    strokes : tuple of Stroke
        Lines that quads follow or cross, in the source's space.
    stroke_radius : float
        How far strokes act, in edge lengths of the quads.
    use_guides, use_density : bool
        Whether what is painted on the source counts.
    part : PartChoice or None
        The faces to remesh, where these are not all; the source is then the object's own mesh.
    """

    source: MeshSource
    options: RemeshOptions
    feature_marks: int
    strokes: tuple[Stroke, ...] = ()
    stroke_radius: float = 2.0
    use_guides: bool = True
    use_density: bool = True
    part: PartChoice | None = None

    @property
    def marked_edges(self) -> IntArray:
        """Vertex pairs of the edges that are features whatever their angle."""
        return self.source.edges[(self.source.marks & self.feature_marks) != 0]

    @property
    def curve_counts(self) -> list[tuple[list[int], int]]:
        """Chains of edges that are to get a certain number of quads."""
        counts = self.source.counts
        return [] if counts is None else chains_of_edges(self.source.edges, counts)

    def guides(self) -> FloatArray | None:
        """(n, 3) or (#F, 3) directions, painted and drawn; None where there are none. Takes its time."""
        return self.request().directions()

    def request(self) -> RemeshRequest:
        """The task without Blender's materials and marks, for a run here or in another process."""
        source = self.source
        return RemeshRequest(
            source.vertices,
            source.polygons,
            self.options,
            self.marked_edges,
            curve_counts=list(self.curve_counts),
            guides=source.guides if self.use_guides else None,
            guides_of_faces=source.guides_of_faces,
            strokes=self.strokes,
            stroke_radius=self.stroke_radius,
            density=source.density if self.use_density else None,
            part=self.part,
        )

    def solve(
        self,
        progress: Callable[[str, float], object] | None = None,
        cancel: Callable[[], bool] | None = None,
    ) -> RemeshResult:
        """Runs the method in this process; touches nothing of Blender's, so any thread may call it.

        Raises
        ------
        InputError, Cancelled, InternalError
            As :func:`hybrid_quad.remesh` does.
        """
        return self.request().solve(progress, cancel)


def prepare_task(
    obj: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    *,
    seed: int = 0,
    threads: int = 0,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    for_result: bool = True,
) -> RemeshTask:
    """What an object's settings ask of its mesh as it is now; a limit that is not given is the settings'.

    Without `for_result`, the mesh is read as the viewport shows it, and nothing that a result would take along.

    Raises
    ------
    InputError
        If the object shows no surface.
    """
    settings: HybridQuadSettings = obj.hybrid_quad
    by_chord = settings.target_mode == "CHORD"
    options = RemeshOptions(
        quads=settings.quads,
        edge_length=settings.edge_length if settings.target_mode == "LENGTH" else None,
        sharp_angle=round(math.degrees(settings.sharp_angle), 4) if settings.use_sharp_angle else None,
        adaptivity=0.0 if by_chord else settings.adaptivity,
        chord_error=settings.chord_error if by_chord else None,
        symmetry=settings.symmetry,
        seed=seed,
        threads=threads,
        time_limit=settings.time_limit or None if time_limit is None else time_limit,
        memory_limit=settings.memory_limit or None if memory_limit is None else memory_limit,
        **{name: getattr(settings, name) for name in _NUMBERS},
    )
    part = choice_of(obj) if for_result else None
    asked = kinds.asked_by(settings) if for_result else None
    if part is None:
        source = read_source(obj, depsgraph, along_axes=bool(options.symmetry), kinds=asked)
    else:
        source = read_part_source(obj, depsgraph, asked)
    if settings.target_mode == "RATIO":
        faces = len(source.polygons.sizes) if part is None else int(part.faces.sum())
        options = replace(options, quads=min(max(round(settings.ratio * faces), 1), MOST_QUADS))
    return RemeshTask(
        source,
        options,
        edge_marks.marks_asked(settings),
        strokes=_strokes(obj, source, depsgraph),
        stroke_radius=settings.guide_radius,
        use_guides=settings.use_guide_attribute,
        use_density=settings.use_density_attribute,
        part=part,
    )


def _strokes(obj: bpy.types.Object, source: MeshSource, depsgraph: bpy.types.Depsgraph) -> tuple[Stroke, ...]:
    """The lines that an object's settings name as guides, in the source's space."""
    settings: HybridQuadSettings = obj.hybrid_quad
    guiding, kept = edge_marks.marks_guiding(settings), edge_marks.marks_asked(settings)
    soft = ((source.marks & guiding) != 0) & ((source.marks & kept) == 0)
    strokes = strokes_of_segments(source.vertices[source.edges[soft]], settings.guide_marks_strength)
    matrix = obj.evaluated_get(depsgraph).matrix_world
    origin, linear = np.array(matrix.translation, np.float64), np.array(matrix.to_3x3(), np.float64)

    def from_world(line: FloatArray) -> FloatArray:
        local = line - origin
        if not np.array_equal(linear, source.linear):
            local = np.linalg.solve(linear, local.T).T @ source.linear.T
        return source.from_seen(local)

    strokes += [
        Stroke(from_world(line), settings.guide_objects_strength, kind)
        for kind, line in guide_lines.lines_of_settings(settings, depsgraph)
    ]
    if settings.use_guide_annotations:
        lines = guide_lines.lines_of_annotations(depsgraph.scene)
        kind = settings.guide_annotations_kind.lower()
        strokes += [Stroke(from_world(line), settings.guide_annotations_strength, kind) for line in lines]
    return tuple(stroke for stroke in strokes if stroke.strength > 0 or stroke.kind != "direction")
