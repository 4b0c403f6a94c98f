"""From a Blender object to arrays: the mesh as the viewport shows it, in the size it has in the scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import bpy
import numpy as np
import numpy.typing as npt

from ..core.errors import InputError
from ..core.mesh_arrays import FloatArray, IntArray, Polygons
from ..core.surface_places import weights_in
from ..core.surface_points import fan_triangles, nearest_on_surface
from . import edge_marks, guide_attributes
from .edge_marks import EdgeValues
from .own_mesh import OwnMesh
from .steps import Steps, finish
from .transfer import layers, shape_keys
from .transfer.layers import LayerOrder, SourceLayers
from .transfer.rest import Rest, at_rest

_FLATTEST = 1e-9  # ratio of the smallest to the largest scale below which no way back exists


@dataclass(frozen=True)
class MeshSource:
    """A copy of all that a run needs of an object; holds nothing of Blender's own except materials in `layers`.

    Attributes
    ----------
    linear : (3, 3) float64
        Object space to the run's space: to world space, without the translation, or scaled along the object's axes only.
    vertices : (n, 3) float64
        In the run's space: in the size of the scene, so that quads come out even under any scale, with the object's
        origin in the origin.
    polygons : Polygons
        Wound as they look in the run's space: where that is mirrored, the polygons are reversed.
    edges : (k, 2) int32
    edge_values : EdgeValues
        What each edge carries.
    guides : (n, 3) or (#F, 3) float64, or None
        Directions painted on vertices or faces, in the same space, as long as they are strong.
    guides_of_faces : bool
        Whether `guides` has one for each face.
    density : (n,) float64 or None
        Painted density: 2 for edges half as long.
    counts : (k,) int32 or None
        Number of quads that each edge asks for along the chain of edges of its value; 0 and less: free.
    unread : tuple of str
        What is to be told of attributes that would guide, but have not the form that is read.
    layers : SourceLayers or None
        What the result takes along, where the source was read for a result.
    seen : (n, 3) float64 or None
        Where the viewport shows the vertices, if what stays alive on the result moves them.
    """

    linear: FloatArray
    vertices: FloatArray
    polygons: Polygons
    edges: IntArray
    edge_values: EdgeValues
    guides: FloatArray | None
    guides_of_faces: bool
    density: FloatArray | None
    counts: IntArray | None
    unread: tuple[str, ...] = ()
    layers: SourceLayers | None = None
    seen: FloatArray | None = None

    @property
    def marks(self) -> edge_marks.MarkArray:
        """(k,) which of `edge_marks` each edge carries."""
        return self.edge_values.marks

    @property
    def is_mirrored(self) -> bool:
        """Whether the way to the run's space turns the surface inside out."""
        return bool(np.linalg.det(self.linear) < 0)

    def from_seen(self, points: FloatArray) -> FloatArray:
        """Points near the surface as the viewport shows it, moved along with it to where it is remeshed."""
        if self.seen is None or not len(points):
            return points
        triangles = fan_triangles(self.polygons)
        nearest = nearest_on_surface(points, self.seen, triangles)
        own = triangles[nearest.triangles]
        moved = np.einsum("ki,kid->kd", weights_in(nearest.positions, self.seen[own]), self.vertices[own])
        result: FloatArray = moved + points - nearest.positions
        return result

    def to_object_space(self, points: FloatArray) -> FloatArray:
        """Points of the run's space, in the object's own."""
        return np.linalg.solve(self.linear, points.T).T


def read_source(
    obj: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    *,
    along_axes: bool = False,
    kinds: frozenset[str] | None = None,
) -> MeshSource:
    """Copies an object's evaluated mesh, modifiers applied.

    Parameters
    ----------
    along_axes : bool
        Keep the object's axes as the axes of the run's space, as mirror planes need it: the mesh is scaled along them as
        in the scene, but not turned, mirrored or sheared.
    kinds : frozenset of str, optional
        Read it for a result that takes these kinds of data along (`transfer.kinds`): with `layers`, and without the
        effect of what stays alive on the result.

    Raises
    ------
    InputError
        ``not_evaluated``, ``no_faces`` or ``flat_scale``.
    """
    linear = _linear_of_run(obj, depsgraph, along_axes)
    with at_rest(obj, depsgraph, kinds or frozenset()) as rest:
        shown = rest.shown.evaluated_get(depsgraph)
        mesh = shown.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph)
        try:
            if not mesh.polygons:
                raise _no_faces(obj)
            order = None if kinds is None else LayerOrder.of(rest, kinds)
            source = finish(source_of(lambda: mesh, linear, order))
            if order is None:
                return source
            points = _points(mesh)
        finally:
            shown.to_mesh_clear()
        return _Shapes.of(obj, rest, depsgraph, points).on(source)


def source_in_steps(
    obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, *, along_axes: bool, kinds: frozenset[str]
) -> Steps[MeshSource]:
    """As :func:`read_source`, for a result. Only the first step looks at the object.

    Raises
    ------
    InputError
        As :func:`read_source`; or ``mesh_gone``, where an undo came between the steps.
    """
    linear = _linear_of_run(obj, depsgraph, along_axes)
    with at_rest(obj, depsgraph, kinds) as rest:
        shown = rest.shown.evaluated_get(depsgraph)
        new = bpy.data.meshes.new_from_object(shown, preserve_all_data_layers=True, depsgraph=depsgraph)
        copy = OwnMesh(new, obj.name)
        try:
            if not copy.mesh().polygons:
                raise _no_faces(obj)
            order = LayerOrder.of(rest, kinds)
            shapes = _Shapes.of(obj, rest, depsgraph, _points(copy.mesh()))
        except BaseException:
            copy.remove()
            raise
    try:
        yield
        source = yield from source_of(copy.mesh, linear, order)
    finally:
        copy.remove()
    return shapes.on(source)


class _Shapes(NamedTuple):
    """Other shapes of a surface.

    Attributes
    ----------
    keys : ShapeKeys or None
    seen : (n, 3) float64 or None
        Where the viewport shows the vertices, in object space.
    """

    keys: shape_keys.ShapeKeys | None
    seen: FloatArray | None

    @classmethod
    def of(cls, obj: bpy.types.Object, rest: Rest, depsgraph: bpy.types.Depsgraph, base: FloatArray) -> _Shapes:
        """Those of an object; evaluates it anew, so that its former evaluated mesh is gone.

        Parameters
        ----------
        base : (n, 3) float64
            Vertices of the mesh in object space.
        """
        seen = None if rest.shown == obj else _seen(obj, depsgraph)
        if seen is not None and len(seen) != len(base):
            seen = None  # the modifiers make other vertices: nothing says which is which
        return cls(shape_keys.read(rest, depsgraph, base) if rest.has_keys else None, seen)

    def on(self, source: MeshSource) -> MeshSource:
        """A source with them."""
        assert source.layers is not None
        return replace(
            source,
            layers=replace(source.layers, keys=self.keys),
            seen=None if self.seen is None else self.seen @ source.linear.T,
        )


def _no_faces(obj: bpy.types.Object) -> InputError:
    lost = " once its modifiers are applied" if obj.data.polygons else ""
    return InputError("no_faces", f'"{obj.name}" has no faces{lost}')


def _linear_of_run(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph, along_axes: bool) -> FloatArray:
    if not obj.evaluated_get(depsgraph).is_evaluated:
        raise InputError(
            "not_evaluated",
            f'"{obj.name}" is disabled in viewports or excluded from the view layer, so its modifiers are unknown',
        )
    linear = linear_of(obj, depsgraph)
    return np.diag(np.linalg.norm(linear, axis=0)) if along_axes else linear


def linear_of(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> FloatArray:
    """(3, 3) object space to world space, without the translation; raises InputError ``flat_scale``."""
    linear = np.array(obj.evaluated_get(depsgraph).matrix_world.to_3x3(), np.float64)
    scales = np.linalg.svd(linear, compute_uv=False)
    if not np.isfinite(linear).all() or scales[2] <= _FLATTEST * scales[0]:
        raise InputError("flat_scale", f'"{obj.name}" is scaled to zero along an axis, so it has no surface to remesh')
    return linear


def _seen(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> FloatArray:
    evaluated = obj.evaluated_get(depsgraph)
    try:
        return _points(evaluated.to_mesh())
    finally:
        evaluated.to_mesh_clear()


def _points(mesh: bpy.types.Mesh) -> FloatArray:
    points: FloatArray = _read(mesh.vertices, "co", np.float32, 3).astype(np.float64).reshape(-1, 3)
    return points


def source_of(mesh_of: Callable[[], bpy.types.Mesh], linear: FloatArray, order: LayerOrder | None) -> Steps[MeshSource]:
    """A mesh, taken to the run's space by `linear` (3, 3), with those layers that are asked for; all but other shapes.

    Parameters
    ----------
    mesh_of : callable()
        The mesh, which is asked for in every step.
    """
    mesh = mesh_of()
    starts = _read(mesh.polygons, "loop_start", np.int32)
    sizes = _read(mesh.polygons, "loop_total", np.int32)
    corners = _read(mesh.loops, "vertex_index", np.int32)
    corner_order = _corner_order(starts, sizes, is_reversed=bool(np.linalg.det(linear) < 0))
    polygons = Polygons(sizes, np.ascontiguousarray(corners[corner_order]))
    edges = _read(mesh.edges, "vertices", np.int32, 2).reshape(-1, 2)
    source = MeshSource(
        linear=linear,
        vertices=_points(mesh) @ linear.T,
        polygons=polygons,
        edges=edges,
        edge_values=edge_marks.no_values(len(edges)),
        guides=guide_attributes.read_guides(mesh, linear),
        guides_of_faces=guide_attributes.are_of_faces(mesh),
        density=guide_attributes.read_density(mesh),
        counts=guide_attributes.read_counts(mesh),
        unread=tuple(guide_attributes.unread(mesh)),
    )
    yield
    source = replace(source, edge_values=(yield from edge_marks.read(mesh_of, polygons, edges, corner_order)))
    if order is None:
        return source
    yield
    return replace(source, layers=(yield from layers.read(order, mesh_of, linear)))


def _corner_order(starts: IntArray, sizes: IntArray, is_reversed: bool) -> npt.NDArray[np.int64]:
    """Loop of every corner, polygon by polygon."""
    first_corner = np.cumsum(sizes, dtype=np.int64) - sizes
    within = np.arange(int(sizes.sum())) - np.repeat(first_corner, sizes)
    if is_reversed:
        within = np.repeat(sizes.astype(np.int64) - 1, sizes) - within
    return np.repeat(starts.astype(np.int64), sizes) + within


def _read(collection: Any, name: str, dtype: type, width: int = 1) -> Any:
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(name, values)
    return values
