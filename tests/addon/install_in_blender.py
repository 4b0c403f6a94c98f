"""Installs a zip of the add-on into this Blender as a person does, and tries it; run by test_install.py.

    blender -b --factory-startup --python-exit-code 1 -P install_in_blender.py -- ZIP legacy|extension works|native_part_missing
    python install_in_blender.py ZIP ...                                              with the package bpy from PyPI

Blender's own folders are those that BLENDER_USER_RESOURCES and the like name: temporary ones.
"""

from __future__ import annotations

import importlib
import os
import sys
from collections import Counter
from pathlib import Path

import bpy

TIMES = 20
MODEL = Path(__file__).resolve().parents[2] / "blend_samples" / "cad_part.blend"


class Registered:
    """Counts what Blender cannot list: timers and functions that draw."""

    def __init__(self) -> None:
        self.timers: set = set()
        self.drawings: set = set()
        for name in dir(bpy.types):
            if name.startswith("Space") and name != "Space" and hasattr(getattr(bpy.types, name), "draw_handler_add"):
                self._watch_drawings(getattr(bpy.types, name))
        assert bpy.types.SpaceView3D.draw_handler_add.__qualname__.startswith("Registered")
        self._watch_timers()

    def _watch_drawings(self, space) -> None:
        add, remove = space.draw_handler_add, space.draw_handler_remove

        def added(*args, **kwargs):
            handle = add(*args, **kwargs)
            self.drawings.add(handle)
            return handle

        def removed(handle, *args):
            remove(handle, *args)
            self.drawings.discard(handle)

        space.draw_handler_add, space.draw_handler_remove = staticmethod(added), staticmethod(removed)

    def _watch_timers(self) -> None:
        register = bpy.app.timers.register

        def registered(function, **kwargs):
            self.timers.add(function)
            return register(function, **kwargs)

        bpy.app.timers.register = registered

    def left(self) -> list[str]:
        running = [function for function in self.timers if bpy.app.timers.is_registered(function)]
        return [f"timer {function.__name__}" for function in running] + ["drawing"] * len(self.drawings)


def state(registered: Registered) -> dict[str, list[str]]:
    """Everything that an add-on can leave in Blender, by kind."""
    keymaps = [
        f"{configuration.name}: {keymap.name}: {item.idname} {item.type}"
        for configuration in bpy.context.window_manager.keyconfigs
        for keymap in configuration.keymaps
        for item in keymap.keymap_items
    ]
    handlers = [
        f"{name}: {function.__module__}.{function.__name__}"
        for name in dir(bpy.app.handlers)
        if isinstance(getattr(bpy.app.handlers, name), list)
        for function in getattr(bpy.app.handlers, name)
    ]
    menus = [
        f"{name}: {function.__module__}"
        for name in dir(bpy.types)
        for function in getattr(getattr(getattr(bpy.types, name), "draw", None), "_draw_funcs", ())
        if not function.__module__.startswith(
            "bl_ui."
        )  # Blender's own stays in a list that it makes for the first entry
    ]
    properties = [
        f"{name}.{prop}"
        for name in dir(bpy.types)
        for prop in getattr(getattr(getattr(bpy.types, name), "bl_rna", None), "properties", {}).keys()  # noqa: SIM118
    ]
    toolbars = [bpy.types.VIEW3D_PT_tools_active, bpy.types.IMAGE_PT_tools_active]
    tools = [
        f"{toolbar.__name__} {mode}: {getattr(tool, 'idname', tool)}"
        for toolbar in toolbars
        for mode, entries in toolbar.tools_all()
        for tool in toolbar._tools_flatten(entries)
    ]
    operators = [f"{space}.{name}" for space in dir(bpy.ops) for name in dir(getattr(bpy.ops, space))]
    return {
        "types": sorted(dir(bpy.types)),
        "properties": sorted(properties),
        "operators": sorted(operators),
        "keymaps": sorted(keymaps),
        "handlers": sorted(handlers),
        "menus": sorted(menus),
        "tools": sorted(tools),
        "timers and drawings": registered.left(),
    }


def install(path: str, kind: str) -> str:
    """Installs the zip; the name of the add-on's module."""
    if kind == "legacy":
        bpy.ops.preferences.addon_install(filepath=path, overwrite=True)
        return "hybrid_quad"
    done = bpy.ops.extensions.package_install_files(filepath=path, repo="user_default", enable_on_install=False)
    assert done == {"FINISHED"}, done
    return "bl_ext.user_default.hybrid_quad"


def enable(name: str) -> None:
    assert bpy.ops.preferences.addon_enable(module=name) == {"FINISHED"}


def disable(name: str) -> None:
    assert bpy.ops.preferences.addon_disable(module=name) == {"FINISHED"}


def difference(before: dict[str, list[str]], after: dict[str, list[str]]) -> dict[str, list[str]]:
    return {
        kind: sorted(set(after[kind]) ^ set(before[kind])) for kind in before if sorted(after[kind]) != before[kind]
    }


def on_and_off(name: str, before: dict[str, list[str]], registered: Registered) -> None:
    """Twenty times; nothing is left behind, and from the first time on no module is added."""
    modules: set[str] = set()
    for time in range(TIMES):
        enable(name)
        assert hasattr(bpy.types.Object, "hybrid_quad")
        disable(name)
        if time == 0:
            modules = set(sys.modules)
    left = difference(before, state(registered))
    assert not left, left
    assert set(sys.modules) == modules, set(sys.modules) ^ modules


def remesh_cube(name: str) -> None:
    """By the operator, and by a worker process, which has to find the compiled part by itself."""
    bpy.ops.mesh.primitive_cube_add(size=2)
    settings = bpy.context.object.hybrid_quad
    settings.target_mode, settings.quads = "COUNT", 150
    assert bpy.ops.object.hybrid_quad_remesh() == {"FINISHED"}
    quads = bpy.context.object.data.polygons
    assert 75 < len(quads) < 300, len(quads)
    assert {len(quad.vertices) for quad in quads} == {4}

    bpy.ops.mesh.primitive_cube_add(size=2)
    bpy.context.object.hybrid_quad.quads = 150
    task = importlib.import_module(f"{name}.blender.remesh_task")
    background = importlib.import_module(f"{name}.blender.background_run")
    depsgraph = bpy.context.evaluated_depsgraph_get()
    run = background.start(task.prepare_task(bpy.context.object, depsgraph), bpy.context.object)
    result = run.result()
    background.forget()
    assert result.quads.shape[1] == 4 and len(result.quads) == len(quads)


def remesh_model() -> None:
    """A CAD part of a file made by Blender 3.4: its quads are a closed surface with as many handles as it has."""
    bpy.ops.wm.open_mainfile(filepath=str(MODEL), load_ui=False)
    source = bpy.context.view_layer.objects.active
    topology = euler_characteristic(source.data)
    assert bpy.ops.object.hybrid_quad_remesh() == {"FINISHED"}
    result = bpy.context.view_layer.objects.active
    assert result is not source and {len(quad.vertices) for quad in result.data.polygons} == {4}
    assert euler_characteristic(result.data) == topology
    assert not result.data.validate(), "Blender had to correct the mesh"
    print(f"REMESHED {MODEL.name}: {len(result.data.polygons)} quads")


def euler_characteristic(mesh: bpy.types.Mesh) -> int:
    """V - E + F of a closed surface: each edge belongs to two faces that run along it in opposite directions."""
    ways = Counter(
        (face.vertices[corner - 1], face.vertices[corner])
        for face in mesh.polygons
        for corner in range(len(face.vertices))
    )
    assert set(ways.values()) == {1} and all(way[::-1] in ways for way in ways)
    assert len({vertex for way in ways for vertex in way}) == len(mesh.vertices)
    return len(mesh.vertices) - len(ways) // 2 + len(mesh.polygons)


def without_compiled_part(name: str) -> None:
    """The add-on can be enabled, says what is missing, and changes nothing."""
    native = importlib.import_module(f"{name}.core.native")
    assert not native.is_there()
    bpy.ops.mesh.primitive_cube_add(size=2)
    before = len(bpy.data.objects), len(bpy.context.object.data.polygons)
    try:
        bpy.ops.object.hybrid_quad_remesh()
    except RuntimeError as error:
        assert "compiled part is missing" in str(error), error
    else:
        raise AssertionError("remeshed by nothing")
    assert (len(bpy.data.objects), len(bpy.context.object.data.polygons)) == before
    try:
        native.load()
    except ImportError as error:
        assert "install the zip for this version of Blender" in str(error), error
    else:
        raise AssertionError("loaded nothing")


def main() -> None:
    path, kind, case = sys.argv[-3:]
    registered = Registered()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    before = state(registered)
    name = install(path, kind)
    if case == "works":
        on_and_off(name, before, registered)
        enable(name)
        remesh_cube(name)
        remesh_model()
    else:
        enable(name)
        without_compiled_part(name)
    module = Path(sys.modules[name].__file__)
    assert module.is_relative_to(os.environ["HQ_USER_FOLDER"]), module
    disable(name)
    left = difference(before, state(registered))
    assert not left, left
    print("INSTALLED", case)


if __name__ == "__main__":
    main()
    if not bpy.app.binary_path:
        # As a Python module Blender can crash while Python winds down.
        sys.stdout.flush()
        os._exit(0)
