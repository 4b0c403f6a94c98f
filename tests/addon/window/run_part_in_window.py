"""Part of a mesh, and several objects, in a real window: from Edit Mode, in one undo step, by worker processes.

    xvfb-run -a -s "-screen 0 1600x1000x24" \\
        blender --factory-startup --enable-event-simulate -P run_part_in_window.py -- [FOLDER]

Ends Blender with status 0 or 1. FOLDER receives pictures of the window.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import bmesh
import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

from run_in_window import drawn, expect, in_view, main, press, show_sidebar_tab, take_picture, until_finished, watched
from run_worker_in_window import expect_said, said

import hybrid_quad
from hybrid_quad.blender import background_run, panels, task_solving
from scenes import activate, add_grid, add_sphere

CELLS, FACES = 16, 256


def steps() -> Iterator[float]:
    """The test; every number is a pause in seconds, in which Blender handles events."""
    for cls in panels.CLASSES:
        is_open = cls in (panels.VIEW3D_PT_hybrid_quad, panels.VIEW3D_PT_hybrid_quad_part)
        cls.bl_options = set() if is_open else {"DEFAULT_CLOSED"}
        cls.draw = watched(cls.draw, cls.__name__)
    hybrid_quad.register()
    yield from new_scene()
    yield from show_sidebar_tab()
    for test in (from_edit_mode, edited_meanwhile, several_objects, several_ended_by_escape):
        print(f"-- {test.__name__.replace('_', ' ')}", flush=True)
        yield from new_scene()
        yield from test()
        expect(background_run.current() is None, "no run is left")
    hybrid_quad.unregister()
    yield 0.3


def from_edit_mode() -> Iterator[float]:
    grid = bpy.data.objects["Grid"]
    yield from choose(grid)
    with in_view():
        bpy.ops.ed.undo_push(message="chosen")
        expect(bpy.ops.object.hybrid_quad_remesh("INVOKE_DEFAULT") == {"RUNNING_MODAL"}, "a run begins in Edit Mode")
    yield from until_finished()
    grid = bpy.data.objects["Grid"]
    expect(bpy.context.mode == "EDIT_MESH", "the object is in Edit Mode as before")
    expect(faces_in_edit_mode(grid) != FACES, f"the faces are others: {faces_in_edit_mode(grid)}")
    expect("VIEW3D_PT_hybrid_quad_part" in drawn, "the panel is drawn")
    yield 0.5
    yield from take_picture("7_part.png")
    done = faces_in_edit_mode(grid)
    with in_view():
        bpy.ops.ed.undo()
    yield 0.3
    grid = bpy.data.objects["Grid"]
    expect(bpy.context.mode == "EDIT_MESH", "after one undo it is so still")
    expect(faces_in_edit_mode(grid) == FACES, "and has its faces again")
    with in_view():
        bpy.ops.ed.redo()
    yield 0.3
    expect(faces_in_edit_mode(bpy.data.objects["Grid"]) == done, "redo brings the new ones")


def edited_meanwhile() -> Iterator[float]:
    grid = bpy.data.objects["Grid"]
    yield from choose(grid)
    with in_view():
        bpy.ops.object.hybrid_quad_remesh("INVOKE_DEFAULT")
        edited = bmesh.from_edit_mesh(grid.data)
        edited.verts.ensure_lookup_table()
        edited.verts[0].co.z += 1.0
        bmesh.update_edit_mesh(grid.data)
    yield from until_finished()
    expect(faces_in_edit_mode(grid) == FACES, "an edited mesh is left alone")
    expect_said("was edited during the run")
    press("ESC")  # the message
    yield 0.3


def several_objects() -> Iterator[float]:
    both = select_both()
    with in_view():
        expect(bpy.ops.object.hybrid_quad_remesh_selected("INVOKE_DEFAULT") == {"RUNNING_MODAL"}, "runs begin")
    yield from until_all_finished()
    results = [f"{name} Quads" for name in both]
    expect(all(name in bpy.data.objects for name in results), "both have results")
    expect(sorted(obj.name for obj in bpy.context.selected_objects) == results, "which are selected")
    with in_view():
        bpy.ops.ed.undo()
    yield 0.3
    expect(sorted(bpy.data.objects.keys()) == both, "one undo takes both away")


def several_ended_by_escape() -> Iterator[float]:
    both = select_both()
    for name in both:
        bpy.data.objects[name].hybrid_quad.quads = 150_000
    with in_view():
        bpy.ops.object.hybrid_quad_remesh_selected("INVOKE_DEFAULT")
    yield 1.0
    press("ESC")
    yield from until_all_finished()
    expect(sorted(bpy.data.objects.keys()) == both, "nothing comes of either")
    expect_said("was cancelled")


def choose(obj: bpy.types.Object) -> Iterator[float]:
    """Enters Edit Mode with the middle of a grid selected, to be remeshed in place by smaller quads."""
    settings = obj.hybrid_quad
    settings.part.region, settings.result_mode = "SELECTED", "REPLACE"
    settings.part.use_border_length, settings.quads = False, 150
    with in_view():
        activate(obj)
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_mode(type="FACE")
        edited = bmesh.from_edit_mesh(obj.data)
        for face in edited.faces:
            center = face.calc_center_median()
            face.select_set(abs(center.x) < 0.5 and abs(center.y) < 0.5)
        bmesh.update_edit_mesh(obj.data)
    yield 0.3


def faces_in_edit_mode(obj: bpy.types.Object) -> int:
    return len(bmesh.from_edit_mesh(obj.data).faces)


def select_both() -> list[str]:
    with in_view():
        for obj in bpy.data.objects:
            obj.hybrid_quad.quads = 200
            obj.select_set(True)
    return sorted(bpy.data.objects.keys())


def until_all_finished() -> Iterator[float]:
    """Between two runs there is none for a moment."""
    yield from until_finished()
    yield from until_finished()
    yield 0.3


def new_scene() -> Iterator[float]:
    """A grid, and a sphere."""
    task_solving.forget_results()
    with in_view():
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for obj in list(bpy.data.objects):
            bpy.data.objects.remove(obj)
        add_sphere().location.y = 3
        activate(add_grid(cells=CELLS))
        bpy.ops.ed.undo_push(message="scene")
    said()
    yield 0.3


if __name__ == "__main__":
    main(steps())
