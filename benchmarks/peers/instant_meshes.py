"""Instant Meshes, by the package pynanoinstantmeshes: instant_meshes.py IN.obj QUADS OUT.obj [sharp].

The package cuts every polygon into quads by its middle, so that a fourth of the quads is asked for. With `sharp`, edges that
bend by more than 30 degrees are creases. Prints the wall and processor seconds of the call alone, without reading, writing
and Python's start.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import numpy as np
import pynanoinstantmeshes
from wavefront import read_triangles, write_polygons

CREASE_DEGREES, NO_CREASES = 30.0, -1.0  # the package takes zero, which makes a crease of every edge
SMOOTHING = 2  # as Instant Meshes has it where nothing is said; the package has none


def main() -> None:
    """Remeshes one triangle mesh."""
    source, quads, target = Path(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    vertices, faces = read_triangles(source)
    points, triangles = vertices.astype(np.float32), faces.astype(np.uint32)
    creases = CREASE_DEGREES if "sharp" in sys.argv[4:] else NO_CREASES
    wall, cpu = time.perf_counter(), time.process_time()
    points, polygons = pynanoinstantmeshes.remesh(
        points, triangles, -1, face_count=quads // 4, smooth_iter=SMOOTHING, creaseAngle=creases
    )
    print(json.dumps({"call_seconds": time.perf_counter() - wall, "call_cpu_seconds": time.process_time() - cpu}))
    write_polygons(target, points, polygons)


main()
