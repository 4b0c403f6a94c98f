"""Smooth surfaces that were sculpted: few edges to keep, quads along the forms and smaller where these are small."""

import bpy

settings = bpy.context.object.hybrid_quad

settings.target_mode = "COUNT"
settings.quads = 8000
settings.use_sharp_angle = False
settings.adaptivity = 0.4
settings.field_smoothness = 0.4
settings.anisotropy = 1.0
settings.narrow_quads = 1
