"""Runs this folder's tests inside Blender.

    blender -b --factory-startup --python-exit-code 1 -P tests/addon/run_in_blender.py -- [pytest options]
    python tests/addon/run_in_blender.py [pytest options]            with the package bpy from PyPI

The folder with ``hybrid_quad`` is addon/, or the one named by HQ_ADDON_PARENT.
"""

from __future__ import annotations

import os
import sys

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))


def main() -> int:
    # Blender's program passes on what stands behind "--".
    behind = sys.argv.index("--") + 1 if "--" in sys.argv else len(sys.argv)
    options = sys.argv[behind if bpy.app.binary_path else 1 :]
    # Blender's own Python need not have pytest: scripts/test names a folder that does.
    sys.path[:0] = [path for path in os.environ.get("HQ_TEST_PACKAGES", "").split(os.pathsep) if path]
    sys.path.insert(0, os.environ.get("HQ_ADDON_PARENT", os.path.join(HERE, "..", "..", "addon")))
    sys.path.append(os.path.join(HERE, ".."))  # support/
    import pytest

    # The repository's pytest options are for the tests that run outside Blender.
    base = ["-c", os.path.join(HERE, "pytest.ini"), "--rootdir", HERE, "-p", "no:cacheprovider"]
    return int(pytest.main([*base, *(options or ["-q"]), HERE]))


if __name__ == "__main__":
    status = main()
    sys.stdout.flush()
    sys.stderr.flush()
    # Straight out: some Blenders crash or hang while Python winds down.
    os._exit(status)
