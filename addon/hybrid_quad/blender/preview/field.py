"""The field before a run: what a worker is asked, and the shapes that its answer becomes."""

from __future__ import annotations

import dataclasses
from collections import Counter
from typing import Any

import bpy
import numpy as np

from ...worker.preview_request import PreviewLines, PreviewRequest
from ..mesh_source import MeshSource
from ..properties import HybridQuadSettings
from ..remesh_task import prepare_task
from . import shapes
from .session import Session
from .shapes import Color, Floats, Shape

_CROSS: Color = (0.1, 0.42, 0.85, 1.0)
_FEATURE: Color = (1.0, 0.8, 0.1, 1.0)
_GUIDE: Color = (0.2, 0.9, 0.35, 1.0)
_QUAD: Color = (0.05, 0.05, 0.06, 0.9)
# By index in quarters; others are drawn as the last of their sign.
_SINGULARITIES: dict[int, Color] = {
    1: (1.0, 0.45, 0.05, 1.0),
    2: (1.0, 0.85, 0.2, 1.0),
    -1: (0.15, 0.35, 1.0, 1.0),
    -2: (0.6, 0.2, 0.9, 1.0),
}
# Small quads, usual ones, large ones: told apart on gray, and by eyes that see no red.
_SIZES = ((0.15, 0.1, 0.7), (0.1, 0.42, 0.85), (0.1, 0.65, 0.7), (0.95, 0.55, 0.1), (0.8, 0.1, 0.05))
_SINGULARITY_IN_EDGES = 0.28
_SIZE_RANGE = 2.0  # red is so many times the usual size, blue as many times smaller
_EVEN = 1.05  # sizes that differ by less count as one


class FieldPreview:
    """What is drawn before a run.

    Attributes
    ----------
    session : Session
    """

    def __init__(self) -> None:
        self.session: Session[PreviewLines] = Session(self._ask, self._signature, self._take, keeps_worker=True)
        self._source: MeshSource | None = None
        self._shapes: dict[str, list[Shape]] = {}

    def shapes(self, settings: Any) -> list[Shape]:
        """What the settings show."""
        if self.session.result is None:
            return []
        kinds = [("crosses", settings.show_crosses and not settings.show_sizes)]
        kinds += [("sized_crosses", settings.show_crosses and settings.show_sizes)]
        kinds += [(name, getattr(settings, f"show_{name}")) for name in ("quads", "guides", "features")]
        kinds += [("singularities", settings.show_singularities)]
        return [shape for name, is_shown in kinds if is_shown for shape in self._shapes.get(name, ())]

    def counts(self) -> list[tuple[int, int]]:
        """Indices of singularities, in quarters, and how many have them."""
        found = self.session.result
        return [] if found is None else sorted(Counter(found.singular_quarters.tolist()).items(), reverse=True)

    def _ask(self, obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> list[PreviewRequest]:
        task = prepare_task(obj, depsgraph, for_result=False)
        self._source = task.source
        run = task.request()
        wants_quads = bpy.context.window_manager.hybrid_quad_preview.show_quads
        return [PreviewRequest(run), *([PreviewRequest(run, with_quads=True)] if wants_quads else [])]

    def _signature(self, obj: bpy.types.Object) -> Any:
        """All that the field depends on but the mesh: the depsgraph tells of that."""
        return (*signature_of(obj.hybrid_quad), bpy.context.window_manager.hybrid_quad_preview.show_quads)

    def _take(self, _obj: bpy.types.Object, found: PreviewLines) -> None:
        assert self._source is not None
        self._shapes = field_shapes(self._source, found)


def signature_of(settings: HybridQuadSettings) -> tuple[Any, ...]:
    """Values of an object's settings that a run depends on."""
    values = []
    for prop in settings.bl_rna.properties:
        if prop.identifier in _NO_MATTER:
            continue
        value = getattr(settings, prop.identifier)
        if isinstance(value, bpy.types.ID):
            value = value.name_full
        elif getattr(prop, "is_array", False):
            value = tuple(value)
        elif getattr(prop, "is_enum_flag", False):
            value = tuple(sorted(value))
        values.append(value)
    return tuple(values)


_NO_MATTER = {
    "rna_type",
    "name",
    "transfer",
    "result_mode",
    "last_report",
    "last_check",
    "source_name",
    "time_limit",
    "memory_limit",
    "fit_limit_surface",
}


def field_shapes(source: MeshSource, found: PreviewLines) -> dict[str, list[Shape]]:
    """Everything that can be drawn of a preview, by what it is, in object space."""

    def of_object(points: Floats) -> Floats:
        own: Floats = source.to_object_space(points.reshape(-1, 3).astype(np.float64)).astype(np.float32)
        return own.reshape(points.shape)

    local = dataclasses.replace(
        found, **{name: of_object(getattr(found, name)) for name in ("crosses", "features", "quads", "guides")}
    )
    quads = [shapes.lines(local.quads, _QUAD, 1.5)]
    return {
        "crosses": [shapes.lines(local.crosses, _CROSS, 1.5)],
        "sized_crosses": [shapes.lines(local.crosses, size_colors(found.cross_sizes), 1.5)],
        "features": [shapes.lines(local.features, _FEATURE, 3.0, lift=0.003)],
        "guides": [shapes.lines(local.guides, _GUIDE, 2.0, lift=0.003)],
        "quads": quads if len(found.quads) else [],
        "singularities": _singularities(found, of_object(found.singular_points), source),
    }


def size_colors(sizes: Floats) -> Floats:
    """(k, 4) colors: blue for quads of half the median size, red for those of twice it; one color where all are alike."""
    if not len(sizes):
        return np.zeros((0, 4), np.float32)
    middle = float(np.median(sizes))
    if sizes.max() < _EVEN * middle and sizes.min() * _EVEN > middle:
        return np.tile(np.array(_CROSS, np.float32), (len(sizes), 1))
    return shapes.ramp(0.5 + 0.5 * np.log2(sizes / middle) / np.log2(_SIZE_RANGE), _SIZES)


def _singularities(found: PreviewLines, points: Floats, source: MeshSource) -> list[Shape]:
    if not len(points):
        return []
    scale = abs(float(np.linalg.det(source.linear))) ** (1.0 / 3.0)
    size = _SINGULARITY_IN_EDGES * float(np.median(found.cross_sizes)) / scale
    made = []
    for sign in (1, -1):
        chosen = np.flatnonzero(np.sign(found.singular_quarters) == sign)
        quarters = np.abs(found.singular_quarters[chosen])
        colors = np.array([_SINGULARITIES[sign * min(2, int(quarter))] for quarter in quarters])
        if len(chosen):
            made.append(shapes.solids(points[chosen], size * (0.8 + 0.2 * quarters), colors, is_round=sign > 0))
    return made
