"""Everything that knows Blender: settings, operator, panel, and the way between Blender's meshes and arrays."""
