"""The panel that tells what the latest run gave."""

from __future__ import annotations

from typing import Any

import bpy

from ..cli.messages import what_became_of
from ..core import defect_names
from .panel_base import HybridQuadPanel, draw_figure, draw_text
from .result_mesh import read_report


class VIEW3D_PT_hybrid_quad_report(HybridQuadPanel, bpy.types.Panel):
    """What the latest run of the active object gave."""

    bl_label = "Last Result"
    bl_parent_id = "VIEW3D_PT_hybrid_quad"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return super().poll(context) and bool(context.object.hybrid_quad.last_report)

    def draw(self, context: bpy.types.Context) -> None:
        report = read_report(context.object)
        if report is None:
            self.layout.label(text="No report that can be read", icon="ERROR")
            return
        rows = self.layout.column(align=True)
        for name, value in _rows_of(report):
            draw_figure(rows, name, value)
        for defect in report.get("defects", ()):
            became = what_became_of(defect).capitalize()
            name = defect_names.in_words(defect["code"], len(defect["elements"]))
            draw_text(self.layout, f"{became}: {name}", "INFO")
        for warning in report.get("warnings", ()):
            draw_text(self.layout, warning, "ERROR")


def _rows_of(report: dict[str, Any]) -> list[tuple[str, str]]:
    quality = report.get("scaled_jacobian", {})
    return [
        ("Quads", f"{report.get('quads', 0):,}"),
        ("Irregular vertices", f"{report.get('irregular_vertices', 0):,}"),
        ("Quad shape, mean", _number(quality.get("mean"))),
        ("Quad shape, worst", _number(quality.get("min"))),
        ("Largest distance", f"{_number(report.get('hausdorff_percent'))} %"),
        *_symmetry_rows(report.get("symmetry", {})),
        ("Time", f"{sum(stage.get('seconds', 0.0) for stage in report.get('stages', ())):.1f} s"),
    ]


def _symmetry_rows(symmetry: dict[str, Any]) -> list[tuple[str, str]]:
    """How far the object is from symmetric along each axis, and along which it was mirrored."""
    used = symmetry.get("planes", "")
    return [
        (f"Deviation {axis.upper()}{', mirrored' if axis in used else ''}", f"{_number(deviation.get('max'))} %")
        for axis, deviation in symmetry.get("deviation_percent", {}).items()
    ]


def _number(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"
