"""What the documentation's code finds around it: files in a folder, and the names that pages use without making them."""

from __future__ import annotations

import heapq
import shutil
import subprocess
from pathlib import Path
from typing import Any

import meshio
import numpy as np

import hybrid_quad
from hybrid_quad.core.mesh_io import read_mesh

SAVE_FILE = "import bpy, os; bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath('in.blend'))"


def fill_folder(folder: Path, root: Path, blender: str | None) -> None:
    """Puts Spot in the folder as ``in.obj``, models as the batch pages name them, and the repository's own folders.

    With Blender also files of its start-up scene, whose object is named Cube.
    """
    meshes = root / "tests" / "data" / "meshes"
    for name in ("addon", "tests", "farm"):
        (folder / name).symlink_to(root / name)
    for name in ("models", "props", "heroes", "sets", "shared"):
        (folder / name).mkdir()
    shutil.copy(meshes / "c3d_spot_triangulated.obj", folder / "in.obj")
    for place in ("models", "props"):
        shutil.copy(meshes / "oded_cube.obj", folder / place)
    shutil.copy(meshes / "c3d_spot_triangulated.obj", folder / "models")
    (folder / "shared" / "models").symlink_to(folder / "models")
    small = meshio.read(meshes / "oded_cube.obj")
    small.write(folder / "heroes" / "dragon.ply")
    np.savetxt(folder / "heroes" / "dragon_density.txt", upper_half(small.points))
    vertices, faces = spot(root)
    np.savetxt(folder / "faces.txt", np.flatnonzero(head(vertices, faces)), fmt="%d")
    if blender:
        command = [blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python-expr", SAVE_FILE]
        subprocess.run(command, cwd=folder, check=True, capture_output=True, timeout=120)
        shutil.copy(folder / "in.blend", folder / "sets" / "street.blend")


def names_of(page: str, root: Path) -> dict[str, Any]:
    """What a page's Python takes as given, all of it on Spot."""
    vertices, faces = spot(root)
    if page == "docs/direction-and-size.md":
        size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
        back, belly = path_between(vertices, faces, 1, 2), path_between(vertices, faces, 2, 0)[2:]
        frames = np.zeros((len(vertices), 2, 3))
        frames[vertices[:, 1] > 0.5] = np.array([(1.2, 0, 0), (0, 0.8, 0)])
        return {
            "remesh": remesh_coarsely,
            "guides_from_strokes": hybrid_quad.guides_from_strokes,
            "Stroke": hybrid_quad.Stroke,
            "v": vertices,
            "f": faces,
            "marked": np.stack([back[:-1], back[1:]], axis=1),
            "lines": [vertices[back] + 0.002 * size],
            "painted": upper_half(vertices),
            "asked": frames,
            "crease": back,
            "other": belly,
        }
    if page == "docs/part-of-a-mesh.md":
        return {"hybrid_quad": hybrid_quad, "vertices": vertices, "faces": faces, "part": head(vertices, faces)}
    return {}


def remesh_coarsely(vertices: np.ndarray, faces: np.ndarray, *, quads: int, **wishes: Any) -> hybrid_quad.RemeshResult:
    """With a quarter of the quads, to be quick."""
    return hybrid_quad.remesh(vertices, faces, quads=quads // 4, **wishes)


def spot(root: Path) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (2930, 3) and triangles (5856, 3)."""
    points, polygons = read_mesh(root / "tests" / "data" / "meshes" / "c3d_spot_triangulated.obj")
    return points, polygons.vertices.reshape(-1, 3)


def upper_half(vertices: np.ndarray) -> np.ndarray:
    """A density: 2 above the middle, 1 below."""
    return np.where(vertices[:, 1] > np.median(vertices[:, 1]), 2.0, 1.0)


def head(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """An even number of triangles, as the border of one piece then has an even number of edges."""
    height = vertices[faces].mean(axis=1) @ np.array([0.0, 0.44, -0.9])
    highest = np.argsort(-height, kind="stable")[: len(faces) // 5 // 2 * 2]
    chosen = np.zeros(len(faces), bool)
    chosen[highest] = True
    return chosen


def path_between(vertices: np.ndarray, faces: np.ndarray, begin_axis: int, end_axis: int) -> np.ndarray:
    """Vertices of the shortest way along edges between the farthest points of two axes."""
    begin, end = int(vertices[:, begin_axis].argmax()), int(vertices[:, end_axis].argmax())
    near: dict[int, set[int]] = {}
    for a, b in np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2).tolist():
        near.setdefault(a, set()).add(b)
        near.setdefault(b, set()).add(a)
    before, best, waiting = {begin: begin}, {begin: 0.0}, [(0.0, begin)]
    while waiting:
        length, here = heapq.heappop(waiting)
        if here == end:
            break
        for other in near[here]:
            further = length + float(np.linalg.norm(vertices[here] - vertices[other]))
            if further < best.get(other, np.inf):
                best[other], before[other] = further, here
                heapq.heappush(waiting, (further, other))
    path = [end]
    while path[-1] != begin:
        path.append(before[path[-1]])
    return np.array(path[::-1])
