"""Settings of an object's remeshing; they are saved with the object."""

# No "from __future__ import annotations" here: Blender reads the properties from the annotations' values.

import math

import bpy

from ..core.options import AXES, MOST_QUADS, RemeshOptions
from . import part_properties
from .edge_marks import SOURCES
from .overridable import overridable
from .transfer.kinds import KINDS

TARGET_MODES = (
    ("COUNT", "Quad Count", "Say how many quads the result should have"),
    ("RATIO", "Ratio", "Say how many quads the result should have for each face of the mesh"),
    ("LENGTH", "Edge Length", "Say how long the quads' edges should be"),
    ("CHORD", "Chord Error", "Say how far the quads may be from the surface"),
)
# What says the size in each of them.
SIZE_SETTINGS = {"COUNT": "quads", "RATIO": "ratio", "LENGTH": "edge_length", "CHORD": "chord_error"}
RESULT_MODES = (
    ("NEW", "New Object", "Put the quads in a new object; this one stays as it is, hidden in viewports and renders"),
    (
        "REPLACE",
        "Replace Mesh",
        "Put the quads in this object. Visible modifiers are applied. Other users of the mesh keep the old one",
    ),
)


GUIDE_KINDS = (
    ("DIRECTION", "Direction", "Quads near the lines turn along them"),
    ("LOOP", "Loop", "Each line becomes a connected chain of edges"),
    ("RING", "Ring", "Each line crosses edges at right angles through their middles"),
)
STRENGTH = {"default": 1.0, "min": 0.0, "max": 1.0, "subtype": "FACTOR"}
NUMBERS = {
    name: getattr(RemeshOptions, name, neutral)
    for name, neutral in (("adaptivity", 0.0), ("field_smoothness", 1.0), ("anisotropy", 1.0), ("narrow_quads", 2))
}


@overridable
class HybridQuadTransferSettings(bpy.types.PropertyGroup):
    """What a result takes along; lives on every object as ``object.hybrid_quad.transfer``."""

    __annotations__ = {
        kind.setting: bpy.props.BoolProperty(name=kind.label, description=kind.description, default=True)
        for kind in KINDS
    }


@overridable
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
    ratio: bpy.props.FloatProperty(
        name="Ratio",
        description="Number of quads to aim at for each face that is remeshed, counted with visible modifiers applied",
        default=0.5,
        min=1e-5,
        soft_min=0.01,
        soft_max=4.0,
        precision=3,
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
    chord_error: bpy.props.FloatProperty(
        name="Chord Error",
        description="Largest distance between quads and the surface to aim at, in the scene's units and with the object's scale "
        "counted in. Small quads where it bends, large ones elsewhere",
        default=0.01,
        min=1e-7,
        soft_max=1.0,
        precision=5,
        subtype="DISTANCE",
        unit="LENGTH",
    )
    narrow_quads: bpy.props.IntProperty(
        name="Narrow Parts",
        description="Rows of quads that strips between two kept edges get at least, however narrow",
        default=NUMBERS["narrow_quads"],
        min=1,
        max=2,
    )
    fit_limit_surface: bpy.props.BoolProperty(
        name="Fit Limit Surface",
        description="Move vertices so that a Subdivision Surface modifier puts the surface where it was. Kept edges and corners "
        "get creases",
        default=False,
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
        description="Keep edges that are marked sharp (Edge > Mark Sharp), whatever their angle. Edges at which custom normals "
        "break are, too",
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
    use_creases: bpy.props.BoolProperty(
        name="Creases",
        description="Keep edges that have a crease for subdivision surfaces, and give the result's the same crease",
        default=False,
    )
    use_bevel_weights: bpy.props.BoolProperty(
        name="Bevel Weights",
        description="Keep edges that have a bevel weight, and give the result's the same weight",
        default=False,
    )
    use_freestyle_marks: bpy.props.BoolProperty(
        name="Freestyle Marks",
        description="Keep edges that are marked for Freestyle, and mark them on the result",
        default=False,
    )
    use_material_borders: bpy.props.BoolProperty(
        name="Material Borders", description="Keep edges between faces of different material slots", default=False
    )
    use_face_set_borders: bpy.props.BoolProperty(
        name="Face Set Borders",
        description="Keep edges between the face sets of Sculpt Mode (from Blender 3.5 on)",
        default=False,
    )
    use_uv_borders: bpy.props.BoolProperty(
        name="UV Island Borders",
        description="Keep edges at which the active UV map is cut",
        default=False,
    )
    use_guide_attribute: bpy.props.BoolProperty(
        name="Guide Attribute",
        description='Let quads follow the directions in the attribute "hybrid_quad_guide" (vector, points or faces)',
        default=True,
    )
    guide_marks: bpy.props.EnumProperty(
        name="Guide Edges",
        description="Let quads follow these edges without keeping them. Edges that are kept need no guide",
        items=tuple(
            (source.identifier, source.label, f"Follow edges: {source.label.lower()}", 1 << index)
            for index, source in enumerate(SOURCES)
        ),
        options={"ENUM_FLAG"},
        default=set(),
    )
    guide_marks_strength: bpy.props.FloatProperty(
        name="Edge Strength",
        description="How strongly quads follow guide edges, from not at all (0) to fully (1)",
        **STRENGTH,
    )
    # No poll, which would crash Blender 4.2 as it exits.
    guide_object: bpy.props.PointerProperty(
        type=bpy.types.Object,
        name="Guide Object",
        description="Curve, grease pencil or mesh edges on or near the surface, which quads follow",
    )
    guide_collection: bpy.props.PointerProperty(
        type=bpy.types.Collection,
        name="Guide Collection",
        description="Quads follow all curves and grease pencils of this collection",
    )
    guide_objects_kind: bpy.props.EnumProperty(
        name="Kind",
        description="What guide objects are for, where their own property hybrid_quad_guide_kind does not say otherwise",
        items=GUIDE_KINDS,
        default="DIRECTION",
    )
    guide_objects_strength: bpy.props.FloatProperty(
        name="Object Strength",
        description="How strongly quads follow guide objects, from not at all (0) to fully (1)",
        **STRENGTH,
    )
    use_guide_annotations: bpy.props.BoolProperty(
        name="Annotations",
        description="Let quads follow the scene's visible annotation strokes of this frame (draw them on the surface)",
        default=False,
    )
    guide_annotations_kind: bpy.props.EnumProperty(
        name="Kind", description="What annotation strokes are for", items=GUIDE_KINDS, default="DIRECTION"
    )
    guide_annotations_strength: bpy.props.FloatProperty(
        name="Annotation Strength",
        description="How strongly quads follow annotation strokes, from not at all (0) to fully (1)",
        **STRENGTH,
    )
    guide_radius: bpy.props.FloatProperty(
        name="Radius",
        description="How far guide edges, objects and annotations act, counted in quads",
        default=2.0,
        min=0.1,
        soft_max=10.0,
    )
    use_density_attribute: bpy.props.BoolProperty(
        name="Density Attribute",
        description='Make quads smaller where the attribute "hybrid_quad_density" (float, points) is more than 1',
        default=True,
    )
    use_painted_lines: bpy.props.BoolProperty(
        name="Painted Lines",
        description="Let quads follow or cross the loops and rings painted on this object (curve objects that are its children)",
        default=True,
    )
    adaptivity: bpy.props.FloatProperty(
        name="Adaptivity",
        description="From quads of one size (0) to smaller ones where the surface bends (1), with a third to twice the usual edge",
        default=NUMBERS["adaptivity"],
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    field_smoothness: bpy.props.FloatProperty(
        name="Smoothness",
        description="From following the surface's detail (0) to the fewest irregular vertices (1)",
        default=NUMBERS["field_smoothness"],
        min=0.0,
        max=1.0,
        subtype="FACTOR",
    )
    anisotropy: bpy.props.FloatProperty(
        name="Stretch",
        description="How many times longer than wide quads may be, along directions in which the surface bends less. 1: squares",
        default=NUMBERS["anisotropy"],
        min=1.0,
        soft_max=4.0,
        max=10.0,
    )
    symmetry_axes: bpy.props.BoolVectorProperty(
        name="Mirror",
        description="Make the result exactly symmetric along these axes of the object, about its origin. The positive "
        "side is kept and mirrored, with a loop of edges between",
        size=3,
        subtype="XYZ",
        default=(False, False, False),
    )
    use_auto_symmetry: bpy.props.BoolProperty(
        name="Auto",
        description="Mirror along those axes along which the object itself is symmetric. The last result says how far it "
        "is from that",
        default=False,
    )
    transfer: bpy.props.PointerProperty(
        type=HybridQuadTransferSettings, name="Transfer", description="What the result takes along"
    )
    part: bpy.props.PointerProperty(
        type=part_properties.HybridQuadPartSettings, name="Region", description="Which faces are remeshed"
    )
    result_mode: bpy.props.EnumProperty(
        name="Result", description="Where the quads go", items=RESULT_MODES, default="NEW"
    )
    time_limit: bpy.props.FloatProperty(
        name="Time",
        description="End a run that takes more seconds than this, and leave everything as it is. 0: no limit",
        default=0.0,
        min=0.0,
        soft_max=3600.0,
        precision=2,  # with less, 90 seconds read as 2 minutes
        step=1000,
        subtype="TIME_ABSOLUTE",
        unit="TIME_ABSOLUTE",
    )
    memory_limit: bpy.props.IntProperty(
        name="Memory (MB)",
        description="End a run whose process needs more megabytes of memory than this, and leave everything as it is. 0: no limit",
        default=0,
        min=0,
        soft_max=65536,
    )
    last_report: bpy.props.StringProperty(
        name="Last Report", description="Report of the latest run as JSON", options={"HIDDEN"}
    )
    source_name: bpy.props.StringProperty(
        name="Made Of",
        description="Object that these quads were made of: their subdivision surface is compared with it",
    )
    last_check: bpy.props.StringProperty(
        name="Last Check", description="What the latest check found, as JSON", options={"HIDDEN"}
    )

    @property
    def symmetry(self) -> str:
        """The option ``symmetry`` of a run."""
        if self.use_auto_symmetry:
            return "auto"
        return "".join(letter for letter, is_used in zip(AXES, self.symmetry_axes, strict=True) if is_used)


CLASSES = (HybridQuadTransferSettings, *part_properties.CLASSES, HybridQuadSettings)
