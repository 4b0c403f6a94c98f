"""A fresh scene and a registered add-on for every test."""

from __future__ import annotations

import bpy
import pytest

import hybrid_quad


@pytest.fixture(autouse=True)
def fresh_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    hybrid_quad.register()
    yield
    hybrid_quad.unregister()


@pytest.fixture
def scene_state():
    """A function that describes everything a refused or cancelled run must leave alone."""
    return _scene_state


def _scene_state():
    bpy.context.view_layer.update()
    objects = {
        obj.name: (
            obj.data and obj.data.name,
            obj.hide_get(),
            obj.hide_render,
            obj.select_get(),
            [m.name for m in obj.modifiers],
        )
        for obj in bpy.data.objects
    }
    meshes = {
        mesh.name: (mesh.users, [tuple(v.co) for v in mesh.vertices], [tuple(p.vertices) for p in mesh.polygons])
        for mesh in bpy.data.meshes
    }
    active = bpy.context.view_layer.objects.active
    return objects, meshes, active.name if active else None
