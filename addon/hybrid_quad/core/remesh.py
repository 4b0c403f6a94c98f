"""From any surface mesh to pure quads, for numpy arrays."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import native, report
from .curve_counts import CurveCount, as_curve_counts
from .errors import InputError
from .guide_values import guides_of_vertices
from .mesh_arrays import (
    FacesLike,
    FloatArray,
    IntArray,
    Polygons,
    as_edges,
    as_polygons,
    as_reals,
    as_vertices,
    require_edges,
    surface_area,
)
from .mesh_objects import MeshLike, meshio_of_quads, trimesh_of_quads, vertices_and_faces
from .options import MOST_QUADS, RemeshOptions
from .snapshots import Snapshot, SnapshotFolder
from .stage_cache import StageCache, lent_by
from .strokes import (
    RADIUS_IN_EDGES,
    Stroke,
    checked_strokes,
    guides_from_strokes,
    native_strokes,
    stronger_of,
)
from .wishes import DENSITY_BOUNDS, native_wishes

if TYPE_CHECKING:
    import meshio
    import trimesh

ProgressCallback = Callable[[str, float], object]
CancelCallback = Callable[[], bool]
SnapshotCallback = Callable[[Snapshot], object]
PathLike = str | os.PathLike[str]

CORNER = 2  # of RemeshResult.vertex_kinds


@dataclass(frozen=True, eq=False)
class RemeshResult:
    """A pure-quad mesh and how it came about.

    Attributes
    ----------
    vertices : (n, 3) float64
        Positions.
    quads : (m, 4) int32
        0-based vertices of each quad, oriented as the input.
    feature_edges : (k, 2) int32
        Output edges that cover the features and the boundary, in the direction of their curves.
    feature_curves : (k,) int32
        The curve that each of `feature_edges` is part of.
    vertex_kinds : (n,) uint8
        0: anywhere on the surface, 1: on a feature curve, 2: a corner.
    report : dict
        Counts, quality, timings and warnings; see ``docs`` or :mod:`hybrid_quad.core.report`.
    """

    vertices: FloatArray
    quads: IntArray
    feature_edges: IntArray
    feature_curves: IntArray
    vertex_kinds: npt.NDArray[np.uint8]
    report: dict[str, Any]

    def to_meshio(self) -> meshio.Mesh:
        """The quads as a ``meshio.Mesh``, which writes many formats; needs meshio."""
        return meshio_of_quads(self.vertices, self.quads)

    def to_trimesh(self) -> trimesh.Trimesh:
        """The quads, each split in two, as a ``trimesh.Trimesh`` with the same vertices; needs trimesh."""
        return trimesh_of_quads(self.vertices, self.quads)


def remesh(
    vertices: npt.ArrayLike | MeshLike,
    faces: FacesLike | None = None,
    *,
    quads: int = 5000,
    edge_length: float | None = None,
    sharp_angle: float | None = 40.0,
    sharp_edges: npt.ArrayLike | Iterable[Sequence[int]] | None = None,
    curve_counts: Iterable[CurveCount] | None = None,
    guides: npt.ArrayLike | None = None,
    strokes: Iterable[Stroke | npt.ArrayLike] | None = None,
    stroke_radius: float | None = None,
    density: npt.ArrayLike | None = None,
    frames: npt.ArrayLike | None = None,
    field_smoothness: float = 0.5,
    adaptivity: float = 0.0,
    chord_error: float | None = None,
    narrow_quads: int = 2,
    anisotropy: float = 1.0,
    size_fidelity: float = 0.5,
    fit_limit_surface: bool = False,
    symmetry: str = "",
    symmetry_center: str | tuple[float, float, float] = "origin",
    solver: str = "multilevel",
    seed: int = 0,
    threads: int = 0,
    time_limit: float | None = None,
    memory_limit: float | None = None,
    progress: ProgressCallback | None = None,
    cancel: CancelCallback | None = None,
    cache: StageCache | None = None,
    dump_stages: PathLike | None = None,
    on_snapshot: SnapshotCallback | None = None,
) -> RemeshResult:
    """Remeshes a surface into pure quads.

    Sharp edges, the boundary and marked edges become chains of output edges; the topology (components, genus,
    boundary loops) stays. The interpreter's lock is free during the run.

    Parameters
    ----------
    vertices : (n, 3) float, or a mesh
        Positions; without `faces`, a mesh of trimesh, meshio or alike, see :func:`mesh_arrays`.
    faces : (m, 3) or (m, 4) int, or a sequence of sequences of int
        0-based vertices of each polygon. Any surface will do: open, of any genus, with several components.
    quads : int
        Number of quads to aim at.
    edge_length : float, optional
        Length of the quads' edges instead of their number, in the units of `vertices`.
    sharp_angle : float or None
        Edges whose faces' normals differ by more than this many degrees are features; ``None`` takes none.
    sharp_edges : (k, 2) int, optional
        Vertex pairs that are features whatever their angle. Each must be an edge of a face.
    curve_counts : sequence of (path, count), optional
        Chains of edges that are to get exactly `count` quad edges: `path` lists 0-based vertices, each joined to the next by
        an edge of a face; a loop repeats its first vertex. They become features, the ends of open ones corners. No edge in
        two of them. What cannot be met (loops of quads have an even number of edges) gets the nearest number that can, and
        a warning; the report's ``curve_counts`` lists all.
    guides : (n, 3) or (m, 3) float, optional
        Directions that edges should take at the n vertices or m faces, in the coordinates of `vertices`; a direction, its
        opposite and those across it are the same. Zero: free; the length is the strength, and cut at 1. Where there are
        as many vertices as faces, of the vertices.
    strokes : iterable of Stroke or (k, 3) float, optional
        Lines on or near the surface that quads should follow (:class:`Stroke` of kind ``"direction"``, or plain points),
        that become chains of edges (``"loop"``), or that cross edges at right angles through their middles (``"ring"``).
        The report's ``guides`` says for every loop and ring, in their order, how near it comes.
    stroke_radius : float, optional
        How far strokes of kind ``"direction"`` act, in the units of `vertices`; two edge lengths where nothing is said.
    density : (n,) float, optional
        For every vertex, 1 where nothing is asked, 2 for edges half as long; cut at 0.1 and 10. The number of quads stays
        the asked one; with `edge_length`, the lengths are `edge_length` / `density`.
    frames : (n, 2, 3) or (m, 2, 3) float, optional
        The two edge vectors of a quad, in usual edge lengths, at vertices or faces; zero: free. Neither orthogonal nor equal
        they need to be, for sheared and stretched quads; up to ten times longer than wide.
    field_smoothness : float
        0: edges follow the surface's bends wherever these are clear at the size of the quads, 1: as few irregular vertices
        as can be.
    adaptivity : float
        0: edges of even length, 1: as short as the curvature asks for.
    chord_error : float, optional
        Instead of `quads` and `adaptivity`: the largest distance between quads and the surface that is aimed at, in the
        units of `vertices`. `edge_length` then bounds the edges; without one, an eighth of the extent does.
    narrow_quads : int, 1 or 2
        Rows of quads that strips between two features get at least, unless two were slivers.
    anisotropy : float
        The most, 1 to 10, by which quads are stretched along the direction in which the surface bends less.
    size_fidelity : float
        Where sizes vary: 0 keeps irregular vertices few, 1 keeps the asked sizes.
    fit_limit_surface : bool
        Move vertices off the surface so that the limit surface of the quads, subdivided by Catmull and Clark's rules with
        infinitely sharp creases on feature edges and corners, lies on it. The report's ``limit_distance_percent`` says how
        near it comes.
    symmetry : str
        Planes about which the result is symmetric, exactly: letters of ``"xyz"``, each the direction in which the plane
        mirrors. The positive side is kept, however symmetric the surface is; the report's ``symmetry`` says how far it is
        from that. ``"auto"``: the planes about which the surface itself is symmetric. ``""``: none.
    symmetry_center : {"origin", "bounds"} or (float, float, float)
        Where the planes meet. Coordinates are equal bit for bit up to the sign about the origin; about another point
        they are rounded when it is added.
    solver : {"multilevel", "eigen"}
        How the periodic field is found: coarse to fine, or, slower, by the paper's eigenvector and Gauss-Newton steps.
    seed : int
        Same input, options and seed give the same bytes.
    threads : int
        0: all that this process may use. The result does not depend on it.
    time_limit : float, optional
        Seconds after which the run stops.
    memory_limit : float, optional
        Megabytes of resident memory of the whole process at which the run stops; looked at twenty times a second.
    progress : callable(stage: str, fraction: float), optional
        Called at most twenty times a second; `fraction` of the whole run never falls.
    cancel : callable() -> bool, optional
        Polled up to twenty times a second; a true answer stops the run within a second.
    cache : StageCache, optional
        Of earlier runs on this surface: stages that depend on nothing that has changed are not done again. The result is the same.
    dump_stages : path, optional
        Folder that receives a ``.vtu`` file of every stage, which ParaView opens. Needs ``meshio``.
    on_snapshot : callable(Snapshot), optional
        Receives every stage as arrays instead.

    Returns
    -------
    RemeshResult

    Raises
    ------
    InputError
        If the input is no surface; names the elements.
    Cancelled
        If `cancel` asked for it, or at `time_limit` or `memory_limit`. An exception raised in a callback, and KeyboardInterrupt, come
        back unchanged.
    InternalError
        If a promise between two stages did not hold: a bug of this package.
    ValueError, TypeError
        If an option makes no sense, or an array has the wrong shape or type.
    """
    options = RemeshOptions(
        quads=quads,
        edge_length=edge_length,
        sharp_angle=sharp_angle,
        field_smoothness=field_smoothness,
        adaptivity=adaptivity,
        chord_error=chord_error,
        narrow_quads=narrow_quads,
        anisotropy=anisotropy,
        size_fidelity=size_fidelity,
        fit_limit_surface=fit_limit_surface,
        symmetry=symmetry,
        symmetry_center=symmetry_center,
        solver=solver,
        seed=seed,
        threads=threads,
        time_limit=time_limit,
        memory_limit=memory_limit,
    )
    return remesh_with_options(
        *vertices_and_faces(vertices, faces),
        options,
        sharp_edges=sharp_edges,
        curve_counts=curve_counts,
        guides=guides,
        strokes=strokes,
        stroke_radius=stroke_radius,
        density=density,
        frames=frames,
        progress=progress,
        cancel=cancel,
        cache=cache,
        dump_stages=dump_stages,
        on_snapshot=on_snapshot,
    )


def remesh_with_options(
    vertices: npt.ArrayLike,
    faces: FacesLike,
    options: RemeshOptions,
    *,
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
    dump_stages: PathLike | None = None,
    on_snapshot: SnapshotCallback | None = None,
) -> RemeshResult:
    """:func:`remesh`, with the settings in one value."""
    from .. import __version__

    asked, center = native_arguments(
        vertices,
        faces,
        options,
        sharp_edges=sharp_edges,
        curve_counts=curve_counts,
        guides=guides,
        strokes=strokes,
        stroke_radius=stroke_radius,
        density=density,
        frames=frames,
    )
    snapshot = _snapshot_receiver(dump_stages, on_snapshot)
    with lent_by(cache, asked) as known:
        found = run_native(asked, **known, progress=progress, cancel=cancel, snapshot=snapshot)
    places = found.vertices if center is None else found.vertices + center
    finished = report.finished(found.report, options, __version__)
    return RemeshResult(places, found.quads, found.feature_edges, found.feature_curves, found.vertex_kinds, finished)


def run_native(asked: dict[str, Any], **more: Any) -> Any:
    """The compiled part's ``remesh``, of what :func:`native_arguments` gives."""
    module = native.load()
    wishes = dict(asked)
    mesh = module.PolygonMesh(*(wishes.pop(name) for name in ("vertices", "face_sizes", "face_vertices")))
    return module.remesh(mesh, **wishes, **more)


def native_arguments(
    vertices: npt.ArrayLike,
    faces: FacesLike,
    options: RemeshOptions,
    *,
    sharp_edges: npt.ArrayLike | Iterable[Sequence[int]] | None,
    curve_counts: Iterable[CurveCount] | None,
    guides: npt.ArrayLike | None,
    strokes: Iterable[Stroke | npt.ArrayLike] | None,
    stroke_radius: float | None,
    density: npt.ArrayLike | None,
    frames: npt.ArrayLike | None,
) -> tuple[dict[str, Any], FloatArray | None]:
    """What the compiled part is asked, and what is to be added to the points that it gives, if anything."""
    points, polygons, marked = as_vertices(vertices), as_polygons(faces), as_edges(sharp_edges)
    require_edges(marked, polygons, len(points))
    lines = checked_strokes(strokes)
    guides = _with_directions(points, polygons, options, guides, lines, stroke_radius)
    wishes = native_wishes(guides, density, frames, len(points), polygons)
    _require_enough_length(points, polygons, options, wishes["density"])
    center = _symmetry_center(points, options)
    asked = {
        "vertices": points if center is None else points - center,
        "face_sizes": polygons.sizes,
        "face_vertices": polygons.vertices,
        "sharp_edges": marked,
        "curve_counts": as_curve_counts(curve_counts),
        **wishes,
        **native_strokes(lines, center),
        **options.for_native(),
    }
    return asked, center


def _with_directions(
    points: FloatArray,
    polygons: Polygons,
    options: RemeshOptions,
    guides: npt.ArrayLike | None,
    strokes: list[Stroke],
    radius: float | None,
) -> npt.ArrayLike | None:
    """`guides`, with those of the strokes that are directions: at each place the stronger."""
    directions = [stroke for stroke in strokes if stroke.kind == "direction"]
    if not directions:
        return guides
    length = usual_length(points, polygons, options)
    if not length > 0:  # no surface: the run itself says so
        return guides
    drawn = guides_from_strokes(points, polygons, directions, RADIUS_IN_EDGES * length if radius is None else radius)
    given = None if guides is None else as_reals(guides, "guides")
    if given is not None and given.shape != drawn.shape and given.shape == (len(polygons.sizes), 3):
        given = guides_of_vertices(given, polygons, len(points))
    return stronger_of(given, drawn) if given is None or given.shape == drawn.shape else given


def usual_length(points: FloatArray, polygons: Polygons, options: RemeshOptions) -> float:
    """Length of the quads' edges that the options ask for."""
    return options.edge_length or math.sqrt(surface_area(points, polygons) / options.quads)


def _symmetry_center(points: FloatArray, options: RemeshOptions) -> FloatArray | None:
    """What is subtracted from the points so that the mirror planes go through the origin, if anything."""
    if not options.symmetry or options.symmetry_center == "origin" or not len(points):
        return None
    if options.symmetry_center == "bounds":
        middle: FloatArray = 0.5 * (points.min(axis=0) + points.max(axis=0))
        return middle
    return np.array(options.symmetry_center, np.float64)


def _require_enough_length(points: FloatArray, polygons: Polygons, options: RemeshOptions, density: FloatArray) -> None:
    if options.edge_length is None or options.chord_error is not None:
        return
    expected = surface_area(points, polygons) / options.edge_length / options.edge_length  # its square may be no number
    if len(density):
        expected *= float((np.clip(density, *DENSITY_BOUNDS) ** 2).mean())
    if expected > MOST_QUADS:
        raise InputError(
            "too_many_quads",
            f"Quads of edge length {options.edge_length:g} would be {_about(expected)} on this surface, "
            f"more than {MOST_QUADS}.",
        )


def _about(number: float) -> str:
    return f"about {number:.2g}" if math.isfinite(number) else "beyond all counting"


def _snapshot_receiver(
    dump_stages: PathLike | None, on_snapshot: SnapshotCallback | None
) -> Callable[[dict[str, Any]], None] | None:
    receivers: list[SnapshotCallback] = [] if on_snapshot is None else [on_snapshot]
    if dump_stages is not None:
        receivers.append(SnapshotFolder(dump_stages).write)
    if not receivers:
        return None

    def receive(fields: dict[str, Any]) -> None:
        snapshot = Snapshot(**fields)
        for receiver in receivers:
            receiver(snapshot)

    return receive
