"""The add-on comes and goes without a trace."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import bpy
import pytest

import hybrid_quad
from hybrid_quad.blender import command, panels, registration
from hybrid_quad.blender.painting import paint_tool, stroke_view
from hybrid_quad.blender.panel_base import lines_of
from scenes import add_cube


def _traces() -> list[str]:
    names = [name for name in dir(bpy.types) if "hybrid_quad" in name.lower()]
    names += [name for owner in (bpy.types.Object, bpy.types.WorkSpace) for name in dir(owner) if "hybrid_quad" in name]
    names += ["tool" for tool in paint_tool.TOOLS if hasattr(tool, "_bl_tool")]
    names += ["drawing"] * len(stroke_view._handles)
    for name in dir(bpy.app.handlers):
        handlers = getattr(bpy.app.handlers, name)
        if isinstance(handlers, list):
            names += [f"{name} {each.__name__}" for each in handlers if "hybrid_quad" in each.__module__]
    for owner in (bpy.types.VIEW3D_MT_object, bpy.types.DATA_PT_remesh, panels.VIEW3D_PT_hybrid_quad_guides):
        added = getattr(owner.draw, "_draw_funcs", [])
        names += [f.__name__ for f in added if "hybrid_quad" in f.__module__ and f.__name__ != "draw"]
    names += [name for name in dir(bpy.ops.object) if "hybrid_quad" in name] + dir(bpy.ops.hybrid_quad)
    return names + ["command"] * len(command._handles)


def test_disabling_leaves_nothing_behind():
    assert _traces()
    hybrid_quad.unregister()
    assert _traces() == []


def test_twenty_times_on_and_off():
    once = sorted(_traces())
    for _ in range(20):
        hybrid_quad.unregister()
        hybrid_quad.register()
    assert sorted(_traces()) == once


def test_enabling_twice_is_enabling_once():
    once = sorted(_traces())
    hybrid_quad.register()
    assert sorted(_traces()) == once
    hybrid_quad.unregister()
    assert _traces() == []


def test_every_property_has_a_tooltip():
    for cls in registration.CLASSES:
        for prop in cls.bl_rna.properties:
            if prop.identifier in getattr(cls, "__annotations__", {}):
                assert len(prop.description) > 10, f"{cls.__name__}.{prop.identifier}"


def test_the_tooltip_of_a_number_says_what_it_counts():
    """In words, beside what Blender itself shows with a unit: lengths and angles."""
    words = ("number", "quads", "pixels", "seconds", "megabytes", "rows", "times", "level", "(0)", "world space")
    numbers = 0
    for cls in registration.CLASSES:
        for prop in cls.bl_rna.properties:
            if prop.type not in ("INT", "FLOAT") or prop.identifier not in getattr(cls, "__annotations__", {}):
                continue
            numbers += 1
            text = prop.description.lower()
            is_shown = prop.type == "FLOAT" and prop.unit in ("LENGTH", "ROTATION")
            assert is_shown or any(word in text for word in words), f"{cls.__name__}.{prop.identifier}: {text}"
    assert numbers > 15


def test_every_operator_has_a_tooltip_without_a_full_stop():
    for cls in registration.CLASSES:
        if issubclass(cls, bpy.types.Operator):
            space, _, word = cls.bl_idname.partition(".")
            text = getattr(getattr(bpy.ops, space), word).get_rna_type().description
            assert len(text) > 20 and not text.endswith("."), cls.bl_idname


@pytest.mark.parametrize("state", ["nothing is active", "Edit Mode"])
def test_every_disabled_operator_says_why(state):
    if state == "Edit Mode":
        add_cube()
        bpy.ops.object.mode_set(mode="EDIT")
    operators = [cls.bl_idname for cls in registration.CLASSES if issubclass(cls, bpy.types.Operator)]
    disabled = 0
    for name in operators:
        space, _, word = name.partition(".")
        operator = getattr(getattr(bpy.ops, space), word)
        if operator.poll():
            continue
        disabled += 1
        with pytest.raises(RuntimeError) as caught:
            operator()
        assert "context is incorrect" not in str(caught.value), name
    assert disabled >= 5


def test_settings_belong_to_the_object():
    first = bpy.data.objects.new("First", bpy.data.meshes.new("M"))
    second = bpy.data.objects.new("Second", first.data)
    first.hybrid_quad.quads = 123
    assert second.hybrid_quad.quads == 5000


def test_the_manifest_tells_the_same_version():
    manifest = Path(hybrid_quad.__file__).with_name("blender_manifest.toml").read_text()
    assert f'version = "{hybrid_quad.__version__}"' in manifest


def test_long_texts_of_panels_are_broken_into_lines():
    text = "The compiled part is missing: install the zip for this Blender and system"
    lines = lines_of(text, "ERROR")
    assert len(lines) > 2 and " ".join(lines) == text and max(map(len, lines)) <= 26
    assert len(lines_of(text, share=0.5)) > len(lines)


@pytest.mark.skipif(bool(bpy.app.binary_path), reason="Blender as a module")
@pytest.mark.skipif(
    bpy.app.version < (4, 5),
    reason="the module of 4.2 crashes as it ends once a few classes were registered, whatever is taken away",
)
def test_a_script_that_ends_registered_ends_well():
    """Some Blenders crash as they end, where a class is left."""
    folder = str(Path(hybrid_quad.__file__).parents[1])
    script = f"import sys; sys.path.insert(0, {folder!r}); import bpy, hybrid_quad; hybrid_quad.register()"
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, timeout=120, check=False)
    assert ended.returncode == 0, ended.stderr[-2000:]
