"""One run, cut off from Blender: made on the main thread, solved on any."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..core.errors import InternalError
from ..core.mesh_arrays import IntArray
from ..core.options import RemeshOptions
from ..core.remesh import RemeshResult, remesh_with_options
from ..core.validation import violations
from . import edge_marks
from .mesh_source import MeshSource, read_source

if TYPE_CHECKING:
    from .properties import HybridQuadSettings


@dataclass(frozen=True)
class RemeshTask:
    """A mesh, the features marked on it, and what is asked.

    Attributes
    ----------
    source : MeshSource
    options : RemeshOptions
    feature_marks : int
        Those of `edge_marks` that make an edge a feature.
    """

    source: MeshSource
    options: RemeshOptions
    feature_marks: int

    @property
    def marked_edges(self) -> IntArray:
        """Vertex pairs of the edges that are features whatever their angle."""
        return self.source.edges[(self.source.marks & self.feature_marks) != 0]

    def solve(
        self,
        progress: Callable[[str, float], object] | None = None,
        cancel: Callable[[], bool] | None = None,
    ) -> RemeshResult:
        """Runs the method; touches nothing of Blender's, so any thread may call it.

        Raises
        ------
        InputError, Cancelled, InternalError
            As :func:`hybrid_quad.remesh` does.
        """
        result = remesh_with_options(
            self.source.vertices,
            self.source.polygons,
            self.options,
            sharp_edges=self.marked_edges,
            progress=progress,
            cancel=cancel,
        )
        problems = violations(result.vertices, result.quads)
        if problems:
            raise InternalError("the result is no valid quad mesh: " + "; ".join(problems), "validation")
        return result


def prepare_task(
    obj: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    *,
    seed: int = 0,
    threads: int = 0,
    time_limit: float | None = None,
) -> RemeshTask:
    """What an object's settings ask of its mesh as it is now.

    Raises
    ------
    InputError
        If the object shows no surface.
    """
    settings: HybridQuadSettings = obj.hybrid_quad
    options = RemeshOptions(
        quads=settings.quads,
        edge_length=settings.edge_length if settings.target_mode == "LENGTH" else None,
        sharp_angle=round(math.degrees(settings.sharp_angle), 4) if settings.use_sharp_angle else None,
        seed=seed,
        threads=threads,
        time_limit=time_limit,
    )
    marks = (
        (edge_marks.SHARP if settings.use_marked_sharp else 0)
        | (edge_marks.SEAM if settings.use_seams else 0)
        | (edge_marks.FEATURE if settings.use_feature_attribute else 0)
    )
    return RemeshTask(read_source(obj, depsgraph), options, marks)


def marks_of_result(task: RemeshTask, result: RemeshResult) -> tuple[IntArray, edge_marks.MarkArray]:
    """Result edges inside the surface that follow a feature, and the marks of the feature they follow."""
    edges = _inner_edges(result.feature_edges, result.quads, len(result.vertices))
    source = task.source
    marks = source.marks & np.uint8(task.feature_marks)
    if task.options.sharp_angle is not None:
        angle = math.radians(task.options.sharp_angle)
        marks = edge_marks.add_sharp_by_angle(marks, source.vertices, source.polygons, source.edges, angle)
    if not len(edges):
        return edges, np.zeros(0, np.uint8)
    ends = result.vertices[edges]
    spacing = 0.25 * float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean())
    marked = marks != 0
    nearest = edge_marks.of_nearest(ends.mean(axis=1), source.vertices, source.edges[marked], marks[marked], spacing)
    return edges, nearest


def _inner_edges(edges: IntArray, quads: IntArray, vertex_count: int) -> IntArray:
    """Those of some edges that two quads share."""
    if not len(edges):
        return edges
    sides = np.stack([quads, np.roll(quads, -1, axis=1)], axis=2).reshape(-1, 2)
    keys, uses = np.unique(_keys(sides, vertex_count), return_counts=True)
    wanted = _keys(edges, vertex_count)
    found = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return edges[(keys[found] == wanted) & (uses[found] == 2)]


def _keys(edges: IntArray, vertex_count: int) -> np.ndarray:
    pairs = np.sort(edges.astype(np.int64), axis=1)
    return pairs[:, 0] * vertex_count + pairs[:, 1]
