import os
import struct

import numpy as np
import pytest

from fuzz.fuzz_readers import damaged, verdict_on
from hybrid_quad.core import mesh_formats, mesh_io, stl_file
from hybrid_quad.core.equal_points import merged_points
from hybrid_quad.core.file_places import MeshFileError, replacing
from hybrid_quad.core.mesh_io import read_mesh, write_mesh
from hybrid_quad.core.wish_files import read_edges, read_line_elements, read_polylines
from support import surfaces


def rows(polygons):
    ends = np.cumsum(polygons.sizes)
    return [polygons.vertices[end - size : end].tolist() for end, size in zip(ends, polygons.sizes, strict=True)]


def file_with(tmp_path, name, content):
    path = tmp_path / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize("suffix", mesh_formats.WRITABLE)
def test_what_is_written_is_read_back_to_the_last_bit(tmp_path, suffix):
    vertices, quads = surfaces.quad_box(3)
    vertices = vertices * np.pi + [1e6, 1e-9, -1 / 3]
    path = tmp_path / f"box{suffix}"
    write_mesh(path, vertices, quads.astype(np.int32))
    again, polygons = read_mesh(path)
    assert np.array_equal(again, vertices)
    assert rows(polygons) == quads.tolist()


@pytest.mark.parametrize("suffix", mesh_formats.WRITABLE)
def test_same_mesh_same_bytes(tmp_path, suffix):
    vertices, quads = surfaces.quad_box(2)
    for name in ("one", "two"):
        write_mesh(tmp_path / f"{name}{suffix}", vertices, quads)
    assert (tmp_path / f"one{suffix}").read_bytes() == (tmp_path / f"two{suffix}").read_bytes()


OBJ = """# every kind of corner, polygons of three sizes, more texture coordinates than vertices, a colour
mtllib some.mtl
v 0 0 0
v 1 0 0 0.5 nan 0.5
v 1 1 0
v 0 1 0
v 2 0 0
v 0 0 0
vt 0 0
vt 0 1
vt 1 1
vt 1 0
vt .5 .5
vt .5 .6
vt .5 .7
vn 0 0 1
f 1 2 3 4
f 2/1 5/2 3/3
f 2//1 5//1 \\
 3//1
f 1/1/1 2/2/1 5/3/1 3/4/1 4/5/1
f -6 -5 -4
l 1 2
"""


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_obj_of_every_kind(tmp_path, newline):
    vertices, polygons = read_mesh(file_with(tmp_path, "kinds.OBJ", OBJ.replace("\n", newline)))
    assert vertices.tolist()[1] == [1.0, 0.0, 0.0]
    assert len(vertices) == 6, "coincident vertices stay apart"
    assert rows(polygons) == [[0, 1, 2, 3], [1, 4, 2], [1, 4, 2], [0, 1, 4, 2, 3], [0, 1, 2]]


def test_relative_indices_count_from_where_they_stand(tmp_path):
    text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf -3 -2 -1\n"
    _, polygons = read_mesh(file_with(tmp_path, "a.obj", text))
    assert rows(polygons) == [[0, 1, 2], [3, 4, 5]]


def test_index_zero_of_obj_is_left_for_the_mesh_check(tmp_path):
    _, polygons = read_mesh(file_with(tmp_path, "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"))
    assert rows(polygons) == [[-1, 0, 1]]


def test_off_with_polygons_comments_and_colours(tmp_path):
    text = "OFF # made by hand\n5 2 0\n\n0 0 0\n1 0 0\n1 1 0\n0 1 0 # corner\n2 0 0\n4 0 1 2 3 255 0 0\n3 1 4 2\n"
    vertices, polygons = read_mesh(file_with(tmp_path, "a.off", text))
    assert vertices.shape == (5, 3)
    assert rows(polygons) == [[0, 1, 2, 3], [1, 4, 2]]


@pytest.mark.parametrize("faces", ["4 0 1 2 3\n3 1 4 2\n", "4\n0 1\n2\n3\n3 1\n4 2\n"])
def test_rows_of_off_may_go_on_in_further_lines(tmp_path, faces):
    text = "OFF\n5 2 0\n0 0 0\n1 0\n0\n1 1 0\n0 1 0\n2 0 0\n" + faces
    vertices, polygons = read_mesh(file_with(tmp_path, "a.off", text))
    assert vertices.tolist()[1] == [1, 0, 0]
    assert rows(polygons) == [[0, 1, 2, 3], [1, 4, 2]]


@pytest.mark.timeout(30)
def test_a_row_of_off_over_very_many_lines_takes_no_longer_than_on_one(tmp_path):
    corners = 300_000
    text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n" + f"{corners}\n" + "1\n" * corners
    _, polygons = read_mesh(file_with(tmp_path, "a.off", text))
    assert polygons.sizes.tolist() == [corners]


PLY = """ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
property uchar red
element face 2
property list uchar int vertex_indices
end_header
0 0 0 1
1 0 0 1
1 1 0 1
0 1 0 1
2 0 0 1
4 0 1 2 3
3 1 4 2
"""


def test_ply_text_with_polygons(tmp_path):
    vertices, polygons = read_mesh(file_with(tmp_path, "a.ply", PLY))
    assert vertices.dtype == np.float64
    assert rows(polygons) == [[0, 1, 2, 3], [1, 4, 2]]


PLY_ROWS = {
    "vertex": ("property uchar red\nproperty float x\nproperty double y\nproperty short z\n", "BfdH"),
    "material": ("property int kind\n", "i"),
    "face": ("property uchar flags\nproperty list uchar {} {}\nproperty list int float texcoord\n", None),
    "edge": ("property int vertex1\nproperty int vertex2\n", "ii"),
}


def ply_of_all_kinds(form, faces, name="vertex_indices", index="uint"):
    """A file with properties and elements beside those that are read, in text or either order of bytes."""
    order = {"ascii": None, "binary_little_endian": "<", "binary_big_endian": ">"}[form]
    points = [(9, 0.5, 0.0, 0), (9, 1.0, 0.1, 0), (9, 1.0, 1.0, 3), (9, 0.0, 1.0, 0), (9, 2.0, 0.0, 0)]
    texcoords = [[0.5] * number for number in range(len(faces))]
    rows = {
        "vertex": points,
        "material": [(7,)],
        "face": list(zip(faces, texcoords, strict=True)),
        "edge": [(0, 1), (1, 2)],
    }
    head, body = f"ply\nformat {form} 1.0\ncomment element face 7\nobj_info made by hand\n", b""
    for element, (properties, kinds) in PLY_ROWS.items():
        head += f"element {element} {len(rows[element])}\n{properties.format(index, name)}"
        for row in rows[element]:
            if element == "face":
                corners, coordinates = row
                values = [1, len(corners), *corners, len(coordinates), *coordinates]
                kinds = f"BB{len(corners)}Ii{len(coordinates)}f"
            else:
                values = list(row)
            body += struct.pack(order + kinds, *values) if order else (" ".join(map(str, values)) + "\n").encode()
    return head.encode() + b"end_header\n" + body


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])
@pytest.mark.parametrize("faces", [[[0, 1, 2, 3], [1, 4, 2], [0, 1, 2]], [[0, 1, 2], [2, 1, 4]], [[3, 2, 1, 0]], []])
@pytest.mark.parametrize("name", ["vertex_indices", "vertex_index"])
def test_ply_with_whatever_programs_put_into_it(tmp_path, form, faces, name):
    vertices, polygons = read_mesh(file_with(tmp_path, "a.ply", ply_of_all_kinds(form, faces, name)))
    assert vertices.tolist() == [[0.5, 0, 0], [1, 0.1, 0], [1, 1, 3], [0, 1, 0], [2, 0, 0]]
    assert rows(polygons) == faces


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
def test_a_ply_file_cut_anywhere_is_refused(tmp_path, form):
    whole = ply_of_all_kinds(form, [[0, 1, 2, 3], [1, 4, 2]]).rstrip(b"\n")
    for end in range(1, len(whole) - 1):
        with pytest.raises(MeshFileError, match=r"a\.ply"):
            read_mesh(file_with(tmp_path, "a.ply", whole[:end]))


def test_ply_faces_that_are_no_numbers_of_vertices_are_refused(tmp_path):
    with pytest.raises(MeshFileError, match="vertex_indices"):
        read_mesh(file_with(tmp_path, "a.ply", PLY.replace("uchar int", "uchar float")))


def test_several_elements_of_faces_are_one_after_the_other(tmp_path):
    text = PLY.replace("end_header\n", "element face 1\nproperty list uchar uint vertex_index\nend_header\n")
    _, polygons = read_mesh(file_with(tmp_path, "a.ply", text + "3 0 1 4\n"))
    assert rows(polygons) == [[0, 1, 2, 3], [1, 4, 2], [0, 1, 4]]


def test_faces_of_one_of_several_elements_of_vertices_are_refused(tmp_path):
    vertices, _, faces = PLY.partition("element face")
    again = vertices[vertices.index("element vertex") :]
    with pytest.raises(MeshFileError, match="more than one element vertex"):
        read_mesh(file_with(tmp_path, "a.ply", vertices + again + "element face" + faces))


@pytest.mark.parametrize(
    ("strips", "triangles"),
    [
        (["0 1 2 3 4"], [[0, 1, 2], [2, 1, 3], [2, 3, 4]]),
        (["0 1 2 -1 1 3 2 4"], [[0, 1, 2], [1, 3, 2], [2, 3, 4]]),
        (["0 1 2", "1 2 3 4"], [[0, 1, 2], [1, 2, 3], [3, 2, 4]]),
        (["0 1 2 2 1 1 1 3 2 4"], [[0, 1, 2], [1, 3, 2], [2, 3, 4]]),  # joined by triangles without area
        (["0 1", "-1", "2 -1 3 4"], []),
    ],
)
def test_strips_of_ply_turn_the_way_their_first_triangle_does(tmp_path, strips, triangles):
    text = (
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        f"element tristrips {len(strips)}\nproperty list int int vertex_indices\nend_header\n"
        + "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n"
        + "".join(f"{len(strip.split())} {strip}\n" for strip in strips)
    )
    _, polygons = read_mesh(file_with(tmp_path, "a.ply", text))
    assert rows(polygons) == triangles


def test_stl_of_either_kind_is_one_mesh_with_shared_corners(tmp_path):
    triangles = np.array([[(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 0), (0, 1, 0)]], float)
    text = "".join(
        "facet normal 0 0 1\n outer loop\n"
        + "".join(f"  VERTEX {x} {y} {z}\n" for x, y, z in triangle.tolist())
        + " endloop\nendfacet\n"
        for triangle in triangles
    )
    binary = b"\0" * 80 + struct.pack("<I", 2)
    for triangle in triangles:
        binary += struct.pack("<12fH", 0, 0, 1, *triangle.reshape(-1), 5)
    for content in (f"solid a vertexless name\n{text}endsolid\n", binary, binary + b"more"):
        vertices, polygons = read_mesh(file_with(tmp_path, "a.stl", content))
        assert vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
        assert rows(polygons) == [[0, 1, 2], [1, 3, 2]]
    for content in (text, binary[:-1], f"solid a\n{text}".partition("endloop")[0].rsplit("VERTEX", 1)[0]):
        with pytest.raises(MeshFileError, match="STL"):
            read_mesh(file_with(tmp_path, "a.stl", content))


def test_binary_stl(tmp_path):
    triangles = [[(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 0), (0, 1, 0)]]
    content = b"solid misleading".ljust(80) + struct.pack("<I", 2)
    for triangle in triangles:
        content += struct.pack("<12fH", 0, 0, 1, *np.ravel(triangle), 0)
    vertices, polygons = read_mesh(file_with(tmp_path, "a.stl", content))
    assert [vertices[face].tolist() for face in rows(polygons)] == [np.array(t, float).tolist() for t in triangles]


def ascii_stl(name):
    triangle = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
    return f"solid {name}\n{triangle}endsolid {name}\n"


@pytest.mark.parametrize(
    "text",
    [
        ascii_stl("my vertex model"),
        ascii_stl("x").replace("\n", "\r"),
        ascii_stl("a vertex b").replace("\n", "\r"),
        "\ufeff" + ascii_stl("x"),
        ascii_stl("vertex").replace("\n", " ", 7),
    ],
    ids=["name", "carriage returns", "name, carriage returns", "mark", "one line"],
)
def test_stl_texts_of_all_kinds(tmp_path, text):
    vertices, polygons = read_mesh(file_with(tmp_path, "a.stl", text))
    assert vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert rows(polygons) == [[0, 1, 2]]


@pytest.mark.parametrize("filler", [b"\0", b" "])
def test_binary_stl_that_begins_as_a_text_does(tmp_path, filler):
    triangle = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    content = b"solid".ljust(80, filler) + struct.pack("<I", 1) + triangle
    _, polygons = read_mesh(file_with(tmp_path, "a.stl", content + b"more"))
    assert rows(polygons) == [[0, 1, 2]]
    with pytest.raises(MeshFileError, match="ends too early"):
        read_mesh(file_with(tmp_path, "a.stl", content[:-5]))


@pytest.mark.parametrize("size", [1, 7, 40, 100])
def test_stl_texts_are_the_same_whatever_part_of_them_is_read_at_once(tmp_path, monkeypatch, size):
    two = ascii_stl("a vertex b").replace(
        "endsolid", "facet normal 0 0 1\n vertex\n 1\n 0 0\nvertex -0 0 0 vertex 5 5\n5\nendsolid"
    )
    broken = two.replace("vertex 5 5", "vertex 5 x")
    expected = read_mesh(file_with(tmp_path, "a.stl", two))
    monkeypatch.setattr(stl_file, "_BLOCK", size)
    vertices, polygons = read_mesh(file_with(tmp_path, "a.stl", two))
    assert np.array_equal(vertices, expected[0])
    assert rows(polygons) == rows(expected[1])
    with pytest.raises(MeshFileError, match="vertex 5, counted from 0"):
        read_mesh(file_with(tmp_path, "a.stl", broken))
    with pytest.raises(MeshFileError, match="ends within a triangle"):
        read_mesh(file_with(tmp_path, "a.stl", two[: two.rindex("5")]))


def test_places_of_points_are_those_of_unique_rows():
    random = np.random.default_rng(3)
    for count in (0, 1, 30, 300):
        points = random.choice([0.0, -0.0, 1.0, np.nan, np.inf], (count, 3), p=[0.3, 0.3, 0.3, 0.05, 0.05])
        first, places = merged_points(points)
        _, own, group = np.unique(points, axis=0, return_index=True, return_inverse=True)
        assert first.tolist() == sorted(own.tolist())
        assert np.array_equal(first[places], own[group.reshape(-1)])


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("suffix", ["ply", "stl"])
def test_bits_that_signal_are_read_in_silence(tmp_path, suffix):
    # A single-precision number that is none, of the kind whose cast says so.
    place = bytes.fromhex("0100807f") + struct.pack("<2f", 0, 0)
    corners = place + struct.pack("<6f", 1, 0, 0, 0, 1, 0)
    if suffix == "ply":
        names = "".join(f"property float {axis}\n" for axis in "xyz")
        head = f"ply\nformat binary_little_endian 1.0\nelement vertex 3\n{names}"
        content = f"{head}element face 1\nproperty list uchar int vertex_index\nend_header\n".encode()
        content += corners + struct.pack("<B3i", 3, 0, 1, 2)
    else:
        content = struct.pack("<80xI12x", 1) + corners + b"\0\0"
    vertices, polygons = read_mesh(file_with(tmp_path, f"a.{suffix}", content))
    assert np.isnan(vertices).sum() == 1
    assert rows(polygons) == [[0, 1, 2]]


def test_ply_text_with_carriage_returns(tmp_path):
    vertices, polygons = read_mesh(file_with(tmp_path, "a.ply", PLY.replace("\n", "\r")))
    assert len(vertices) == 5
    assert rows(polygons) == [[0, 1, 2, 3], [1, 4, 2]]


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.obj", "v 0 0 0\nv nan(ind) 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n-nan(ind) 0 0\n0 1 0\n3 0 1 2\n"),
        ("a.ply", PLY.replace("\n1 0 0 1", "\n-nan(ind) 0 0 1")),
        ("a.stl", ascii_stl("x").replace("vertex 1", "vertex NaN(IND)")),
    ],
)
def test_what_c_prints_for_no_number_is_left_for_the_mesh_check(tmp_path, name, content):
    vertices, _ = read_mesh(file_with(tmp_path, name, content))
    assert np.isnan(vertices).sum() == 1


@pytest.mark.parametrize("suffix", [".obj", ".off", ".ply"])
def test_a_mark_of_the_byte_order_before_the_text_is_none_of_it(tmp_path, suffix):
    vertices, quads = surfaces.quad_box(1)
    path = tmp_path / f"a{suffix}"
    write_mesh(path, vertices, quads)
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    again, polygons = read_mesh(path)
    assert np.array_equal(again, vertices)
    assert rows(polygons) == quads.tolist()


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("a.obj", "v 0 0 0\nv 1 zero 0\nv 0 1 0\nf 1 2 3\n", "zero"),
        ("a.off", "OFF\n1 0 0\n0,0 0 0\n", "vertex 0, .*0,0"),
        ("noending", "", "no ending"),
        ("a.obj", "v 0 0 0\nv 1 0\n", "line 2"),
        ("a.obj", "v 0 0 0\nf 1 two 3\n", "line 2"),
        ("a.obj", b"v 0 0 0\r\nv 1 \\\r\n 0 0\r\nf 1 2 \xff\xfe\r\n", r"line 4: '\?\?'"),
        ("a.off", "OOPS\n", "OFF"),
        ("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", "ends before"),
        ("a.off", "OFF\n1 1 0\n0 0 0\n3 0 0\n", "ends before"),
        ("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n-13 0 1 2\n", "face 1, .*-13"),
        ("a.off", "4OFF\n0 0 0\n", "4OFF"),
        ("a.obj", ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").encode("utf-16"), "no OBJ file"),
        ("a.obj", b"\x00\x01\xfe" * 9, "no OBJ file"),
        ("a.off", "OFF\n", "how many"),
        ("a.off", "OFF\n4\n0 0 0\n", "how many"),
        ("a.off", "OFF BINARY\n", "binary"),
        ("a.off", "OFF\n4.0 4 0\n", "number of vertices is .*'4.0'"),
        ("a.off", "OFF -4 -4\n", "-4 vertices"),
        ("a.off", "OFF\n1 2 0\n0 0 0\n1 0\nnan 0\n", "corners of face 1, .*'nan'"),
        ("a.off", "OFF\n1 1 0\n0 0 0\n1 x\n", "corner of face 0, .*'x'"),
        ("a.ply", PLY.replace("4 0 1 2 3", "4 0 1 2.0 3"), "corner of face 0, .*'2.0'"),
        ("a.ply", PLY.replace("3 1 4 2", "comment 3 1 4 2"), "list of face 1, .*'comment'"),
        ("a.ply", PLY.replace("1 1 0 1", "1 ? 0 1"), "vertex 2, .*'[?]'"),
        ("a.stl", ascii_stl("x").replace("vertex 1", "vertex 1.#QNAN"), "vertex 1, .*'1.#qnan'"),
        ("a.ply", b"\x00\x01\x02", "PLY"),
        ("a.ply", PLY[:-12], "PLY"),
        ("a.stl", b"short", "STL"),
        ("a.gltf", b"{}", "gltf"),
    ],
)
def test_damaged_files_are_named_with_the_reason(tmp_path, name, content, reason):
    path = file_with(tmp_path, name, content)
    with pytest.raises(MeshFileError, match=reason) as caught:
        read_mesh(path)
    assert str(path) in str(caught.value)


def test_missing_files_and_folders(tmp_path):
    with pytest.raises(MeshFileError, match="No such file"):
        read_mesh(tmp_path / "none.obj")
    with pytest.raises(MeshFileError, match="does not exist"):
        mesh_formats.check_writable(tmp_path / "none" / "a.obj")
    with pytest.raises(MeshFileError, match=r"\.stl"):
        mesh_formats.check_writable(tmp_path / "a.stl")
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(MeshFileError, match="is a folder"):
        mesh_formats.check_writable(tmp_path / "folder.obj")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")
@pytest.mark.timeout(30)
@pytest.mark.parametrize("suffix", mesh_formats.READABLE)
def test_a_pipe_is_not_waited_for(tmp_path, suffix):
    os.mkfifo(tmp_path / f"pipe{suffix}")
    with pytest.raises(MeshFileError, match="no regular file"):
        read_mesh(tmp_path / f"pipe{suffix}")


@pytest.mark.skipif(os.name != "posix", reason="links and permissions of POSIX")
def test_a_link_stays_one_and_a_file_that_is_replaced_its_permissions(tmp_path):
    place = file_with(tmp_path, "place.obj", "old")
    place.chmod(0o600)
    link = tmp_path / "link.obj"
    link.symlink_to("place.obj")
    with replacing(link) as file:
        file.write(b"new")
    assert link.is_symlink()
    assert place.read_text() == "new"
    assert place.stat().st_mode & 0o777 == 0o600
    link.unlink()
    link.symlink_to(tmp_path / "none" / "place.obj")
    with pytest.raises(MeshFileError, match="none does not exist"):
        mesh_formats.check_writable(link)


def test_names_may_be_as_long_as_the_system_takes_them(tmp_path):
    with replacing(tmp_path / f"{'n' * 240}.obj") as file:
        file.write(b"new")
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"new"]


def test_a_failed_write_leaves_the_old_file_and_nothing_else(tmp_path):
    path = file_with(tmp_path, "a.obj", "old")
    with pytest.raises(KeyboardInterrupt), replacing(path) as file:
        file.write(b"half of the new")
        raise KeyboardInterrupt
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_edge_file(tmp_path):
    assert read_edges(file_with(tmp_path, "e.txt", "# pairs\n0 1\n\n 7\t3 # seam\n")).tolist() == [[0, 1], [7, 3]]
    assert read_edges(file_with(tmp_path, "none.txt", "")).shape == (0, 2)
    with pytest.raises(MeshFileError, match="line 2"):
        read_edges(file_with(tmp_path, "bad.txt", "0 1\n2 3 4\n"))


def test_lines_are_read_from_obj_and_text(tmp_path):
    obj, text = tmp_path / "lines.obj", tmp_path / "lines.txt"
    obj.write_text("v 0 0 0\nv 1 0 0 # a comment\nv 1 1 0\nf 1 2 3\nl 1 2 3\nl -1 1\n")
    text.write_text("# two lines\n0 0 0\n1 0 0\n1 1 0\n\n\n1 1 0\n0 0 0\n")
    for path in (obj, text):
        (_, first), (_, second) = read_polylines(path)
        assert first.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0]]
        assert second.tolist() == [[1, 1, 0], [0, 0, 0]]


def test_a_line_may_go_on_behind_a_backslash(tmp_path):
    path = file_with(tmp_path, "lines.obj", "v 0 0 0\n v 1 \\\n0 0\nv 1 1 0\nl 1 \\\n2 -1 # two edges\nl 1 x\n")
    with pytest.raises(MeshFileError, match="line 7"):
        read_polylines(path)


@pytest.mark.parametrize(
    ("line", "edges"),
    [
        ("l 1 2 # an edge", [[0, 1]]),
        ("l 1 \\\r\n2", [[0, 1]]),
        ("\tl 1/4 2/7 -1", [[0, 1], [1, 3]]),
        ("l 1 2.5", []),
        ("# l 1 2 \\\nl 2 3", []),
        ("l 0 1", [[-1, 0]]),
    ],
)
def test_lines_of_a_mesh_are_read_as_the_mesh_is(tmp_path, line, edges):
    path = file_with(tmp_path, "a.obj", f"v 0 0 0\nv 1 0 0\n  v 0 1 0\nv\t5 5 5\nf 1 2 3\n{line}\n")
    assert read_line_elements(path).tolist() == edges


@pytest.mark.parametrize(
    ("content", "line"),
    [
        ("0 0 0\n1 0\n", "line 2"),
        ("0 0 0\n1 0 nan\n", "line 2"),
        ("v 0 0 0\nl 1 2\n", "line 2"),
        ("v 0 0 0\nl 0 1\n", "line 2"),
        ("v 0 0 0\nl 1 x\n", "line 2"),
        ("0 0 0\n\n1 0 0\n", "no line"),
        ("", "no line"),
    ],
)
def test_files_without_lines_say_where(tmp_path, content, line):
    path = tmp_path / "lines.txt"
    path.write_text(content)
    with pytest.raises(MeshFileError, match=line):
        read_polylines(path)


def test_a_ply_file_that_ends_in_its_header_is_refused(tmp_path):
    path = tmp_path / "cut.ply"
    path.write_bytes(b"ply\nformat ascii 1.0\nelement vertex 3\n")
    with pytest.raises(MeshFileError, match=r"cut\.ply.*header"):
        read_mesh(path)


@pytest.mark.parametrize("first", range(0, 400, 50))
def test_damaged_files_are_read_or_refused(tmp_path, first):
    for seed in range(first, first + 50):
        suffix, data = damaged(seed)
        path = tmp_path / f"damaged{suffix}"
        path.write_bytes(data)
        assert verdict_on(path) in ("read", "refused"), seed


def test_quads_are_written_the_same_however_many_rows_at_a_time(tmp_path, monkeypatch):
    vertices, quads = np.arange(60.0).reshape(20, 3) / 7, np.arange(16, dtype=np.int32).reshape(4, 4)
    write_mesh(tmp_path / "whole.off", vertices, quads)
    monkeypatch.setattr(mesh_io, "_ROWS_AT_ONCE", 3)
    write_mesh(tmp_path / "some.off", vertices, quads)
    assert (tmp_path / "some.off").read_bytes() == (tmp_path / "whole.off").read_bytes()
    assert np.array_equal(read_mesh(tmp_path / "some.off")[0], vertices)
