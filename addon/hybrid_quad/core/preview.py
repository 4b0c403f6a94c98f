"""What a run would follow: the field, its singularities, features and sizes, and the quads before they are improved."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .curve_counts import CurveCount
from .mesh_arrays import FacesLike, FloatArray, IntArray
from .mesh_objects import MeshLike, vertices_and_faces
from .options import RemeshOptions
from .remesh import CancelCallback, ProgressCallback, native_arguments, run_native
from .report import defect_as_json
from .stage_cache import StageCache, lent_by
from .strokes import Stroke

_ARM = 0.42  # of a quad's edge on either side of a cross: those of neighbours do not touch


@dataclass(frozen=True, eq=False)
class Preview:
    """What the first stages of a run say about its result, mirror images included.

    Attributes
    ----------
    points, normals : (n, 3) float64
        Middles of small triangles that cover the surface, and their unit normals.
    u, v : (n, 3) float64
        The two edge vectors of a quad at each point, tangent to the surface, in the units of the mesh: their directions are
        the field, their lengths the size; without quads, the size that was asked for, before anything has to fit together.
    spread : (k,) int32
        Of the points, ones about as far from each other as quads are long: enough to draw.
    singular_points : (s, 3) float64
        Where the field is singular, off the features.
    singular_quarters : (s,) int32
        Index of each, in quarters of a turn: +1 where three quads meet, -1 where five do.
    feature_lines : (f, 2, 3) float64
        Pieces of the lines that become chains of edges, the boundary among them.
    quad_vertices : (p, 3) float64
    quads : (q, 4) int32
        The quads of one try, before their number and shapes are improved; none where they were not asked for.
    report : dict
        ``wanted_quads``, ``warnings``, ``defects`` and ``stages``, as a run's report has them.
    """

    points: FloatArray
    normals: FloatArray
    u: FloatArray
    v: FloatArray
    spread: IntArray
    singular_points: FloatArray
    singular_quarters: IntArray
    feature_lines: FloatArray
    quad_vertices: FloatArray
    quads: IntArray
    report: dict[str, Any]

    def crosses(self) -> FloatArray:
        """(2 k, 2, 3): the ends of lines, two for each of `spread`, nearly as long as the quads' edges there."""
        middle = self.points[self.spread]
        arms = [_ARM * edge[self.spread] for edge in (self.u, self.v)]
        lines: FloatArray = np.concatenate([np.stack([middle - arm, middle + arm], axis=1) for arm in arms])
        return lines

    def sizes(self) -> FloatArray:
        """(n,): the edge length of a square as large as the quads at each point."""
        lengths: FloatArray = np.sqrt(np.linalg.norm(np.cross(self.u, self.v), axis=1))
        return lengths

    def quad_lines(self) -> FloatArray:
        """(e, 2, 3): the ends of every edge of `quads`, each once."""
        sides = np.stack([self.quads, np.roll(self.quads, -1, axis=1)], axis=-1).reshape(-1, 2)
        edges = np.unique(np.sort(sides, axis=1), axis=0)
        lines: FloatArray = self.quad_vertices[edges]
        return lines


def preview(
    vertices: npt.ArrayLike | MeshLike,
    faces: FacesLike | None = None,
    options: RemeshOptions | None = None,
    *,
    with_quads: bool = False,
    sharp_edges: npt.ArrayLike | Iterable[Sequence[int]] | None = None,
    curve_counts: Iterable[CurveCount] | None = None,
    guides: npt.ArrayLike | None = None,
    strokes: Iterable[Stroke | npt.ArrayLike] | None = None,
    stroke_radius: float | None = None,
    density: npt.ArrayLike | None = None,
    frames: npt.ArrayLike | None = None,
    progress: ProgressCallback | None = None,
    cancel: CancelCallback | None = None,
    cache: StageCache | None = None,
) -> Preview:
    """Solves for the field that :func:`hybrid_quad.remesh` would follow, in a fraction of its time.

    Parameters
    ----------
    vertices : (n, 3) float, or a mesh
        Positions; without `faces`, a mesh of trimesh, meshio or alike, see :func:`mesh_arrays`.
    faces : (m, k) int, or a sequence of sequences of int
        0-based vertices of each polygon.
    options : RemeshOptions, optional
        What is asked of the run; by default what :func:`hybrid_quad.remesh` assumes.
    with_quads : bool
        Go on to the quads of one try, before they are improved. Takes about twice the time.
    sharp_edges, curve_counts, guides, strokes, stroke_radius, density, frames, progress, cancel
        As :func:`hybrid_quad.remesh` takes them.
    cache : StageCache, optional
        Of earlier runs: what is the same in this one is not solved for again.

    Returns
    -------
    Preview

    Raises
    ------
    InputError, Cancelled, InternalError, ValueError, TypeError
        As :func:`hybrid_quad.remesh` does.
    """
    options = RemeshOptions() if options is None else options
    if not isinstance(options, RemeshOptions):
        raise TypeError(f"options must be RemeshOptions, not {type(options).__name__}")
    asked, center = native_arguments(
        *vertices_and_faces(vertices, faces),
        options,
        sharp_edges=sharp_edges,
        curve_counts=curve_counts,
        guides=guides,
        strokes=strokes,
        stroke_radius=stroke_radius,
        density=density,
        frames=frames,
    )
    stop = "quads" if with_quads else "field"
    with lent_by(cache, asked) as known:
        found = run_native(asked, **known, progress=progress, cancel=cancel, stop_after=stop)
    if center is not None:
        for name in ("points", "singular_points", "feature_lines", "quad_vertices"):
            found[name] += center
    report = {name: found.pop(name) for name in ("wanted_quads", "warnings", "stages")}
    report["defects"] = [defect_as_json(row) for row in found.pop("defects")]
    return Preview(**found, report=report)
