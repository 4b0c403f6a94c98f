"""The method for numpy arrays and mesh files; nothing in this folder imports ``bpy``."""
