"""What a result takes along from its source, in arrays, without Blender: computed here or in another process."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

from ..core.errors import Cancelled, InternalError
from ..core.mesh_arrays import FloatArray, IntArray, Polygons
from ..core.remesh import CancelCallback, ProgressCallback
from ..core.stage_cache import StageCache
from ..core.stage_names import while_in
from ..core.surface_places import TriangleMesh
from ..core.surface_walk import BoolArray
from ..core.transfer.correspondence import Correspondence
from ..core.transfer.edges import EdgeValues, SourceEdges, edges_of, marks_on_result, seams_on_result
from ..core.transfer.groups import GroupMembers, GroupWeights, members_on_result
from ..core.transfer.layers import Layer, values_on_result
from ..core.transfer.vertex_marks import MarkedVertices
from ..core.transfer.vertex_marks import marks_on_result as vertex_marks_on_result
from .bundle import Arrays, pack, save_bundle, unpack

STAGE = "data_transfer"

Layers = dict[str, tuple[Layer, ...]]


@dataclasses.dataclass(frozen=True, eq=False)
class TransferredData:
    """What a result's mesh is to carry.

    Attributes
    ----------
    layers : dict of str to tuple of arrays
        As in the request, on the result. Values of edges are in the order of `edges`.
    edges : (E, 2) int32, or None
        Vertex pairs of all edges, where a layer is of edges.
    marked_edges : (i, 2) int32
        Vertex pairs.
    edge_values : EdgeValues
        What these carry.
    seams : (j, 2) int32
        Edges that are seams besides.
    vertex_marks : tuple of (n,) float32
    groups : tuple of GroupMembers, or None
    vertices_against : int
        How many vertices correspond to places that face the other way, for want of others.
    """

    layers: dict[str, tuple[Any, ...]]
    edges: IntArray | None
    marked_edges: IntArray
    edge_values: EdgeValues
    seams: IntArray | None
    vertex_marks: tuple[Any, ...]
    groups: tuple[GroupMembers, ...] | None
    vertices_against: int

    def __post_init__(self) -> None:
        """Gives tuples their names again, which came from another process without."""
        set_field = object.__setattr__
        set_field(self, "layers", {name: tuple(values) for name, values in self.layers.items()})
        set_field(self, "edge_values", EdgeValues(*self.edge_values))
        set_field(self, "vertex_marks", tuple(self.vertex_marks))
        if self.groups is not None:
            set_field(self, "groups", tuple(GroupMembers(*group) for group in self.groups))


@dataclasses.dataclass(frozen=True, eq=False)
class TransferRequest:
    """A surface with all that it carries, and a result that is to carry it too.

    Attributes
    ----------
    surface : TriangleMesh
    part : (#F,) bool, or None
        The polygons that the result replaces, where that is not all: nothing else is looked at.
    points : (n, 3) float64
        Of the result, in the surface's space.
    quads : (m, 4) int
        Wound as the surface's triangles.
    feature_edges : (j, 2) int32
        Of the result.
    source_edges : SourceEdges
    layers : dict of str to tuple of Layer
    seam_map : int or None
        Which of the layers ``"uv_maps"`` tells where the result gets seams.
    vertex_marks : tuple of MarkedVertices
    groups : GroupWeights or None
    """

    surface: TriangleMesh
    part: BoolArray | None
    points: FloatArray
    quads: IntArray
    feature_edges: IntArray
    source_edges: SourceEdges
    layers: Layers
    seam_map: int | None
    vertex_marks: tuple[MarkedVertices, ...]
    groups: GroupWeights | None

    kind: ClassVar[str] = "transfer"
    result_type: ClassVar[type[TransferredData]] = TransferredData
    time_limit: ClassVar[float | None] = None

    def solve(
        self,
        progress: ProgressCallback | None = None,
        cancel: CancelCallback | None = None,
        cache: StageCache | None = None,
    ) -> TransferredData:
        """The data on the result; any thread may call this.

        Raises
        ------
        Cancelled, MemoryError
        InternalError
            Whatever else goes wrong: nothing here depends on what a user wishes.
        """
        try:
            return self._solve(progress, cancel)
        except (Cancelled, MemoryError):
            raise
        except Exception as error:
            raise InternalError(f"{type(error).__name__}: {error}", STAGE) from error

    def _solve(self, progress: ProgressCallback | None, cancel: CancelCallback | None) -> TransferredData:
        step = _Steps(4 + sum(map(len, self.layers.values())), progress, cancel)
        step()
        surface = self.surface if self.part is None else self.surface.of_polygons(self.part)
        correspondence = Correspondence(surface, self.points, self.quads)
        vertices_against = correspondence.vertices_against
        step()
        marked_edges, edge_values = marks_on_result(self.source_edges, correspondence, self.feature_edges)
        vertex_marks = vertex_marks_on_result(self.vertex_marks, correspondence)
        step()
        groups = None if self.groups is None else members_on_result(self.groups, correspondence)
        edges, followed = self._followed(correspondence)
        layers: dict[str, tuple[Any, ...]] = {}
        for name, own in self.layers.items():
            values = []
            for layer in own:
                step()
                values.append(values_on_result(layer, correspondence, followed))
            layers[name] = tuple(values)
        step()
        seams = None
        if self.seam_map is not None:
            source_map, values_of_map = self.layers["uv_maps"][self.seam_map], layers["uv_maps"][self.seam_map]
            seams = seams_on_result(self.source_edges, source_map, values_of_map, correspondence)
        return TransferredData(layers, edges, marked_edges, edge_values, seams, vertex_marks, groups, vertices_against)

    def save(self, path: Path) -> None:
        """Writes the request to a file for :func:`.kinds.load_request`."""
        arrays, values = self.as_bundle()
        save_bundle(path, arrays, {"kind": self.kind, **values})

    def as_bundle(self) -> tuple[Arrays, dict[str, Any]]:
        """All of it as arrays and values for JSON; :meth:`of_bundle` is the way back."""
        return pack({field.name: getattr(self, field.name) for field in dataclasses.fields(self)})

    @classmethod
    def of_bundle(cls, arrays: Arrays, values: dict[str, Any]) -> TransferRequest:
        """The request that :meth:`as_bundle` described, with the same bits."""
        own = unpack(arrays, {name: value for name, value in values.items() if name != "kind"})
        polygons, edges, edge_values, *rest = own["source_edges"]
        own["surface"] = TriangleMesh(*own["surface"])
        own["source_edges"] = SourceEdges(Polygons(*polygons), edges, EdgeValues(*edge_values), *rest)
        own["layers"] = {name: tuple(Layer(*layer) for layer in layers) for name, layers in own["layers"].items()}
        own["vertex_marks"] = tuple(MarkedVertices(*marks) for marks in own["vertex_marks"])
        own["groups"] = None if own["groups"] is None else GroupWeights(*own["groups"])
        return cls(**own)

    def _followed(self, correspondence: Correspondence) -> tuple[IntArray | None, Any]:
        """Edges of the result and those of the source along which they run, where a layer is of edges."""
        if not any(layer.domain == "EDGE" for layers in self.layers.values() for layer in layers):
            return None, None
        edges = edges_of(correspondence.quads)
        return edges, correspondence.followed(edges, correspondence.source.points, self.source_edges.edges)


class _Steps:
    """Tells how many of some steps are done, and asks whether to go on."""

    def __init__(self, count: int, progress: ProgressCallback | None, cancel: CancelCallback | None) -> None:
        self._count, self._done = count, 0
        self._progress: Callable[[str, float], object] | None = progress
        self._cancel = cancel

    def __call__(self) -> None:
        if self._cancel is not None and self._cancel():
            raise Cancelled(f"cancelled {while_in(STAGE)}")
        if self._progress is not None:
            self._progress(STAGE, self._done / self._count)
        self._done += 1
