"""The operator ``hybrid_quad.paint_guide``: one stroke of the brush."""

# No "from __future__ import annotations" here: Blender reads the properties from the annotations' values.

from typing import Any, NamedTuple

import bpy
import numpy as np
from bpy_extras import view3d_utils
from mathutils import Vector

from ...core.mesh_arrays import FloatArray
from ...core.painting.stroke_path import PenPlace
from ...core.painting.value_strokes import Brush
from . import stroke_view
from .brush_settings import DENSITY_ACTIONS, DENSITY_FACTOR, FALLOFFS, KINDS, STRENGTH, HybridQuadStrokePoint
from .paint_stroke import PaintStroke, StrokeSettings
from .paint_surface import PaintSurface
from .stored_values import WrongAttributeError, are_of_faces

# The way of the mouse is followed in steps of this part of the brush's radius, at least so many pixels.
_STEP_PART, _STEP_PIXELS = 0.125, 2.0
_LINE_PIXELS = 8.0  # between points of painted lines
# A step on the surface so many times as long as on the screen leads over a gap, as from an arm to what is behind it.
_GAP = 8.0
_STEPS_PER_RADIUS = 16  # of strokes that scripts give

_SMALLEST = 0.05  # part of the radius, however softly the pen is pressed

MODES = (
    ("NORMAL", "Normal", "Paint as the settings say"),
    ("INVERT", "Invert", "Erase; for density: the opposite"),
    ("SMOOTH", "Smooth", "Even out what is painted"),
)


class Pressure(NamedTuple):
    """What a pen's pressure counts for.

    Attributes
    ----------
    strength, size : bool
        Of the brush.
    """

    strength: bool
    size: bool

    def on(self, place: PenPlace, pressure: float) -> PenPlace:
        """A place where the pen is pressed so hard; a mouse is pressed by 1."""
        pressure = min(max(pressure, 0.0), 1.0)
        return place._replace(
            pressure=pressure if self.strength else 1.0, size=max(pressure, _SMALLEST) if self.size else 1.0
        )


def problem_of(context: bpy.types.Context) -> str:
    """Why nothing can be painted now; empty where it can."""
    obj = context.object
    if obj is None or obj.type != "MESH":
        return "Select a mesh object first"
    if obj.mode not in ("OBJECT", "SCULPT"):
        return "Switch to Object Mode or Sculpt Mode first"
    if obj.library is not None or obj.data.library is not None:
        return "This mesh is linked from another file; make it local first"
    if not obj.data.polygons:
        return "This mesh has no faces to paint on"
    if getattr(obj, "use_dynamic_topology_sculpting", False):
        return "Switch Dyntopo off first: it makes new vertices all the time"
    if abs(obj.matrix_world.determinant()) < 1e-30:
        return "This object is scaled to zero along an axis, so it has no surface to paint on"
    return ""


class PaintingOperator(bpy.types.Operator):
    """Works on the active object where its mesh can be painted on."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        problem = problem_of(context)
        if problem:
            cls.poll_message_set(problem)
        return not problem


class HYBRID_QUAD_OT_paint_guide(PaintingOperator):
    """Paint on the active mesh how quads should run there: drag over the surface"""

    bl_idname = "hybrid_quad.paint_guide"
    bl_label = "Paint Quad Guide"
    bl_options = {"UNDO"}

    stroke: bpy.props.CollectionProperty(
        name="Stroke",
        description="Places that the stroke passes",
        type=HybridQuadStrokePoint,
        options={"SKIP_SAVE", "HIDDEN"},
    )
    mode: bpy.props.EnumProperty(
        name="Mode",
        description="What is done with what is painted",
        items=MODES,
        default="NORMAL",
        options={"SKIP_SAVE"},
    )
    kind: bpy.props.EnumProperty(
        name="Paint", description="What the stroke paints", items=KINDS, default="DIRECTION", options={"SKIP_SAVE"}
    )
    radius: bpy.props.FloatProperty(
        name="Radius",
        description="Radius of the brush in the scene's units",
        default=0.1,
        min=1e-6,
        subtype="DISTANCE",
        unit="LENGTH",
        options={"SKIP_SAVE"},
    )
    strength: bpy.props.FloatProperty(**STRENGTH, options={"SKIP_SAVE"})
    falloff: bpy.props.EnumProperty(
        name="Falloff",
        description="How the strength fades from the brush's middle to its rim",
        items=FALLOFFS,
        default="SMOOTH",
        options={"SKIP_SAVE"},
    )
    density_action: bpy.props.EnumProperty(
        name="Density",
        description="What the stroke does to the density",
        items=DENSITY_ACTIONS,
        default="DENSER",
        options={"SKIP_SAVE"},
    )
    density_factor: bpy.props.FloatProperty(**DENSITY_FACTOR, options={"SKIP_SAVE"})

    def execute(self, context: bpy.types.Context) -> set[str]:
        """The stroke that a script gives."""
        try:
            stroke = self._begin(context, self.radius)
        except WrongAttributeError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        before: tuple[FloatArray, float] | None = None
        for point in self.stroke:
            position = stroke.surface.from_world(np.array(point.location, np.float64))
            if point.is_start or before is None:
                stroke.lift()
                before = position, point.pressure
            steps = max(1, int(np.ceil(np.linalg.norm(position - before[0]) * _STEPS_PER_RADIUS / self.radius)))
            for share in np.arange(1, steps + 1) / steps:
                place = stroke.surface.nearest((1 - share) * before[0] + share * position)
                if place is not None:
                    pressure = (1 - share) * before[1] + share * point.pressure
                    stroke.add(place._replace(pressure=pressure))
            before = position, point.pressure
        return {"FINISHED"} if stroke.finish(context) else {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """The stroke that begins under the mouse."""
        brush = context.workspace.hybrid_quad_brush
        for name in ("kind", "strength", "falloff", "density_action", "density_factor"):
            if not self.properties.is_property_set(name):
                setattr(self, name, getattr(brush, name))
        try:
            self._surface = self._read_surface(context)
        except WrongAttributeError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self._pixels = float(brush.size)
        self._use_pressure = Pressure(
            strength=brush.use_pressure_strength,
            size=brush.use_pressure_size and self.kind in ("DIRECTION", "DENSITY"),
        )
        self._stroke: PaintStroke | None = None
        self._mouse: Any = None
        self._seen: Any = None
        self._follow(context, event)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Follows the mouse until the button is released; Esc and the right button leave everything as it was."""
        if event.type in {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}:
            self._follow(context, event)
        elif event.type == "LEFTMOUSE" and event.value == "RELEASE":
            self._follow(context, event)
            stroke = self._end(context)
            return {"FINISHED"} if stroke is not None and stroke.finish(context) else {"CANCELLED"}
        elif event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self._end(context)
            return {"CANCELLED"}
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator by itself: another file is loaded, or the window closes."""
        self._end(context)

    def _read_surface(self, context: bpy.types.Context) -> PaintSurface:
        obj = context.object
        of_faces = self.kind == "DIRECTION" and are_of_faces(obj.data, self.kind)
        return PaintSurface(obj, context.evaluated_depsgraph_get(), of_faces=of_faces)

    def _begin(self, context: bpy.types.Context, radius: float, line_spacing: float = np.inf) -> PaintStroke:
        settings = StrokeSettings(
            self.kind,
            self.mode,
            Brush(radius, self.falloff.lower()),
            self.strength,
            self.density_action,
            self.density_factor,
            line_spacing,
        )
        surface = self._read_surface(context) if not hasattr(self, "_surface") else self._surface
        return PaintStroke(context.object, surface, settings)

    def _end(self, context: bpy.types.Context) -> PaintStroke | None:
        stroke, self._stroke = self._stroke, None
        stroke_view.show(None)
        if context.area is not None:
            context.area.tag_redraw()
        return stroke

    def _follow(self, context: bpy.types.Context, event: bpy.types.Event) -> None:
        """Goes on from where the mouse was to where it is, in small steps over the surface."""
        mouse = Vector((event.mouse_x - context.region.x, event.mouse_y - context.region.y))
        start = mouse if self._mouse is None else self._mouse
        step = max(_STEP_PIXELS, _STEP_PART * self._pixels)
        count = max(1, round((mouse - start).length / step))
        if self._mouse is not None and (mouse - start).length < 1:
            return
        for index in range(1, count + 1):
            at = start.lerp(mouse, index / count)
            self._touch(context, at, (at - start).length / index, event)
        self._mouse = mouse
        context.area.tag_redraw()

    def _touch(self, context: bpy.types.Context, at: Vector, step: float, event: bpy.types.Event) -> None:
        region, view = context.region, context.region_data
        origin = view3d_utils.region_2d_to_origin_3d(region, view, at)
        hit = self._surface.under(origin, view3d_utils.region_2d_to_vector_3d(region, view, at))
        if hit is None or hit[1] is None:
            if self._stroke is not None:
                self._stroke.lift()
            self._seen = None
            return
        seen, place = hit
        beside = view3d_utils.region_2d_to_location_3d(region, view, at + Vector((self._pixels, 0)), seen)
        radius = (beside - seen).length
        if self._stroke is None:
            self._stroke = self._begin(context, radius, _LINE_PIXELS * radius / self._pixels)
            stroke_view.show(self._stroke)
        if self._seen is not None and (seen - self._seen).length > _GAP * radius / self._pixels * max(step, 1):
            self._stroke.lift()
        self._seen = seen
        self._stroke.add(self._use_pressure.on(place, event.pressure))


CLASSES = (HYBRID_QUAD_OT_paint_guide,)
