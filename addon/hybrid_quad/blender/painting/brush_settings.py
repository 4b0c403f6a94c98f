"""Settings of the brush that paints guides.

They are saved with the workspace, as other tools' are: undo, which takes strokes back, leaves them alone.
"""

# No "from __future__ import annotations" here: Blender reads the properties from the annotations' values.

import bpy

from ...core.wishes import DENSITY_BOUNDS

KINDS = (
    (
        "DIRECTION",
        "Direction",
        "Comb: edges of quads turn along the strokes. Ctrl erases, Shift smooths",
        "FORCE_WIND",
        0,
    ),
    ("LOOP", "Loop", "Draw lines that become connected chains of edges. Ctrl erases, Shift smooths", "CURVE_PATH", 1),
    (
        "RING",
        "Ring",
        "Draw lines that cross edges at right angles through their middles. Ctrl erases, Shift smooths",
        "CURVE_NCIRCLE",
        2,
    ),
    (
        "DENSITY",
        "Density",
        "Paint where quads are smaller or larger. Ctrl does the opposite, Shift smooths",
        "TEXTURE",
        3,
    ),
)
FALLOFFS = (
    ("SMOOTH", "Smooth", "Strong in the middle, fading softly", "SMOOTHCURVE", 0),
    ("SPHERE", "Sphere", "Strong almost to the rim", "SPHERECURVE", 1),
    ("LINEAR", "Linear", "Fading evenly", "LINCURVE", 2),
    ("SHARP", "Sharp", "Strong in the very middle only", "SHARPCURVE", 3),
    ("CONSTANT", "Constant", "Equally strong everywhere within the radius", "NOCURVE", 4),
)
DENSITY_ACTIONS = (
    ("DENSER", "Denser", "Make quads smaller"),
    ("COARSER", "Coarser", "Make quads larger"),
    ("SMOOTH", "Smooth", "Even the density out"),
    ("NEUTRAL", "Neutral", "Take the painted density away"),
)
STRENGTH = {
    "name": "Strength",
    "description": "How strongly a stroke acts in the brush's middle, from not at all (0) to fully (1). For directions: how strongly "
    "quads follow it",
    "default": 1.0,
    "min": 0.0,
    "max": 1.0,
    "subtype": "FACTOR",
}
DENSITY_FACTOR = {
    "name": "Factor",
    "description": "How many times shorter, or longer, a stroke of full strength makes the quads' edges",
    "default": 2.0,
    "min": 1.01,
    "max": DENSITY_BOUNDS[1],
    "soft_max": 4.0,
    "precision": 2,
}


class HybridQuadBrushSettings(bpy.types.PropertyGroup):
    """What the tool's header shows; lives on every workspace as ``workspace.hybrid_quad_brush``."""

    kind: bpy.props.EnumProperty(name="Paint", description="What strokes paint", items=KINDS, default="DIRECTION")
    size: bpy.props.IntProperty(
        name="Radius",
        description="Radius of the brush in pixels",
        default=50,
        min=1,
        max=1000,
        soft_max=500,
        subtype="PIXEL",
    )
    use_pressure_size: bpy.props.BoolProperty(
        name="Radius Pressure",
        description="The harder the pen is pressed, the larger the brush, up to its radius",
        default=False,
    )
    strength: bpy.props.FloatProperty(**STRENGTH)
    use_pressure_strength: bpy.props.BoolProperty(
        name="Strength Pressure", description="The harder the pen is pressed, the stronger the stroke", default=True
    )
    falloff: bpy.props.EnumProperty(
        name="Falloff",
        description="How the strength fades from the brush's middle to its rim",
        items=FALLOFFS,
        default="SMOOTH",
    )
    density_action: bpy.props.EnumProperty(
        name="Density", description="What strokes do to the density", items=DENSITY_ACTIONS, default="DENSER"
    )
    density_factor: bpy.props.FloatProperty(**DENSITY_FACTOR)


class HybridQuadStrokePoint(bpy.types.PropertyGroup):
    """A place that a stroke passes."""

    location: bpy.props.FloatVectorProperty(
        name="Location", description="In world space, on or near the surface", size=3, subtype="XYZ"
    )
    pressure: bpy.props.FloatProperty(
        name="Pressure",
        description="How hard the pen is pressed, from not at all (0) to fully (1)",
        default=1.0,
        min=0.0,
        max=1.0,
    )
    is_start: bpy.props.BoolProperty(
        name="Is Start",
        description="The pen was lifted before: nothing leads here from the place before",
        default=False,
    )


CLASSES = (HybridQuadBrushSettings, HybridQuadStrokePoint)
