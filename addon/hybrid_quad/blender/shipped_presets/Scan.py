"""Scanned surfaces with noise: only clear edges are kept, and the field is smooth."""

import bpy

settings = bpy.context.object.hybrid_quad

settings.target_mode = "COUNT"
settings.quads = 10000
settings.use_sharp_angle = True
settings.sharp_angle = 1.0472  # 60 degrees
settings.adaptivity = 0.3
settings.field_smoothness = 0.8
settings.anisotropy = 1.0
settings.narrow_quads = 1
