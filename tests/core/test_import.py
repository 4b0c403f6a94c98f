import subprocess
import sys

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
