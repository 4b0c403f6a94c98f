"""One run, cut off from Blender: made on the main thread, solved on any."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import bpy
import numpy as np

from ..core.curve_counts import chains_of_edges
from ..core.mesh_arrays import FloatArray, IntArray
from ..core.options import MOST_QUADS, RemeshOptions
from ..core.remesh import RemeshResult
from ..core.remesh_part import PartChoice
from ..core.strokes import Stroke, strokes_of_segments
from ..worker.request import RemeshRequest
from ..worker.transfer_request import TransferRequest
from . import edge_marks, guide_lines
from .mesh_source import MeshSource, read_source, source_in_steps
from .part_source import choice_of, read_part_source
from .steps import Steps
from .transfer import kinds
from .transfer.layers import request_of

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
    ignored : tuple of str
        What is to be told of guides that do nothing.
    """

    source: MeshSource
    options: RemeshOptions
    feature_marks: int
    strokes: tuple[Stroke, ...] = ()
    stroke_radius: float = 2.0
    use_guides: bool = True
    use_density: bool = True
    part: PartChoice | None = None
    ignored: tuple[str, ...] = ()

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

    def transfer_request(self, result: RemeshResult) -> TransferRequest:
        """What a result of the task takes along from its source, to be computed here or in another process."""
        return request_of(self, result)

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
    order = _TaskOrder.of(obj, depsgraph, seed, threads, time_limit, memory_limit, for_result)
    if order.part is None:
        source = read_source(obj, depsgraph, along_axes=bool(order.options.symmetry), kinds=order.kinds)
    else:
        source = read_part_source(obj, depsgraph, order.kinds or frozenset())
    return order.task(source)


def prepare_in_steps(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Steps[RemeshTask]:
    """:func:`prepare_task` for a result, in steps of which only the first looks at the object; a part of a mesh is read in that.

    Raises
    ------
    InputError
        As :func:`prepare_task`; or ``mesh_gone``, where an undo came between the steps.
    """
    order = _TaskOrder.of(obj, depsgraph)
    assert order.kinds is not None
    if order.part is not None:
        return order.task(read_part_source(obj, depsgraph, order.kinds))
    source = yield from source_in_steps(obj, depsgraph, along_axes=bool(order.options.symmetry), kinds=order.kinds)
    yield
    return order.task(source)


class _Lines(NamedTuple):
    """Lines that guide, with the place of the object that they guide, all in world space.

    Attributes
    ----------
    matrix : (4, 4) float64
        The object's.
    each : list of (points (k, 3), strength, kind)
    guiding_marks, kept_marks : int
        Sums of the marks that make an edge a guide, and of those that make it a feature instead.
    marks_strength : float
        Of the guides that such edges are.
    without : list of str
        A sentence for each object or collection that is named as a guide, but has no lines.
    """

    matrix: FloatArray
    each: list[tuple[FloatArray, float, str]]
    guiding_marks: int
    kept_marks: int
    marks_strength: float
    without: list[str]

    @classmethod
    def of(cls, obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> _Lines:
        """Those that an object's settings name."""
        settings: HybridQuadSettings = obj.hybrid_quad
        each = [
            (line, settings.guide_objects_strength, kind)
            for kind, line in guide_lines.lines_of_settings(settings, depsgraph)
        ]
        if settings.use_guide_annotations:
            kind = settings.guide_annotations_kind.lower()
            lines = guide_lines.lines_of_annotations(depsgraph.scene)
            each += [(line, settings.guide_annotations_strength, kind) for line in lines]
        return cls(
            np.array(obj.evaluated_get(depsgraph).matrix_world, np.float64),
            each,
            edge_marks.marks_guiding(settings),
            edge_marks.marks_asked(settings),
            settings.guide_marks_strength,
            guide_lines.guides_without_lines(settings, depsgraph),
        )

    def strokes(self, source: MeshSource) -> tuple[Stroke, ...]:
        """They, and marked edges that guide, in the space of the object's source."""
        soft = ((source.marks & self.guiding_marks) != 0) & ((source.marks & self.kept_marks) == 0)
        strokes = strokes_of_segments(source.vertices[source.edges[soft]], self.marks_strength)
        origin, linear = self.matrix[:3, 3], self.matrix[:3, :3]

        def from_world(line: FloatArray) -> FloatArray:
            local = line - origin
            if not np.array_equal(linear, source.linear):
                local = np.linalg.solve(linear, local.T).T @ source.linear.T
            return source.from_seen(local)

        strokes += [Stroke(from_world(line), strength, kind) for line, strength, kind in self.each]
        return tuple(stroke for stroke in strokes if stroke.strength > 0 or stroke.kind != "direction")


class _TaskOrder(NamedTuple):
    """What an object's settings ask for, with nothing of Blender's own."""

    options: RemeshOptions
    ratio: float | None
    kinds: frozenset[str] | None
    part: PartChoice | None
    feature_marks: int
    lines: _Lines
    stroke_radius: float
    use_guides: bool
    use_density: bool

    @classmethod
    def of(
        cls,
        obj: bpy.types.Object,
        depsgraph: bpy.types.Depsgraph,
        seed: int = 0,
        threads: int = 0,
        time_limit: float | None = None,
        memory_limit: float | None = None,
        for_result: bool = True,
    ) -> _TaskOrder:
        """See :func:`prepare_task`."""
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
        return cls(
            options=options,
            ratio=settings.ratio if settings.target_mode == "RATIO" else None,
            kinds=kinds.asked_by(settings) if for_result else None,
            part=choice_of(obj) if for_result else None,
            feature_marks=edge_marks.marks_asked(settings),
            lines=_Lines.of(obj, depsgraph),
            stroke_radius=settings.guide_radius,
            use_guides=settings.use_guide_attribute,
            use_density=settings.use_density_attribute,
        )

    def task(self, source: MeshSource) -> RemeshTask:
        """The same, asked of the object's source."""
        options, part = self.options, self.part
        if self.ratio is not None:
            faces = len(source.polygons.sizes) if part is None else int(part.faces.sum())
            options = replace(options, quads=min(max(round(self.ratio * faces), 1), MOST_QUADS))
        return RemeshTask(
            source,
            options,
            self.feature_marks,
            strokes=self.lines.strokes(source),
            stroke_radius=self.stroke_radius,
            use_guides=self.use_guides,
            use_density=self.use_density,
            part=part,
            ignored=(*source.unread, *self.lines.without),
        )
