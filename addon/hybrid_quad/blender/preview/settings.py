"""What is drawn over objects, for all windows; not saved with a file's objects."""

# No "from __future__ import annotations" here: Blender reads the properties from the annotations' values.

import bpy

from . import sessions


def _restart(_settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    sessions.follow_settings()


def _redraw(_settings: bpy.types.PropertyGroup, _context: bpy.types.Context) -> None:
    sessions.redraw()


class HybridQuadPreviewSettings(bpy.types.PropertyGroup):
    """Lives in the window manager, as ``window_manager.hybrid_quad_preview``."""

    show_field: bpy.props.BoolProperty(
        name="Preview",
        description="Draw over the active object what remeshing would follow, and again whenever it or its settings change",
        default=False,
        update=_restart,
    )
    show_crosses: bpy.props.BoolProperty(
        name="Field",
        description="A cross for about every quad: its arms are the directions and the size of the quad's edges",
        default=True,
        update=_redraw,
    )
    show_sizes: bpy.props.BoolProperty(
        name="Size",
        description="Color the crosses by the size of the quads: blue where they are small, red where they are large",
        default=True,
        update=_redraw,
    )
    show_singularities: bpy.props.BoolProperty(
        name="Singularities",
        description="Balls where three quads meet, cubes where five do",
        default=True,
        update=_redraw,
    )
    show_features: bpy.props.BoolProperty(
        name="Features", description="Lines that become chains of edges", default=True, update=_redraw
    )
    show_guides: bpy.props.BoolProperty(
        name="Guides", description="Painted directions and lines that quads follow", default=True, update=_redraw
    )
    show_quads: bpy.props.BoolProperty(
        name="Quad Lines",
        description="The edges of the quads before their number and shapes are improved. Takes two or three times as long",
        default=False,
        update=_restart,
    )
    show_limit: bpy.props.BoolProperty(
        name="Limit Surface",
        description="Draw the surface that endless subdivision would make of the active object's quads, with creases on its "
        "features, colored by the distance to the object that they were made of",
        default=False,
        update=_restart,
    )
    limit_levels: bpy.props.IntProperty(
        name="Levels",
        description="How finely the limit surface is drawn: each level makes four faces of a quad",
        default=2,
        min=1,
        max=4,
        update=_restart,
    )


CLASSES = (HybridQuadPreviewSettings,)
