"""Instant Meshes, by the package pynanoinstantmeshes: instant_meshes.py IN.obj QUADS OUT.obj.

The package cuts every polygon into quads by its middle, so that a fourth of the quads is asked for.
Prints the wall and processor seconds of the call alone, without reading, writing and Python's start.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import numpy as np
import pynanoinstantmeshes


def main() -> None:
    """Remeshes one triangle mesh."""
    source, quads, target = Path(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    vertices, faces = [], []
    for line in source.read_text().splitlines():
        words = line.split()
        if words and words[0] == "v":
            vertices.append(words[1:4])
        elif words and words[0] == "f":
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:4]])
    points, triangles = np.array(vertices, dtype=np.float32), np.array(faces, dtype=np.uint32)
    wall, cpu = time.perf_counter(), time.process_time()
    points, polygons = pynanoinstantmeshes.remesh(points, triangles, -1, face_count=quads // 4)
    print(json.dumps({"call_seconds": time.perf_counter() - wall, "call_cpu_seconds": time.process_time() - cpu}))
    with target.open("w") as file:
        file.writelines(f"v {x} {y} {z}\n" for x, y, z in points)
        file.writelines("f " + " ".join(str(v + 1) for v in polygon) + "\n" for polygon in polygons)


main()
