"""Prints the name of a Blender file's active mesh object, or of its first one, as "object: NAME"."""

import sys

import bpy

active = bpy.context.view_layer.objects.active
candidates = ([active] if active else []) + sorted(bpy.context.view_layer.objects, key=lambda each: each.name)
names = [each.name for each in candidates if each.type == "MESH"]
if not names:
    sys.exit("error: no mesh object in this file")
print(f"object: {names[0]}")
