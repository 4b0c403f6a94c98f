import subprocess
import sys


def check(root, tree):
    return subprocess.run(
        [sys.executable, root / "tools" / "check_layering.py", tree], capture_output=True, text=True, timeout=60
    )


def put(tree, path, text):
    file = tree / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)


def small_tree(tree):
    put(
        tree,
        "native/CMakeLists.txt",
        "foreach(folder IN ITEMS\n base mesh\n features sizing\n pipeline)\nendforeach()\n",
    )
    put(tree, "native/hybrid_quad/base/types.h", "#include <vector>\n")
    put(tree, "native/hybrid_quad/sizing/sizing.cpp", '#include "hybrid_quad/features/features.h"\n')
    put(tree, "addon/hybrid_quad/core/remesh.py", "from . import errors\nimport numpy\n")
    put(tree, "addon/hybrid_quad/blender/panels.py", "import bpy\n")


def test_this_repository(root):
    done = check(root, root)
    assert done.returncode == 0, done.stdout


def test_a_sound_tree_passes(root, tmp_path):
    small_tree(tmp_path)
    done = check(root, tmp_path)
    assert (done.returncode, done.stdout) == (0, "")


def test_each_wrong_way_is_found(root, tmp_path):
    small_tree(tmp_path)
    put(tmp_path, "native/hybrid_quad/base/a.h", '#include "hybrid_quad/mesh/mesh.h"\n')
    put(tmp_path, "native/hybrid_quad/features/b.cpp", '// text\n#include "hybrid_quad/sizing/sizing.h"\n')
    put(tmp_path, "native/hybrid_quad/sizing/c.cpp", '#include "hybrid_quad/features/corners.h"\n')
    put(tmp_path, "native/hybrid_quad/unlisted/d.h", '#include "hybrid_quad/base/types.h"\n')
    put(tmp_path, "native/bindings/module.cpp", '#include "hybrid_quad/features/corners.h"\n')
    put(tmp_path, "addon/hybrid_quad/core/e.py", "def f():\n    import bpy.types\n")
    put(tmp_path, "addon/hybrid_quad/core/f.py", "from ..blender import panels\n")
    put(tmp_path, "addon/hybrid_quad/core/g.py", "from hybrid_quad import cli\n")
    put(tmp_path, "addon/hybrid_quad/core/i.py", "from ..worker import process\n")
    put(tmp_path, "addon/hybrid_quad/worker/j.py", "from ..blender import panels\n")
    put(tmp_path, "addon/hybrid_quad/cli/h.py", "from .. import blender\n")
    put(tmp_path, "addon/hybrid_quad/__init__.py", "import bpy\n")
    done = check(root, tmp_path)
    assert done.returncode == 1
    lines = done.stdout.splitlines()
    for file in ("base/a.h:1", "features/b.cpp:2", "sizing/c.cpp:1", "unlisted/d.h:1", "module.cpp:1"):
        assert sum(file in line for line in lines) == 1, (file, lines)
    for file in (
        "core/e.py:2",
        "core/f.py:1",
        "core/g.py:1",
        "core/i.py:1",
        "worker/j.py:1",
        "cli/h.py:1",
        "__init__.py:1",
    ):
        assert sum(file in line for line in lines) == 1, (file, lines)
    assert len(lines) == 12
