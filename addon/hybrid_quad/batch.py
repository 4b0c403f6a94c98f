"""Remeshes an object of a Blender file without a window.

    blender -b FILE.blend --python-exit-code 1 -P batch.py -- --object NAME --quads N --output OUT.blend

``-- --help`` lists all options. Works with the add-on installed or not: it uses the folder that this file lies in.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from types import ModuleType

import bpy


def main() -> int:
    """Runs the command behind ``--`` and returns its exit status."""
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    package = _enabled_package() or _package_of_this_folder()
    command = importlib.import_module(f"{package.__name__}.blender.command")
    if hasattr(bpy.types.Object, "hybrid_quad"):
        return int(command.main(arguments))
    package.register()
    try:
        return int(command.main(arguments))
    finally:
        # Some Blenders crash at exit over classes that are still registered.
        package.unregister()


def _enabled_package() -> ModuleType | None:
    """The add-on as Blender has loaded it, whatever its name there (extensions live in packages of their own)."""
    if not hasattr(bpy.types.Object, "hybrid_quad"):
        return None
    for name, module in list(sys.modules.items()):
        if name.rpartition(".")[2] == "hybrid_quad" and hasattr(module, "bl_info"):
            return module
    return None


def _package_of_this_folder() -> ModuleType:
    folder = os.path.dirname(os.path.abspath(__file__))
    spec = importlib.util.spec_from_file_location(
        "hybrid_quad", os.path.join(folder, "__init__.py"), submodule_search_locations=[folder]
    )
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["hybrid_quad"] = module
    spec.loader.exec_module(module)
    return module


if __name__ == "__main__":
    status = main()
    if not bpy.app.binary_path:
        # bpy 4.2 as a Python module can crash while it shuts down after classes were registered, even where they are gone
        # again. Everything is written by now.
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    if status:
        sys.exit(status)
