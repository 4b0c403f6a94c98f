"""A stroke under way on an object, whatever it paints; Blender's data change only when it is done."""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import bpy
import numpy as np

from ...core.mesh_arrays import FloatArray
from ...core.painting.brush_surface import Dabs, Indices
from ...core.painting.density_values import LOG_BOUNDS
from ...core.painting.drawn_lines import Line, drawn_line, erased, smoothed
from ...core.painting.stroke_path import PenPlace, StrokePath
from ...core.painting.value_strokes import (
    Brush,
    Comb,
    Erase,
    Shift,
    SmoothDirections,
    SmoothNumbers,
    ValueStroke,
)
from . import stored_values
from .paint_surface import PaintSurface
from .painted_lines import PaintedLines

_DABS_PER_RADIUS = 4
_OPPOSITES = {"DENSER": "COARSER", "COARSER": "DENSER"}


class StrokeSettings(NamedTuple):
    """What a stroke does.

    Attributes
    ----------
    kind : {"DIRECTION", "LOOP", "RING", "DENSITY"}
    mode : {"NORMAL", "INVERT", "SMOOTH"}
        As it is, with Ctrl, with Shift.
    brush : Brush
        Its radius in the scene's units.
    strength : float
    density_action : {"DENSER", "COARSER", "SMOOTH", "NEUTRAL"}
    density_factor : float
    line_spacing : float
        Largest distance between points of painted lines.
    """

    kind: str
    mode: str
    brush: Brush
    strength: float
    density_action: str = "DENSER"
    density_factor: float = 2.0
    line_spacing: float = math.inf


class PaintStroke:
    """One stroke, from where the pen touches the surface first to where it is lifted last.

    Parameters
    ----------
    obj : bpy.types.Object
    surface : PaintSurface
    settings : StrokeSettings

    Attributes
    ----------
    way : list of (3,) float64
        Places so far since the pen was lifted last, in the brush's space.
    """

    def __init__(self, obj: bpy.types.Object, surface: PaintSurface, settings: StrokeSettings) -> None:
        self.obj, self.surface, self.settings = obj, surface, settings
        self.way: list[FloatArray] = []
        self._path = StrokePath(settings.brush.radius / _DABS_PER_RADIUS)
        self._ways: list[list[FloatArray]] = []
        self._dabs: list[Dabs] = []
        self._changed: list[Indices] = []
        self.values = self._value_stroke() if settings.kind in ("DIRECTION", "DENSITY") else None
        flags = (obj.data.use_mirror_x, obj.data.use_mirror_y, obj.data.use_mirror_z)
        mirrored = [axis for axis, is_on in enumerate(flags) if is_on]
        self._mirrors = [
            axes for count in range(1, len(mirrored) + 1) for axes in itertools.combinations(mirrored, count)
        ]

    def add(self, place: PenPlace) -> None:
        """Goes on to a place."""
        self.way.append(place.position)
        self._touch(self._path.add(place._replace(pressure=place.pressure * self.settings.strength)))

    def lift(self) -> None:
        """The pen leaves the surface."""
        self._touch(self._path.lift())
        if self.way:
            self._ways.append(self.way)
        self.way = []

    def finish(self, context: bpy.types.Context) -> bool:
        """Stores what was painted; returns whether there was anything."""
        self.lift()
        if self.values is not None:
            elements = np.unique(np.concatenate(self._changed)) if self._changed else np.zeros(0, np.int64)
            if len(elements):
                values = self.values.values[elements]
                stored_values.write(self.obj.data, self.settings.kind, elements, values, self.surface.linear)
            return len(elements) > 0
        lines = PaintedLines(self.obj, self.settings.kind)
        if self.settings.mode == "NORMAL":
            drawn = [self._to_object(line) for line in self._drawn()]
            lines.add(context, drawn)
            return bool(drawn)
        return self._change(lines)

    def _touch(self, dabs: Dabs) -> None:
        if not len(dabs.positions):
            return
        for each in (dabs, *(self.surface.mirrored(dabs, axes) for axes in self._mirrors)):
            if self.values is None:
                self._dabs.append(each)
            elif len(each.positions):
                self._changed.append(self.values.add(each))

    def _value_stroke(self) -> ValueStroke:
        settings, surface = self.settings, self.surface.brush
        values = stored_values.read(self.obj.data, settings.kind, self.surface.linear)
        if settings.kind == "DIRECTION":
            return {"NORMAL": Comb, "INVERT": Erase, "SMOOTH": SmoothDirections}[settings.mode](
                surface, values, settings.brush
            )
        action = settings.density_action
        if settings.mode == "INVERT":
            action = _OPPOSITES.get(action, action)
        if settings.mode == "SMOOTH" or action == "SMOOTH":
            return SmoothNumbers(surface, values, settings.brush)
        if action == "NEUTRAL":
            return Erase(surface, values, settings.brush)
        amount = math.log(settings.density_factor) * (1 if action == "DENSER" else -1)
        return Shift(surface, values, settings.brush, amount, LOG_BOUNDS)

    def _drawn(self) -> list[Line]:
        """What the pen drew, in the brush's space, on the surface; on the mirrored sides too."""
        radius = self.settings.brush.radius
        spacing = min(radius / _DABS_PER_RADIUS, self.settings.line_spacing)
        lines = [drawn_line(np.array(way), spacing, radius) for way in self._ways]
        on_surface = [self._put_on_surface(line) for line in lines if line is not None]
        result = list(on_surface)
        for axes in self._mirrors:
            for line in on_surface:
                count = len(line.points)
                dabs = Dabs(line.points, np.zeros((count, 3)), np.zeros(count, np.int64), *np.ones((2, count)))
                result.append(line._replace(points=self.surface.mirrored(dabs, axes).positions))
        return result

    def _put_on_surface(self, line: Line) -> Line:
        places = [self.surface.nearest(point) for point in line.points]
        return line._replace(points=np.array([place.position for place in places if place is not None]))

    def _change(self, lines: PaintedLines) -> bool:
        """Erases or smooths what the brush touched."""
        old = [line._replace(points=line.points @ self.surface.linear.T) for line in lines.read()]
        centers = np.concatenate([dabs.positions for dabs in self._dabs] or [np.zeros((0, 3))])
        if self.settings.mode == "INVERT":
            pieces = erased(old, centers, self.settings.brush.radius)
        else:
            moved = [smoothed(line, centers, self.settings.brush, self.settings.strength) for line in old]
            pieces = [
                [line] if line is before else [self._put_on_surface(line)]
                for line, before in zip(moved, old, strict=True)
            ]
        changed = [len(left) != 1 or left[0] is not before for left, before in zip(pieces, old, strict=True)]
        if any(changed):
            own = lines.read()
            lines.replace(
                [
                    [self._to_object(piece) for piece in left] if is_changed else [before]
                    for left, before, is_changed in zip(pieces, own, changed, strict=True)
                ]
            )
        return any(changed)

    def _to_object(self, line: Line) -> Line:
        return line._replace(points=self.surface.to_object(line.points))
