import subprocess
import sys
from pathlib import Path

import pytest

import hybrid_quad


def run(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)


def test_import_needs_neither_blender_nor_what_only_files_need():
    code = (
        "import sys\n"
        "for name in ('bpy', 'meshio', 'tqdm'): sys.modules[name] = None\n"
        "import hybrid_quad\n"
        "hybrid_quad.remesh, hybrid_quad.check, hybrid_quad.RemeshOptions\n"
    )
    done = run(code)
    assert done.returncode == 0, done.stderr


def test_the_command_answers_interruptions_before_it_loads_anything_else():
    code = (
        f"import os, sys; sys.path.insert(0, {str(Path(hybrid_quad.__file__).parents[1])!r}); before = set(sys.modules)\n"
        "import hybrid_quad.cli.program\n"
        "print(*(name for name in set(sys.modules) - before if not name.startswith('hybrid_quad')))\n"
    )
    done = subprocess.run([sys.executable, "-I", "-S", "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stdout.split() == ["__future__"], done.stderr


def test_a_missing_compiled_part_is_explained_when_it_is_needed():
    code = (
        "import sys, hybrid_quad\n"
        "sys.modules['hybrid_quad._native'] = None\n"
        "try: hybrid_quad.check([], [])\n"
        "except ImportError as error: print(error)\n"
    )
    done = run(code)
    assert "pip install" in done.stdout, done.stderr


def test_public_names():
    for name in hybrid_quad.__all__:
        assert getattr(hybrid_quad, name).__doc__
        assert name in dir(hybrid_quad)
    with pytest.raises(AttributeError, match="nothing_like_it"):
        _ = hybrid_quad.nothing_like_it


def test_one_version():
    from importlib import metadata

    try:
        installed = metadata.version("hybrid-quad")
    except metadata.PackageNotFoundError:
        pytest.skip("the package is used from the source tree")
    assert installed == hybrid_quad.__version__
