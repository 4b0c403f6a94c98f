#!/usr/bin/env python3
"""Do includes and imports point only where the architecture lets them?

    check_layering.py [REPOSITORY]

C++: a folder of native/hybrid_quad includes only itself and folders that stand before it in native/CMakeLists.txt; of
a stage, others see only its public header, named like its folder, and those listed in PUBLIC_HEADERS.
Python: core/ imports none of bpy, worker/, batch_jobs/, cases/, cli/ and blender/; worker/ and batch_jobs/ none of bpy, each other,
cases/, cli/ and blender/; cases/ none of bpy, worker/, cli/ and blender/; cli/ neither bpy nor blender/; of the rest, only blender/
and batch.py import bpy.

Prints each violation with its file and line; exit status 1 if there is one.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator
from pathlib import Path

FIRST_STAGE = "features"  # the folders before it are tools whose headers everyone may use
# What a stage offers to later ones beside its own function.
PUBLIC_HEADERS = {
    "assemble": {"feature_chains.h"},
    "frame_field": {"guide_map.h", "frame_topology.h", "surface_curvature.h"},
    "periodic_field": {"grid_measure.h", "narrow_strips.h", "phase_graph.h"},
    "singular_patches": {"patch_quads.h"},
    "features": {"crease_normals.h", "curve_counts.h", "features_with_room.h"},
    "sizing": {"asked_lengths.h", "chord_lengths.h", "feature_size.h", "thin_stretch.h"},
}
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
FORBIDDEN_IMPORTS = {
    "core": ("bpy", "worker", "batch_jobs", "cases", "cli", "blender"),
    "worker": ("bpy", "batch_jobs", "cases", "cli", "blender"),
    "batch_jobs": ("bpy", "worker", "cases", "cli", "blender"),
    "cases": ("bpy", "worker", "cli", "blender"),
    "cli": ("bpy", "blender"),
    "": ("bpy",),
}


def main() -> int:
    """Checks the repository and prints what is wrong."""
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent.parent
    problems = [*native_problems(root), *python_problems(root)]
    for problem in problems:
        print(problem)
    return 1 if problems else 0


def folder_order(root: Path) -> list[str]:
    """Folders of native/hybrid_quad in the order in which data flows."""
    text = (root / "native" / "CMakeLists.txt").read_text()
    listed = re.search(r"foreach\(\s*folder\s+IN\s+ITEMS(.*?)\)", text, re.DOTALL)
    if listed is None:
        raise SystemExit("native/CMakeLists.txt: no foreach(folder IN ITEMS ...)")
    return listed.group(1).split()


def native_problems(root: Path) -> Iterator[str]:
    """Includes that point forward, or into another stage's own headers."""
    order = folder_order(root)
    base = root / "native" / "hybrid_quad"
    for file in sorted(base.rglob("*")):
        if file.suffix not in (".h", ".cpp"):
            continue
        folder = file.relative_to(base).parts[0]
        for number, header in _includes(file):
            where = f"{file.relative_to(root)}:{number}"
            if folder not in order:
                yield f"{where}: folder {folder} is not listed in native/CMakeLists.txt"
                break
            problem = _include_problem(header, folder, order)
            if problem:
                yield f"{where}: {problem}"
    for file in sorted((root / "native" / "bindings").glob("*.[hc]*")):
        for number, header in _includes(file):
            parts = header.split("/")
            if len(parts) == 3 and not _is_public(parts[1], parts[2], order):
                yield f"{file.relative_to(root)}:{number}: {header} is not a public header of {parts[1]}"


def _include_problem(header: str, folder: str, order: list[str]) -> str | None:
    parts = header.split("/")
    if parts[0] != "hybrid_quad":
        return None if len(parts) == 1 else f'include "{header}" by its path from native/'
    if len(parts) < 3 or parts[1] not in order:
        return f"{header} is in no folder listed in native/CMakeLists.txt"
    if parts[1] == folder:
        return None
    if order.index(parts[1]) > order.index(folder):
        return f"{folder} must not include {header}: {parts[1]} comes later"
    if not _is_public(parts[1], parts[2], order):
        return f"{header} is not a public header of {parts[1]}"
    return None


def _is_public(folder: str, header: str, order: list[str]) -> bool:
    if folder not in order:
        return False
    is_tool = order.index(folder) < order.index(FIRST_STAGE)
    # The pipeline is the way in; everything it declares is for callers.
    return is_tool or folder == "pipeline" or header == f"{folder}.h" or header in PUBLIC_HEADERS.get(folder, set())


def _includes(file: Path) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(file.read_text().splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1)


def python_problems(root: Path) -> Iterator[str]:
    """Imports that leave the core, or that bring Blender where it does not belong."""
    package = root / "addon" / "hybrid_quad"
    for file in sorted(package.rglob("*.py")):
        parts = file.relative_to(package).parts
        if parts[0] in ("blender", "batch.py"):
            continue
        forbidden = FORBIDDEN_IMPORTS.get(parts[0], FORBIDDEN_IMPORTS[""])
        for number, name in _imports(file):
            if name in forbidden:
                yield f"{file.relative_to(root)}:{number}: {parts[0]} must not import {name}"


def _imports(file: Path) -> Iterator[tuple[int, str]]:
    """First names of what a file imports; of the package's own modules, the first below the package."""
    for node in ast.walk(ast.parse(file.read_text())):
        if isinstance(node, ast.Import):
            for alias in node.names:
                names = alias.name.split(".")
                yield node.lineno, names[1] if names[0] == "hybrid_quad" and len(names) > 1 else names[0]
        elif isinstance(node, ast.ImportFrom):
            names = (node.module or "").split(".")
            if names[0] == "hybrid_quad":
                names = names[1:]
            if names and names[0]:
                yield node.lineno, names[0]
            else:
                yield from ((node.lineno, alias.name) for alias in node.names)


if __name__ == "__main__":
    sys.exit(main())
