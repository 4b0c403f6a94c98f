"""Loops and rings that were painted: the splines of curve objects that are children of the mesh object.

They are ordinary curves, to be edited by hand or made by other tools: what makes them guides is that they are children, and their
custom property `KIND_PROPERTY`.
"""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ...core.mesh_arrays import FloatArray
from ...core.painting.drawn_lines import Line
from ..guide_lines import KIND_PROPERTY


class PaintedLines:
    """The lines of one kind on a mesh object, in its space.

    Parameters
    ----------
    obj : bpy.types.Object
    kind : {"LOOP", "RING"}
    """

    def __init__(self, obj: bpy.types.Object, kind: str) -> None:
        self._obj, self._kind = obj, kind

    def read(self) -> list[Line]:
        """All that brushes can change: splines of straight pieces, object by object."""
        return [line for curve in self._curves() for line in _lines_of(curve, self._from_curve(curve))]

    def add(self, context: bpy.types.Context, lines: list[Line]) -> None:
        """Puts lines into the latest of the curve objects, or a new one."""
        if not lines:
            return
        curves = self._curves()
        curve = curves[-1] if curves else self._new_curve(context)
        to_curve = np.linalg.inv(self._from_curve(curve))
        for line in lines:
            _add_spline(curve.data, _moved(line.points, to_curve), line.is_closed)

    def replace(self, pieces: list[list[Line]]) -> None:
        """Puts in the place of each line that :meth:`read` gives what is left of it; one that is its only piece stays.

        Curve objects without splines are removed.
        """
        at = iter(pieces)
        for curve in self._curves():
            from_curve = self._from_curve(curve)
            to_curve = np.linalg.inv(from_curve)
            splines = [spline for spline in curve.data.splines if spline.type == "POLY"]
            old = _lines_of(curve, from_curve)
            changes = [(spline, line, next(at)) for spline, line in zip(splines, old, strict=True)]
            gone = []
            for spline, line, left in changes:
                if len(left) == 1 and np.array_equal(left[0].points, line.points):
                    continue
                gone.append(spline)
                for piece in left:
                    _add_spline(curve.data, _moved(piece.points, to_curve), piece.is_closed)
            for spline in gone:
                curve.data.splines.remove(spline)
            curve.data.update_tag()
            if not curve.data.splines:
                _remove(curve)

    def clear(self) -> int:
        """Removes the curve objects; returns how many there were."""
        curves = self._curves()
        for curve in curves:
            _remove(curve)
        return len(curves)

    def _curves(self) -> list[bpy.types.Object]:
        return [
            child
            for child in self._obj.children
            if child.type == "CURVE"
            and child.data.library is None
            and str(child.get(KIND_PROPERTY, "")).upper() == self._kind
        ]

    def _new_curve(self, context: bpy.types.Context) -> bpy.types.Object:
        name = f"{self._obj.name} {'Loops' if self._kind == 'LOOP' else 'Rings'}"
        data = bpy.data.curves.new(name, "CURVE")
        data.dimensions = "3D"
        curve = bpy.data.objects.new(name, data)
        curve[KIND_PROPERTY] = self._kind.lower()
        curve.parent = self._obj
        curve.hide_render = True
        collection = next(iter(self._obj.users_collection), context.scene.collection)
        collection.objects.link(curve)
        return curve

    def _from_curve(self, curve: bpy.types.Object) -> FloatArray:
        """(4, 4) from a curve's space to the mesh object's. Not by world matrices, which new objects do not have yet."""
        return np.array(curve.matrix_parent_inverse @ curve.matrix_basis, np.float64)


def _lines_of(curve: bpy.types.Object, matrix: FloatArray) -> list[Line]:
    lines = []
    for spline in curve.data.splines:
        if spline.type == "POLY":
            values = np.empty(4 * len(spline.points), np.float32)
            spline.points.foreach_get("co", values)
            points = values.reshape(-1, 4)[:, :3].astype(np.float64)
            lines.append(Line(_moved(points, matrix), spline.use_cyclic_u))
    return lines


def _add_spline(data: Any, points: FloatArray, is_closed: bool) -> None:
    spline = data.splines.new("POLY")
    spline.points.add(len(points) - 1)
    spline.points.foreach_set("co", np.column_stack([points, np.ones(len(points))]).astype(np.float32).ravel())
    spline.use_cyclic_u = is_closed
    data.update_tag()


def _remove(curve: bpy.types.Object) -> None:
    data = curve.data
    bpy.data.objects.remove(curve)
    if not data.users:
        bpy.data.curves.remove(data)


def _moved(points: FloatArray, matrix: FloatArray) -> FloatArray:
    moved: FloatArray = points @ matrix[:3, :3].T + matrix[:3, 3]
    return moved
