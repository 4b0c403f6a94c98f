"""One object's settings for all that are selected."""

from __future__ import annotations

import bpy
import pytest

from hybrid_quad.blender import presets
from scenes import activate, add_cube, add_grid, add_sphere


def values(obj: bpy.types.Object) -> dict[str, object]:
    found = {name: getattr(obj.hybrid_quad, name) for name in presets.setting_names() if name != "transfer"}
    return {name: tuple(value) if hasattr(value, "__len__") else value for name, value in found.items()}


def test_selected_objects_get_the_settings_of_the_active_one():
    left_out, other, obj = add_cube(), add_grid(), add_sphere()
    settings = obj.hybrid_quad
    settings.quads, settings.target_mode, settings.symmetry_axes = 777, "RATIO", (True, False, True)
    settings.guide_marks = {"SEAM", "SHARP"}
    settings.transfer.use_uv_maps = False
    settings.guide_object = left_out
    other.hybrid_quad.part.region = "MASK"
    before = values(left_out)
    assert values(other) != values(obj)
    activate(obj)
    other.select_set(True)
    assert bpy.ops.object.hybrid_quad_copy_settings() == {"FINISHED"}
    assert values(other) == values(obj) and not other.hybrid_quad.transfer.use_uv_maps
    assert values(left_out) == before and left_out.hybrid_quad.transfer.use_uv_maps
    # What is one object's own.
    assert other.hybrid_quad.guide_object is None and other.hybrid_quad.part.region == "MASK"


def test_with_one_object_there_is_nothing_to_copy_to():
    activate(add_sphere())
    with pytest.raises(RuntimeError, match="Select other mesh objects too"):
        bpy.ops.object.hybrid_quad_copy_settings()
