"""Part of a mesh: the rest stays as it is to the last bit, and the new quads carry what the surface carried."""

from __future__ import annotations

import bmesh
import bpy
import numpy as np
import pytest

from hybrid_quad.blender import edge_marks
from hybrid_quad.blender.part_source import knows_face_sets
from hybrid_quad.blender.transfer import mask
from hybrid_quad.blender.transfer.attributes import STORAGES
from scenes import activate, add_cube, add_grid, add_sphere, points_of, remesh
from test_transfer import CHECKS
from transfer_scene import add_everything, read, set_mask, uv_of

NOT_COMPARED = {"position", "custom_normal", ".edge_verts", ".corner_vert", ".corner_edge"}
DISPLAY = (".select", ".hide", ".vs.", ".es.", ".pn.")


def choose(obj, inside) -> np.ndarray:
    """Selects the faces whose middles are `inside`, as Edit Mode would; (#F,) which these are."""
    chosen = np.array([bool(inside(polygon.center)) for polygon in obj.data.polygons])
    edited = bmesh.new()
    edited.from_mesh(obj.data)
    for element in (*edited.verts, *edited.edges, *edited.faces):
        element.select = False
    edited.faces.ensure_lookup_table()
    for index in np.flatnonzero(chosen):
        edited.faces[index].select_set(True)
    edited.to_mesh(obj.data)
    edited.free()
    obj.hybrid_quad.part.region = "SELECTED"
    return chosen


def middle(center, half=0.55) -> bool:
    return abs(center.x) < half and abs(center.y) < half


class Rest:
    """What a mesh carries on the faces that are not chosen, and on their corners, edges and vertices."""

    def __init__(self, mesh, chosen) -> None:
        sizes = read(mesh.polygons, "loop_total", np.int32)
        corners = read(mesh.loops, "vertex_index", np.int32)
        edges = read(mesh.edges, "vertices", np.int32, 2)
        edge_of_corner = read(mesh.loops, "edge_index", np.int32)
        of_rest = np.repeat(~chosen, sizes)
        vertices = np.zeros(len(mesh.vertices), bool)
        vertices[corners[of_rest]] = True
        edge = np.zeros(len(edges), bool)
        edge[edge_of_corner[of_rest]] = True
        self._kept = {"POINT": vertices, "EDGE": edge, "FACE": ~chosen, "CORNER": of_rest}
        number = np.cumsum(vertices) - 1
        self.values = {
            "sizes": sizes[~chosen],
            "corners": number[corners[of_rest]],
            "edges": number[edges[edge]],
            "places": read(mesh.vertices, "co", np.float32, 3)[vertices],
        }
        for attribute in mesh.attributes:
            if attribute.name not in NOT_COMPARED and not attribute.name.startswith(DISPLAY):
                self._add(attribute)
        for layer in mesh.uv_layers:
            self.values[f"uv {layer.name}"] = uv_of(layer)[of_rest]
        for store in edge_marks._STORES:
            self.values[f"mark {store.mark}"] = edge_marks._read_store(mesh, store)[edge]
        for store in (edge_marks.VERTEX_CREASE, edge_marks.VERTEX_BEVEL):
            weights = store.read(mesh)
            if weights is not None:
                self.values[store.attribute] = weights[vertices]
        if mask.read(mesh) is not None:
            self.values["mask"] = mask.read(mesh)[vertices]
        for name, dtype in (("material_index", np.int32), ("use_smooth", bool)):
            self.values[name] = read(mesh.polygons, name, dtype)[~chosen]
        self.values["groups"] = [
            [(item.group, item.weight) for item in mesh.vertices[index].groups] for index in np.flatnonzero(vertices)
        ]
        for key in mesh.shape_keys.key_blocks if mesh.shape_keys else ():
            self.values[f"key {key.name}"] = read(key.data, "co", np.float32, 3)[vertices]

    def _add(self, attribute) -> None:
        storage = STORAGES[attribute.data_type]
        if storage.dtype is object:
            values = np.array([item.value for item in attribute.data])
        elif attribute.data_type == "BYTE_COLOR":
            values = (
                read(attribute.data, "color_srgb", np.float32, 4)
                if hasattr(attribute.data[0], "color_srgb")
                else (read(attribute.data, "color", np.float32, 4))
            )
        else:
            values = read(attribute.data, storage.value, storage.dtype, storage.width)
        self.values[f"attribute {attribute.name}"] = values[self._kept[attribute.domain]]


def assert_rest_kept(before: Rest, mesh, kept_faces: int) -> None:
    """All that the rest had is there with the same bits and in the same order, before what is new."""
    chosen = np.arange(len(mesh.polygons)) >= kept_faces
    after = Rest(mesh, chosen)
    assert set(before.values) <= set(after.values)
    for name, values in before.values.items():
        same = after.values[name] == values if isinstance(values, list) else np.array_equal(after.values[name], values)
        assert same, name


def assert_closed_to_rest(mesh, kept_faces: int) -> None:
    """Every edge has two faces, but those of the mesh's own border; the new faces are quads."""
    assert {polygon.loop_total for polygon in list(mesh.polygons)[kept_faces:]} == {4}
    edited = bmesh.new()
    edited.from_mesh(mesh)
    assert all(edge.is_contiguous or edge.is_boundary for edge in edited.edges)
    assert not any(len(vertex.link_faces) == 0 for vertex in edited.verts)
    edited.free()


def boundary_count(mesh) -> int:
    edited = bmesh.new()
    edited.from_mesh(mesh)
    count = sum(edge.is_boundary for edge in edited.edges)
    edited.free()
    return count


@pytest.mark.parametrize("result_mode", ["NEW", "REPLACE"])
def test_everything_of_the_rest_is_kept(result_mode):
    obj = add_everything()
    chosen = choose(obj, middle)
    before = Rest(obj.data, chosen)
    obj.hybrid_quad.result_mode = result_mode
    obj.hybrid_quad.part.use_border_length = False
    obj.hybrid_quad.quads = 90
    result = remesh()
    assert (result == obj) == (result_mode == "REPLACE")
    kept = int((~chosen).sum())
    assert len(result.data.polygons) - kept not in (0, int(chosen.sum()))
    assert_rest_kept(before, result.data, kept)
    assert_closed_to_rest(result.data, kept)
    assert boundary_count(result.data) == 48
    assert not result.data.validate(verbose=True)


@pytest.mark.parametrize("kind", sorted(set(CHECKS) - {"animation", "collections", "parent", "constraints"}))
def test_new_faces_carry_everything(kind):
    if kind == "face_sets" and not knows_face_sets():
        pytest.skip("Python cannot see face sets before Blender 3.5")
    obj = add_everything()
    choose(obj, middle)
    obj.hybrid_quad.part.use_border_length = False
    obj.hybrid_quad.quads = 90
    CHECKS[kind](obj, remesh())


def test_custom_normals_stay_as_they_are():
    obj = add_sphere()
    mesh = obj.data
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth = True
    mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
    tilted = [(p + np.array([0.3, 0.0, 0.0])) / np.linalg.norm(p + np.array([0.3, 0.0, 0.0])) for p in points_of(obj)]
    mesh.normals_split_custom_set_from_vertices(tilted)
    chosen = choose(obj, lambda center: center.z > 0.3)
    before = corner_normals(mesh)[np.repeat(~chosen, read(mesh.polygons, "loop_total", np.int32))]
    result = remesh()
    kept = int(read(result.data.polygons, "loop_total", np.int32)[: int((~chosen).sum())].sum())
    after = corner_normals(result.data)
    # Blender rounds them by the faces around: written to the result by themselves, they come back no nearer.
    alone = result.data.copy()
    alone.normals_split_custom_set([*before.tolist(), *after[kept:].tolist()])
    rounding = np.abs(corner_normals(alone)[:kept] - before).max()
    assert rounding < 2e-3
    assert np.abs(after[:kept] - before).max() < max(1e-3, 1.01 * rounding)
    points = points_of(result)[read(result.data.loops, "vertex_index", np.int32)[kept:]] + np.array([0.3, 0.0, 0.0])
    expected = points / np.linalg.norm(points, axis=1, keepdims=True)
    assert np.abs(after[kept:] - expected).max() < 0.05
    assert not read(result.data.edges, "use_edge_sharp", bool).any()


def corner_normals(mesh) -> np.ndarray:
    if hasattr(mesh, "calc_normals_split"):
        mesh.calc_normals_split()
        return read(mesh.loops, "normal", np.float32, 3)
    return read(mesh.corner_normals, "vector", np.float32, 3)


def test_in_edit_mode():
    obj = add_cube(segments=8)
    chosen = choose(obj, lambda center: center.z > 0.99)
    before = Rest(obj.data, chosen)
    obj.hybrid_quad.result_mode = "REPLACE"
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.object.hybrid_quad_remesh() == {"FINISHED"}
    assert obj.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert [polygon.select for polygon in obj.data.polygons] == [
        index >= int((~chosen).sum()) for index in range(len(obj.data.polygons))
    ]
    assert_rest_kept(before, obj.data, int((~chosen).sum()))
    assert boundary_count(obj.data) == 0


@pytest.mark.parametrize("result_mode", ["REPLACE", "NEW"])
def test_in_sculpt_mode(result_mode):
    obj = add_grid(cells=12)
    chosen = choose(obj, middle)
    set_mask(obj.data, (np.abs(points_of(obj)[:, :2]) < 0.55).all(axis=1).astype(np.float32))
    obj.hybrid_quad.part.region, obj.hybrid_quad.result_mode = "MASK", result_mode
    before = Rest(obj.data, chosen)
    bpy.ops.object.mode_set(mode="SCULPT")
    assert bpy.ops.object.hybrid_quad_remesh() == {"FINISHED"}
    result = bpy.context.object
    assert result.mode == "SCULPT" and (result == obj) == (result_mode == "REPLACE")
    assert [other.mode for other in bpy.data.objects if other != result] == ["OBJECT"] * (result_mode == "NEW")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert_rest_kept(before, result.data, int((~chosen).sum()))
    assert_closed_to_rest(result.data, int((~chosen).sum()))


def test_edit_mode_is_for_parts_only():
    add_cube()
    bpy.ops.object.mode_set(mode="EDIT")
    assert not bpy.ops.object.hybrid_quad_remesh.poll()


def set_face_attribute(obj, name, data_type, values) -> None:
    attribute = obj.data.attributes.new(name, data_type, "FACE")
    attribute.data.foreach_set("value", values)


def test_a_face_set_is_picked():
    obj = add_grid(cells=12)
    with pytest.raises(RuntimeError, match="face sets"):  # there are none, or this Blender does not tell of them
        bpy.ops.object.hybrid_quad_pick_face_set(face=0)
    if not knows_face_sets():
        return
    chosen = choose(obj, middle)
    set_face_attribute(obj, ".sculpt_face_set", "INT", np.where(chosen, 7, 2).astype(np.int32))
    assert bpy.ops.object.hybrid_quad_pick_face_set(face=int(np.flatnonzero(chosen)[3])) == {"FINISHED"}
    assert (obj.hybrid_quad.part.region, obj.hybrid_quad.part.face_set) == ("FACE_SET", 7)


@pytest.mark.parametrize("region", ["SELECTED", "VISIBLE", "FACE_SET", "MASK", "ATTRIBUTE"])
@pytest.mark.parametrize("is_inverted", [False, True])
def test_every_way_to_choose(region, is_inverted):
    if region == "FACE_SET" and not knows_face_sets():
        pytest.skip("Python cannot see face sets before Blender 3.5")
    obj = add_grid(cells=12)
    chosen = choose(obj, middle)
    settings = obj.hybrid_quad.part
    settings.region, settings.use_inverted = region, is_inverted
    if region != "SELECTED":
        obj.data.polygons.foreach_set("select", np.zeros(len(chosen), bool))
    if region == "VISIBLE":
        obj.data.polygons.foreach_set("hide", ~chosen)
    elif region == "FACE_SET":
        set_face_attribute(obj, ".sculpt_face_set", "INT", np.where(chosen, 7, 2).astype(np.int32))
        settings.face_set = 7
    elif region == "MASK":
        set_mask(obj.data, (np.abs(points_of(obj)[:, :2]) < 0.55).all(axis=1).astype(np.float32))
    elif region == "ATTRIBUTE":
        set_face_attribute(obj, "Here", "BOOLEAN", chosen)
        settings.attribute = "Here"
    remeshed = ~chosen if is_inverted else chosen
    before = Rest(obj.data, remeshed)
    assert_rest_kept(before, remesh().data, int((~remeshed).sum()))


@pytest.mark.parametrize(
    ("region", "words"),
    [("SELECTED", "No face"), ("MASK", "no mask"), ("ATTRIBUTE", "no Boolean attribute"), ("FACE_SET", "face set")],
)
def test_nothing_chosen_is_refused(region, words, scene_state):
    obj = add_grid()
    choose(obj, lambda _: False)
    obj.hybrid_quad.part.region = region
    before = scene_state()
    with pytest.raises(RuntimeError, match=words):
        bpy.ops.object.hybrid_quad_remesh()
    assert scene_state() == before


def test_odd_borders_are_refused_or_settled(scene_state):
    obj = add_grid()
    modifier = obj.modifiers.new("Triangles", "TRIANGULATE")
    bpy.ops.object.modifier_apply(modifier=modifier.name)
    chosen = choose(obj, middle)
    one = int(np.flatnonzero(chosen)[0])
    obj.data.polygons[one].select = False
    before = scene_state()
    with pytest.raises(RuntimeError, match="even number"):
        bpy.ops.object.hybrid_quad_remesh()
    assert scene_state() == before
    for odd_border in ("GROW", "SHRINK"):
        activate(obj)
        obj.hide_set(False)
        activate(obj)
        obj.hybrid_quad.part.odd_border = odd_border
        kept = len(chosen) - int(chosen.sum()) + (0 if odd_border == "GROW" else 2)
        assert_closed_to_rest(remesh().data, kept)


def test_modifiers_are_not_applied():
    obj = add_grid()
    choose(obj, middle)
    obj.modifiers.new("Array", "ARRAY")
    obj.hybrid_quad.result_mode = "REPLACE"
    remesh()
    assert [modifier.type for modifier in obj.modifiers] == ["ARRAY"]
    assert points_of(obj)[:, 0].max() == 1.0


def test_what_needs_the_whole_surface_is_refused():
    obj = add_grid()
    choose(obj, middle)
    obj.hybrid_quad.symmetry_axes = (True, False, False)
    with pytest.raises(RuntimeError, match="whole surface"):
        bpy.ops.object.hybrid_quad_remesh()


def test_shared_meshes_become_single():
    obj = add_grid()
    chosen = choose(obj, middle)
    other = bpy.data.objects.new("Other", obj.data)
    bpy.context.scene.collection.objects.link(other)
    faces = len(obj.data.polygons)
    obj.hybrid_quad.result_mode = "REPLACE"
    obj.hybrid_quad.part.use_border_length = False
    obj.hybrid_quad.quads = 3 * int(chosen.sum())
    remesh()
    assert other.data != obj.data and len(other.data.polygons) == faces != len(obj.data.polygons)


def test_scaled_and_mirrored_objects():
    obj = add_grid()
    chosen = choose(obj, middle)
    obj.scale = (-1, 2, 0.5)
    bpy.context.view_layer.update()
    before = Rest(obj.data, chosen)
    result = remesh()
    assert_rest_kept(before, result.data, int((~chosen).sum()))
    assert_closed_to_rest(result.data, int((~chosen).sum()))
    assert min(polygon.normal.z for polygon in result.data.polygons) > 0.99


def test_several_objects_by_their_own_settings():
    one, other = add_cube(segments=8), add_grid()
    chosen = choose(one, lambda center: center.z > 0.99)
    other.hybrid_quad.quads = 60
    one.hybrid_quad.result_mode = other.hybrid_quad.result_mode = "REPLACE"
    empty = add_grid()
    choose(empty, lambda _: False)
    before = Rest(one.data, chosen)
    for obj in (one, other, empty):
        obj.select_set(True)
    with pytest.raises(RuntimeError, match="No face of"):  # that of one object; the others are done
        bpy.ops.object.hybrid_quad_remesh_selected()
    assert_rest_kept(before, one.data, int((~chosen).sum()))
    assert 40 < len(other.data.polygons) < 80
    assert one.select_get() and other.select_get()


def test_batch_command(tmp_path):
    from hybrid_quad.blender.command import main

    obj = add_grid()
    chosen = choose(obj, middle)
    set_face_attribute(obj, "Here", "BOOLEAN", chosen)
    obj.hybrid_quad.part.region = "WHOLE"
    before = Rest(obj.data, chosen)
    out = str(tmp_path / "out.blend")
    arguments = ["--object", obj.name, "--output", out, "--part", "attribute", "--part-attribute", "Here", "--replace"]
    assert main([*arguments, "--quads", "80", "--quiet"]) == 0
    assert 60 < len(obj.data.polygons) - int((~chosen).sum()) < 100
    assert_rest_kept(before, obj.data, int((~chosen).sum()))
    assert main([*arguments[:-2], "Elsewhere", "--quiet"]) == 1


def test_linked_meshes_are_copied_and_linked_objects_refused(tmp_path):
    obj = add_grid()
    chosen = choose(obj, middle)
    faces = len(obj.data.polygons)
    library = str(tmp_path / "library.blend")
    bpy.data.libraries.write(library, {obj})
    with bpy.data.libraries.load(library, link=True) as (theirs, ours):
        ours.objects, ours.meshes = list(theirs.objects), list(theirs.meshes)
    linked, mesh = ours.objects[0], ours.meshes[0]
    bpy.context.scene.collection.objects.link(linked)
    activate(linked)
    assert not bpy.ops.object.hybrid_quad_remesh.poll()
    activate(obj)
    obj.data = mesh
    assert obj.data.library is not None
    obj.hybrid_quad.result_mode = "REPLACE"
    obj.hybrid_quad.part.use_border_length, obj.hybrid_quad.quads = False, 3 * int(chosen.sum())
    remesh()
    assert obj.data.library is None and len(obj.data.polygons) > faces == len(mesh.polygons)


def test_in_edit_mode_of_a_shape_key():
    obj = add_everything()
    chosen = choose(obj, middle)
    before = Rest(obj.data, chosen)
    obj.active_shape_key_index = 1
    obj.hybrid_quad.result_mode = "REPLACE"
    bpy.ops.object.mode_set(mode="EDIT")
    assert bpy.ops.object.hybrid_quad_remesh() == {"FINISHED"}
    bpy.ops.object.mode_set(mode="OBJECT")
    assert_rest_kept(before, obj.data, int((~chosen).sum()))
    CHECKS["shape_keys"](add_everything(), obj)


def test_loose_vertices_and_edges_stay():
    obj = add_grid()
    edited = bmesh.new()
    edited.from_mesh(obj.data)
    inside = min(edited.verts, key=lambda vertex: vertex.co.length)
    ends = [edited.verts.new((0, 0, height)) for height in (1, 2)]
    edited.edges.new([inside, ends[0]])
    edited.to_mesh(obj.data)
    edited.free()
    chosen = choose(obj, middle)
    result = remesh()
    assert_rest_kept(Rest(obj.data, chosen), result.data, int((~chosen).sum()))
    points = points_of(result)
    assert {(0, 0, 1), (0, 0, 2)} <= {tuple(point) for point in points.tolist()}
    loose = [tuple(edge.vertices) for edge in result.data.edges if edge.is_loose]
    assert [{tuple(points[v]) for v in edge} for edge in loose] == [{(0, 0, 0), (0, 0, 1)}]
