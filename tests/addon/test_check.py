"""The check of a mesh: a list of defects, and their elements selected."""

from __future__ import annotations

import json
from collections import Counter

import bpy
import pytest

from hybrid_quad.blender.check_operators import read_check
from scenes import activate, add_object, add_sphere, remesh

TETRAHEDRON = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]


def _codes(obj: bpy.types.Object) -> dict[str, int]:
    return {row["code"]: row["elements"] for row in read_check(obj)}


def _with_fin() -> bpy.types.Object:
    """A tetrahedron with a third face on the edge of vertices 1 and 2."""
    return add_object("Fin", [*CORNERS, (2, 2, 0)], [*TETRAHEDRON, (1, 2, 4)])


def test_a_sound_mesh_has_an_empty_list():
    obj = add_sphere()
    assert read_check(obj) is None
    assert bpy.ops.object.hybrid_quad_check() == {"FINISHED"}
    assert read_check(obj) == []


def test_defects_are_listed_with_counts_and_what_becomes_of_them():
    obj = _with_fin()
    bpy.ops.object.hybrid_quad_check()
    assert _codes(obj)["non_manifold_edge"] == 1
    assert all(row["repairable"] for row in read_check(obj))


def test_what_would_be_refused_is_listed_too():
    obj = add_object("Flat", [(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])
    bpy.ops.object.hybrid_quad_check()
    assert [row["code"] for row in read_check(obj) if not row["repairable"]] == ["no_area"]


def test_a_loose_edge_is_found():
    mesh = bpy.data.meshes.new("Loose")
    mesh.from_pydata([*CORNERS, (3, 3, 3), (4, 3, 3)], [(4, 5)], TETRAHEDRON)
    obj = add_object("Loose", CORNERS, TETRAHEDRON)
    obj.data = mesh
    bpy.ops.object.hybrid_quad_check()
    assert _codes(obj) == {"isolated_vertex": 2, "loose_edge": 1}


def test_selecting_an_edge():
    obj = _with_fin()
    assert bpy.ops.object.hybrid_quad_select_defect(code="non_manifold_edge") == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert [tuple(sorted(edge.vertices)) for edge in obj.data.edges if edge.select] == [(1, 2)]
    assert not any(polygon.select for polygon in obj.data.polygons)


def test_selecting_faces():
    obj = add_object("Turned", CORNERS, [TETRAHEDRON[0][::-1], *TETRAHEDRON[1:]])
    assert bpy.ops.object.hybrid_quad_select_defect(code="flipped_face") == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert [polygon.index for polygon in obj.data.polygons if polygon.select] == [0]


def test_what_is_not_there_is_not_selected():
    obj = add_sphere()
    assert bpy.ops.object.hybrid_quad_select_defect(code="flipped_face") == {"CANCELLED"}
    assert obj.mode == "OBJECT"


def test_a_modified_mesh_is_listed_but_not_selected():
    obj = _with_fin()
    obj.modifiers.new("Array", "ARRAY").count = 2
    bpy.ops.object.hybrid_quad_check()
    assert _codes(obj)["non_manifold_edge"] == 2
    try:
        bpy.ops.object.hybrid_quad_select_defect(code="non_manifold_edge")
    except RuntimeError as error:
        assert "modifiers" in str(error)
    assert obj.mode == "OBJECT"


def test_the_list_is_kept_as_json():
    obj = _with_fin()
    bpy.ops.object.hybrid_quad_check()
    assert json.loads(obj.hybrid_quad.last_check) == read_check(obj)


def test_a_repaired_copy_has_nothing_to_repair_and_the_object_stays():
    obj = _with_fin()
    obj.location.x = 2
    material = bpy.data.materials.new("Red")
    obj.data.materials.append(material)
    before = len(obj.data.vertices), len(obj.data.polygons)
    assert bpy.ops.object.hybrid_quad_repair() == {"FINISHED"}
    copy = bpy.context.object
    assert copy.name == "Fin Repaired" and copy.location.x == 2 and copy.data.materials[0] == material
    assert (len(obj.data.vertices), len(obj.data.polygons)) == before and obj.hide_get()
    assert not copy.data.validate()
    assert max(_faces_of_edges(copy).values()) == 2


def test_a_repaired_copy_has_nothing_to_repair():
    faces = [TETRAHEDRON[0][::-1], *TETRAHEDRON[1:], TETRAHEDRON[1]]
    obj = add_object("Wrong", [*CORNERS, (5, 5, 5)], faces)
    bpy.ops.object.hybrid_quad_check()
    assert {"flipped_face", "duplicate_face", "isolated_vertex"} <= set(_codes(obj))
    assert bpy.ops.object.hybrid_quad_repair() == {"FINISHED"}
    bpy.ops.object.hybrid_quad_check()
    assert read_check(bpy.context.object) == []


def _faces_of_edges(obj: bpy.types.Object) -> Counter:
    return Counter(key for polygon in obj.data.polygons for key in polygon.edge_keys)


def test_what_cannot_be_repaired_leaves_no_copy():
    add_object("Flat", [(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)])
    before = len(bpy.data.objects), len(bpy.data.meshes)
    with pytest.raises(RuntimeError, match="area"):
        bpy.ops.object.hybrid_quad_repair()
    assert (len(bpy.data.objects), len(bpy.data.meshes)) == before


def test_what_the_window_tells_has_no_identifiers(capfd):
    """Reports of all three operators are words and numbers."""
    obj = _with_fin()
    assert bpy.ops.object.hybrid_quad_check() == {"FINISHED"}
    assert bpy.ops.object.hybrid_quad_repair() == {"FINISHED"}
    obj.hide_set(False)
    activate(obj)
    remesh()
    lines = [line for line in capfd.readouterr().out.splitlines() if line.startswith(("Info:", "Warning:"))]
    assert any("in more than two faces" in line for line in lines) and any("quads" in line for line in lines)
    assert not any("_" in line for line in lines), lines
