#!/usr/bin/env python3
"""Damaged mesh files: each is read, or refused with a MeshFileError that names it; nothing else may come of it.

fuzz_readers.py [--seconds S] [--first SEED] [--out DIR]
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
import time
import traceback
from collections import Counter
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from hybrid_quad.core.file_places import MeshFileError  # noqa: E402
from hybrid_quad.core.mesh_io import read_mesh  # noqa: E402
from hybrid_quad.core.wish_files import read_line_elements  # noqa: E402
from support import surfaces  # noqa: E402

OBJ = b"""# a comment
v 0 0 0 0.1 0.2 0.3
v 1 0 0
v 1 1 0
v 0 1e0 -0.0
vt 0 0
vn 0 0 1
g part
f 1/1/1 2//1 3 4
f -4 -3 \\
 -2
l 1 2 3
"""
OFF = b"OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 255 0 0\n# more\n3 0 2 3\n"
PLY = b"""ply
format ascii 1.0
comment made by hand
element vertex 4
property float x
property float y
property float z
property uchar red
element face 2
property list uchar int vertex_indices
end_header
0 0 0 1
1 0 0 2
1 1 0 3
0 1 0 4
3 0 1 2
4 0 1 2 3
"""
STL = b"""solid s
facet normal 0 0 1
 outer loop
  vertex 0 0 0
  vertex 1 0 0
  vertex 0 1 0
 endloop
endfacet
endsolid s
"""
WORDS = [
    b"nan",
    b"-inf",
    b"1e999",
    b"-1",
    b"0",
    b"99999999999999999999",
    b"4294967296",
    b"f",
    b"v ",
    b"\n",
    b"\r\n",
    b"\x00",
    b"/",
    b"\\\n",
    b"\xff\xfe",
    b"list",
    b"binary_little_endian",
]


def binary_ply() -> bytes:
    """A binary file with two triangles."""
    head = (
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    )
    head += "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], "<f4").tobytes()
    faces = b"".join(b"\x03" + np.array(face, "<i4").tobytes() for face in ([0, 1, 2], [0, 2, 3]))
    return head.encode() + points + faces


def binary_stl() -> bytes:
    """A binary file of a small box."""
    vertices, faces = surfaces.box(1)
    triangles = b"".join(
        np.concatenate([np.zeros((1, 3)), vertices[face]]).astype("<f4").tobytes() + b"\0\0" for face in faces
    )
    return b"\0" * 80 + np.array([len(faces)], "<u4").tobytes() + triangles


SEEDS = [(".obj", OBJ), (".off", OFF), (".ply", PLY), (".ply", binary_ply()), (".stl", STL), (".stl", binary_stl())]


def damaged(seed: int) -> tuple[str, bytes]:
    """A format and a file of it with some bytes changed, cut, doubled or put in; the same for the same number."""
    random = np.random.default_rng(seed)
    suffix, data = SEEDS[random.integers(len(SEEDS))]
    for _ in range(random.integers(1, 6)):
        at = int(random.integers(len(data) + 1))
        size = int(random.integers(1, 12))
        choice = random.integers(5)
        if choice == 0:
            data = data[:at] + bytes(random.integers(0, 256, size, dtype=np.uint8)) + data[at + size :]
        elif choice == 1:
            data = data[:at] + WORDS[random.integers(len(WORDS))] + data[at:]
        elif choice == 2:
            data = data[:at] + data[at + size :]
        elif choice == 3:
            data = data[:at] + data[at : at + 4 * size] + data[at:]
        else:
            data = data[: max(1, at)]
    return suffix, data


def verdict_on(path: Path) -> str:
    """ "read", "refused", or what went wrong."""
    try:
        vertices, polygons = read_mesh(path)
        read_line_elements(path)
    except MeshFileError as error:
        return "refused" if path.name in str(error) else f"the message does not name the file: {error}"
    except BaseException:
        return traceback.format_exc()
    if vertices.dtype != np.float64 or vertices.shape != (len(vertices), 3):
        return f"vertices of shape {vertices.shape}"
    if polygons.sizes.sum() != len(polygons.vertices):
        return "sizes and corners disagree"
    return "read"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--first", type=int, default=0, metavar="SEED")
    parser.add_argument("--out", type=Path, default=HERE.parents[1] / "out" / "fuzz" / "files")
    arguments = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
    outcomes: Counter[str] = Counter()
    begin, seed = time.monotonic(), arguments.first
    with tempfile.TemporaryDirectory() as folder:
        while time.monotonic() - begin < arguments.seconds:
            suffix, data = damaged(seed)
            path = Path(folder) / f"damaged{suffix}"
            path.write_bytes(data)
            verdict = verdict_on(path)
            if verdict in ("read", "refused"):
                outcomes[verdict] += 1
            else:
                outcomes["wrong"] += 1
                print(f"{seed}: {verdict}", flush=True)
                arguments.out.mkdir(parents=True, exist_ok=True)
                (arguments.out / f"{seed}{suffix}").write_bytes(data)
            seed += 1
    print(f"{outcomes.total()} files in {time.monotonic() - begin:.0f} s: {dict(outcomes)}")
    return int(outcomes["wrong"] > 0)


if __name__ == "__main__":
    sys.exit(main())
