"""The documentation's blocks of Python for inside Blender, page by page."""

import re
from pathlib import Path

import bpy
import numpy as np
import pytest

from hybrid_quad.core.mesh_io import read_mesh
from scenes import add_object
from support.doc_blocks import blocks_of, pages_of
from support.doc_tables import parameter_rows

ROOT = Path(__file__).resolve().parents[2]
PAGES = [page for page in pages_of(ROOT) if any(block.knows_blender for block in blocks_of(ROOT, page))]


@pytest.mark.parametrize("page", PAGES)
def test_a_page(page):
    obj = add_spot()
    before = set(bpy.data.objects.keys())
    names = {"bpy": bpy, "points": points_on_flank(obj)}
    blocks = [block for block in blocks_of(ROOT, page) if block.language == "python" and not block.not_run]
    for block in blocks:
        exec(compile(block.text, block.place, "exec"), names)
    if page == "docs/start-in-scripts.md":
        made = [bpy.data.objects[name] for name in set(bpy.data.objects.keys()) - before]
        assert made and all(len(polygon.vertices) == 4 for each in made for polygon in each.data.polygons)
    else:
        painted = obj.data.attributes["hybrid_quad_guide"].data
        vectors = np.zeros(3 * len(painted))
        painted.foreach_get("vector", vectors)
        assert vectors.any()


def test_the_table_of_parameters_names_settings_as_blender_does():
    properties = add_spot().hybrid_quad.bl_rna.properties
    named = set()
    for row in parameter_rows(ROOT):
        for label, name in re.findall(r"\*([^*]+)\* `(\w+)`", row["Blender"]):
            assert properties[name].name == label
            named.add(name)
    places = ("guide_radius", "use_sharp_angle", "use_auto_symmetry")
    assert named >= {"quads", "edge_length", "time_limit", *places}


def add_spot() -> bpy.types.Object:
    """The cow, upright, with a vertex group on her upper half."""
    points, polygons = read_mesh(ROOT / "tests" / "data" / "meshes" / "c3d_spot_triangulated.obj")
    points = np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)
    obj = add_object("Spot", points.tolist(), polygons.vertices.reshape(-1, 3).tolist())
    group = obj.vertex_groups.new(name="Detail")
    group.add(np.flatnonzero(points[:, 2] > 0).tolist(), 1.0, "REPLACE")
    return obj


def points_on_flank(obj: bpy.types.Object) -> list[tuple[float, float, float]]:
    """A stroke: vertices at the side, from front to back."""
    points = np.array([tuple(vertex.co) for vertex in obj.data.vertices])
    wanted = [(1.0, y, 0.0) for y in np.linspace(-0.3, 0.3, 8)]
    return [tuple(points[np.linalg.norm(points - place, axis=1).argmin()]) for place in wanted]
