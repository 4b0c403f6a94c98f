"""Parts with flat sides and true creases: every crease is kept, few irregular vertices between them."""

import bpy

settings = bpy.context.object.hybrid_quad

settings.target_mode = "COUNT"
settings.quads = 4000
settings.use_sharp_angle = True
settings.sharp_angle = 0.5236  # 30 degrees
settings.adaptivity = 0.2
settings.field_smoothness = 0.7
settings.anisotropy = 1.0
settings.narrow_quads = 2
