"""Settings that say which part of a mesh is remeshed."""

# No "from __future__ import annotations" here: Blender reads the properties from the annotations' values.

import bpy

from .overridable import overridable

REGIONS = (
    ("WHOLE", "Whole Mesh", "Remesh all faces, with visible modifiers applied"),
    ("SELECTED", "Selected", "Remesh the faces that are selected in Edit Mode"),
    ("VISIBLE", "Visible", "Remesh the faces that are not hidden in Edit Mode or Sculpt Mode"),
    ("FACE_SET", "Face Set", "Remesh one face set of Sculpt Mode (from Blender 3.5 on)"),
    ("MASK", "Mask", "Remesh the faces whose vertices are masked in Sculpt Mode by half or more"),
    ("ATTRIBUTE", "Attribute", "Remesh the faces at which a Boolean attribute of faces is true"),
)
ODD_BORDERS = (
    ("REFUSE", "Refuse", "Say where a border has an odd number of edges, which quads cannot fill"),
    ("GROW", "Grow", "Remesh one triangle more, beside each border with an odd number of edges"),
    ("SHRINK", "Shrink", "Remesh one triangle less, at each border with an odd number of edges"),
)


@overridable
class HybridQuadPartSettings(bpy.types.PropertyGroup):
    """Which faces are remeshed; lives on every object as ``object.hybrid_quad.part``."""

    region: bpy.props.EnumProperty(
        name="Region",
        description="Which faces are remeshed. All others stay exactly as they are, and quads join them edge to edge",
        items=REGIONS,
        default="WHOLE",
    )
    use_inverted: bpy.props.BoolProperty(name="Invert", description="Remesh all faces but these", default=False)
    face_set: bpy.props.IntProperty(
        name="Face Set", description="Number of the face set that is remeshed", default=1, min=0
    )
    attribute: bpy.props.StringProperty(
        name="Attribute", description="Name of a Boolean attribute of faces that is true where faces are remeshed"
    )
    use_border_length: bpy.props.BoolProperty(
        name="Size of Border",
        description="Quads as large as the edges between the region and the rest are long, whatever the target says",
        default=True,
    )
    odd_border: bpy.props.EnumProperty(
        name="Odd Borders",
        description="What is done where a border has an odd number of edges, which quads cannot fill",
        items=ODD_BORDERS,
        default="REFUSE",
    )


CLASSES = (HybridQuadPartSettings,)
