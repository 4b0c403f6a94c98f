"""Wavefront files for peers that know nothing of this package."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np


def read_triangles(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) positions and (m, 3) 0-based triangles."""
    vertices, faces = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words and words[0] == "v":
            vertices.append([float(word) for word in words[1:4]])
        elif words and words[0] == "f":
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
    return np.array(vertices), np.array(faces)


def write_polygons(path: Path, points: np.ndarray, polygons: Iterable[Sequence[int]]) -> None:
    """Writes polygons by 0-based vertices."""
    with path.open("w") as file:
        file.writelines(f"v {x} {y} {z}\n" for x, y, z in points)
        file.writelines("f " + " ".join(str(v + 1) for v in polygon) + "\n" for polygon in polygons)
