"""Presets: those that the add-on brings, and the user's own."""

from __future__ import annotations

import bpy
import pytest

from hybrid_quad.blender import presets
from scenes import add_grid, add_sphere


def run_preset(path) -> None:
    assert bpy.ops.script.execute_preset(filepath=str(path), menu_idname="VIEW3D_PT_hybrid_quad_presets") == {
        "FINISHED"
    }


def values(obj: bpy.types.Object) -> dict[str, object]:
    found = {name: getattr(obj.hybrid_quad, name) for name in presets.setting_names() if name != "transfer"}
    return {name: tuple(value) if hasattr(value, "__len__") else value for name, value in found.items()}


def test_shipped_presets_set_the_active_object_only():
    other, obj = add_grid(), add_sphere()
    before = values(other)
    paths = sorted(presets.SHIPPED.glob("*.py"))
    assert [path.stem for path in paths] == ["CAD_Part", "Scan", "Sculpt"]
    seen = []
    for path in paths:
        run_preset(path)
        assert values(obj) not in seen
        seen.append(values(obj))
    assert values(other) == before


def test_shipped_presets_say_the_same_settings():
    texts = [path.read_text().splitlines() for path in presets.SHIPPED.glob("*.py")]
    named = [{line.split(" = ")[0] for line in lines if line.startswith("settings.")} for lines in texts]
    sculpt = {"settings.sharp_angle"}  # not used there
    assert all(one | sculpt == named[0] | sculpt for one in named)


def test_a_preset_of_the_user_is_kept_and_forgotten(tmp_path, monkeypatch):
    monkeypatch.setattr(bpy.utils, "user_resource", lambda *_args, path="", create=False: str(_made(tmp_path / path)))
    obj = add_sphere()
    obj.hybrid_quad.quads, obj.hybrid_quad.symmetry_axes = 777, (True, False, True)
    obj.hybrid_quad.guide_marks = {"SHARP"}
    obj.hybrid_quad.transfer.use_seams = False
    kept = values(obj)
    assert bpy.ops.object.hybrid_quad_preset_add(name="Mine") == {"FINISHED"}
    (path,) = tmp_path.rglob("Mine.py")
    other = add_grid()
    assert values(other) != kept
    run_preset(path)
    assert values(other) == kept and not other.hybrid_quad.transfer.use_seams
    # Blender itself looks in the user's folders alone.
    monkeypatch.setattr(bpy.utils, "preset_find", lambda *_args, **_kwargs: str(path))
    assert bpy.ops.object.hybrid_quad_preset_add(name="Mine", remove_name=True) == {"FINISHED"}
    assert not path.exists()


def _made(folder):
    folder.mkdir(parents=True, exist_ok=True)
    return folder


@pytest.mark.parametrize("name", ["guide_object", "last_report", "source_name"])
def test_what_belongs_to_one_object_is_in_no_preset(name):
    assert name not in presets.setting_names()
