"""A preview of a run, without Blender: solved here or in another process."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ..core.mesh_arrays import FloatArray, IntArray
from ..core.preview import Preview, preview
from ..core.remesh import CancelCallback, ProgressCallback
from ..core.stage_cache import StageCache
from .bundle import Arrays, save_bundle
from .request import RemeshRequest

_MOST_GUIDES = 5000  # directions drawn; of more, every so many


@dataclasses.dataclass(frozen=True, eq=False)
class PreviewLines:
    """What there is to draw of a preview.

    Attributes
    ----------
    crosses, features, quads, guides : (k, 2, 3) float32
        Ends of lines, in the space of the request.
    cross_sizes : (k,) float32
        Size of the quads at each of `crosses`.
    singular_points : (s, 3) float32
    singular_quarters : (s,) int32
    report : dict
        See :class:`hybrid_quad.Preview`.
    """

    crosses: FloatArray
    cross_sizes: FloatArray
    features: FloatArray
    quads: FloatArray
    guides: FloatArray
    singular_points: FloatArray
    singular_quarters: IntArray
    report: dict[str, Any]


@dataclasses.dataclass(frozen=True, eq=False)
class PreviewRequest:
    """A run that is to be previewed.

    Attributes
    ----------
    run : RemeshRequest
    with_quads : bool
        Whether the quad lines are wanted too.
    """

    run: RemeshRequest
    with_quads: bool = False

    kind: ClassVar[str] = "preview"
    result_type: ClassVar[type[PreviewLines]] = PreviewLines

    @property
    def time_limit(self) -> float | None:
        """Seconds after which it stops."""
        return self.run.time_limit

    def solve(
        self,
        progress: ProgressCallback | None = None,
        cancel: CancelCallback | None = None,
        cache: StageCache | None = None,
    ) -> PreviewLines:
        """The preview; any thread may call this.

        Raises
        ------
        InputError, Cancelled, InternalError
            As :func:`hybrid_quad.preview` does.
        """
        run = self.run
        directions = run.directions()
        found = preview(
            run.vertices,
            run.polygons,
            run.options,
            with_quads=self.with_quads,
            sharp_edges=run.sharp_edges,
            curve_counts=run.curve_counts,
            guides=directions,
            strokes=[stroke for stroke in run.strokes if stroke.kind != "direction"],
            density=run.density,
            progress=progress,
            cancel=cancel,
            cache=cache,
        )
        return PreviewLines(
            crosses=found.crosses().astype(np.float32),
            cross_sizes=np.tile(found.sizes()[found.spread], 2).astype(np.float32),
            features=found.feature_lines.astype(np.float32),
            quads=found.quad_lines().astype(np.float32),
            guides=np.concatenate([*self._drawn(), self._directed(directions, found)]).astype(np.float32),
            singular_points=found.singular_points.astype(np.float32),
            singular_quarters=found.singular_quarters,
            report=found.report,
        )

    def save(self, path: Path) -> None:
        """Writes the request to a file for :func:`.kinds.load_request`."""
        arrays, values = self.run.as_bundle()
        save_bundle(path, arrays, {"kind": self.kind, "with_quads": self.with_quads, **values})

    @classmethod
    def of_bundle(cls, arrays: Arrays, values: dict[str, Any]) -> PreviewRequest:
        """The request that was saved."""
        return cls(RemeshRequest.of_bundle(arrays, values), values["with_quads"])

    def _drawn(self) -> list[FloatArray]:
        """The strokes, line by line."""
        return [np.stack([stroke.points[:-1], stroke.points[1:]], axis=1) for stroke in self.run.strokes]

    def _directed(self, directions: FloatArray | None, found: Preview) -> FloatArray:
        """Directions at vertices or faces, as long as a quad where they are strong."""
        run = self.run
        if directions is None or not len(found.points):
            return np.zeros((0, 2, 3))
        places = run.vertices
        if len(directions) != len(places):
            sizes = run.polygons.sizes
            starts = np.cumsum(sizes) - sizes
            places = np.add.reduceat(run.vertices[run.polygons.vertices], starts, axis=0) / sizes[:, None]
        strong = np.flatnonzero(np.linalg.norm(directions, axis=1) > 0)
        strong = strong[:: max(1, len(strong) // _MOST_GUIDES)]
        strength = np.linalg.norm(directions[strong], axis=1, keepdims=True)
        arms = 0.5 * np.median(found.sizes()) * directions[strong] / np.maximum(strength, 1.0)
        lines: FloatArray = np.stack([places[strong] - arms, places[strong] + arms], axis=1)
        return lines
