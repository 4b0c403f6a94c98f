"""Settings of an object's remeshing; they are saved with the object."""

# No "from __future__ import annotations" here: Blender reads the properties from the annotations' values.

import math

import bpy

from ..core.options import MOST_QUADS, RemeshOptions

TARGET_MODES = (
    ("COUNT", "Quad Count", "Say how many quads the result should have"),
    ("LENGTH", "Edge Length", "Say how long the quads' edges should be"),
)
RESULT_MODES = (
    ("NEW", "New Object", "Put the quads in a new object; this one stays as it is, hidden in viewports and renders"),
    (
        "REPLACE",
        "Replace Mesh",
        "Put the quads in this object. Visible modifiers are applied. Other users of the mesh keep the old one",
    ),
)


class HybridQuadSettings(bpy.types.PropertyGroup):
    """What the panel shows; lives on every object as ``object.hybrid_quad``."""

    target_mode: bpy.props.EnumProperty(
        name="Target", description="What decides the size of the quads", items=TARGET_MODES, default="COUNT"
    )
    quads: bpy.props.IntProperty(
        name="Quads",
        description="Number of quads to aim at. The result is usually within ten percent; sharp edges can force more",
        default=RemeshOptions.quads,
        min=1,
        max=MOST_QUADS,
        soft_min=100,
        soft_max=100_000,
    )
    edge_length: bpy.props.FloatProperty(
        name="Edge Length",
        description="Length of the quads' edges, in the scene's units and with the object's scale counted in",
        default=0.1,
        min=1e-6,
        soft_max=10.0,
        precision=4,
        subtype="DISTANCE",
        unit="LENGTH",
    )
    use_sharp_angle: bpy.props.BoolProperty(
        name="Sharp Edges by Angle",
        description="Keep edges where the surface bends by more than the angle below",
        default=True,
    )
    sharp_angle: bpy.props.FloatProperty(
        name="Angle",
        description="Edges between faces whose directions differ by more than this stay sharp",
        default=math.radians(40.0),
        min=0.0,
        max=math.pi,
        subtype="ANGLE",
        unit="ROTATION",
    )
    use_marked_sharp: bpy.props.BoolProperty(
        name="Marked Sharp",
        description="Keep edges that are marked sharp (Edge > Mark Sharp), whatever their angle",
        default=True,
    )
    use_seams: bpy.props.BoolProperty(
        name="UV Seams",
        description="Keep edges that are marked as UV seams, and mark them as seams on the result",
        default=False,
    )
    use_feature_attribute: bpy.props.BoolProperty(
        name="Feature Attribute",
        description='Keep edges whose attribute "hybrid_quad_feature" (Boolean, edge domain) is true',
        default=True,
    )
    result_mode: bpy.props.EnumProperty(
        name="Result", description="Where the quads go", items=RESULT_MODES, default="NEW"
    )
    last_report: bpy.props.StringProperty(
        name="Last Report", description="Report of the latest run as JSON", options={"HIDDEN"}
    )


CLASSES = (HybridQuadSettings,)
