"""Quads by Gmsh: gmsh_quads.py IN.obj QUADS OUT.obj [sharp].

The surface is cut into patches at sharp edges, which Gmsh parameterizes and meshes with its frontal algorithm for quads;
recombination (blossom) makes quads of most triangles, and one subdivision makes them of the rest. Prints the wall and
processor seconds of that, without reading and writing.
"""

from __future__ import annotations

import json
import math
import sys
import time
from pathlib import Path

import gmsh
import numpy as np
from wavefront import read_triangles, write_polygons

FRONTAL_QUADS, BLOSSOM, ALL_QUADS = (
    8,
    1,
    1,
)  # of Gmsh's options Mesh.Algorithm, RecombinationAlgorithm, SubdivisionAlgorithm
SHARP_DEGREES, SMOOTH_DEGREES = 40.0, 180.0
TRIES = 3


def main() -> None:
    """Remeshes one triangle mesh."""
    source, quads, target = Path(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    points, triangles = read_triangles(source)
    corners = points[triangles]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    surface = gmsh.model.addDiscreteEntity(2)
    gmsh.model.mesh.addNodes(2, surface, list(range(1, len(points) + 1)), points.ravel())
    gmsh.model.mesh.addElementsByType(surface, 2, [], (triangles + 1).ravel())
    wall, cpu = time.perf_counter(), time.process_time()
    angle = SHARP_DEGREES if "sharp" in sys.argv[4:] else SMOOTH_DEGREES
    gmsh.model.mesh.classifySurfaces(math.radians(angle), True, True, math.pi)
    gmsh.model.mesh.createGeometry()
    gmsh.model.geo.synchronize()
    for name, value in (
        ("MeshSizeExtendFromBoundary", 0),
        ("Algorithm", FRONTAL_QUADS),
        ("RecombineAll", 1),
        ("RecombinationAlgorithm", BLOSSOM),
        ("SubdivisionAlgorithm", ALL_QUADS),
    ):
        gmsh.option.setNumber(f"Mesh.{name}", value)
    size = 2 * math.sqrt(area / quads)  # subdivision halves the edges
    for _ in range(TRIES):  # Gmsh knows sizes, no numbers
        gmsh.option.setNumber("Mesh.MeshSizeMin", size)
        gmsh.option.setNumber("Mesh.MeshSizeMax", size)
        gmsh.model.mesh.generate(2)
        made = sum(len(tags) for tags in gmsh.model.mesh.getElements(2)[1])
        size *= math.sqrt(made / quads)
    print(json.dumps({"call_seconds": time.perf_counter() - wall, "call_cpu_seconds": time.process_time() - cpu}))
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    number = {tag: index for index, tag in enumerate(tags.tolist())}
    polygons = []
    for kind, _, nodes in zip(*gmsh.model.mesh.getElements(2), strict=True):
        width = {2: 3, 3: 4}[kind]
        polygons += [[number[tag] for tag in row] for row in nodes.reshape(-1, width).tolist()]
    write_polygons(target, coordinates.reshape(-1, 3), polygons)


main()
