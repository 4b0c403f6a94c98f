"""The zips that people install, in a Blender of their own with empty folders: the one that runs these tests."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import bpy
import pytest

import hybrid_quad
from hybrid_quad.core import native

HERE = Path(__file__).resolve().parent
SCRIPTS = HERE.parents[1] / "scripts" / "lib"
HAS_EXTENSIONS = bpy.app.version >= (4, 2, 0)
RELEASED = os.environ.get("HQ_ZIPS", "")
FITS_LEGACY = not RELEASED or sys.version_info < (3, 12)
KINDS = [
    pytest.param("legacy", marks=pytest.mark.skipif(not FITS_LEGACY, reason="a release's is for Pythons up to 3.11")),
    pytest.param("extension", marks=pytest.mark.skipif(not HAS_EXTENSIONS, reason="Blender 4.2")),
]
PYTHONS = 2 if RELEASED else 1  # that a zip is for
CHECKER = Path(bpy.utils.resource_path("LOCAL"), "scripts", "addons_core", "bl_pkg", "cli", "blender_ext.py")


def python(*words):
    """Runs a script of the repository by a Python that is not Blender."""
    program = os.path.join(sys.prefix, "bin", f"python{sys.version_info[0]}.{sys.version_info[1]}")
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout.strip()


@pytest.fixture(scope="module")
def zips(tmp_path_factory):
    """The zip of each kind, of the compiled module that these tests use, or of a release in the folder HQ_ZIPS."""
    if RELEASED:
        released = Path(RELEASED)
        number = hybrid_quad.__version__
        return {
            "legacy": released / f"hybrid_quad-{number}-legacy-linux-x64.zip",
            "extension": released / f"hybrid_quad-{number}-linux-x64.zip",
        }
    folder = tmp_path_factory.mktemp("zips")
    module = native.load().__file__
    wheel = python(
        SCRIPTS / "pack_wheel.py", "native", module, "--version", hybrid_quad.__version__, "--output", folder
    )
    return {
        kind: Path(python(SCRIPTS / "pack_addon.py", kind, wheel, "--output", folder))
        for kind in ("legacy", "extension")
    }


def in_blender(path, kind, case, folder):
    """What install_in_blender.py prints in a new Blender; it must end well."""
    names = ["RESOURCES", "CONFIG", "SCRIPTS", "DATAFILES", "EXTENSIONS"]
    own = {f"BLENDER_USER_{name}": str(folder / name.lower()) for name in names}
    for place in own.values():
        Path(place).mkdir()
    own["HQ_USER_FOLDER"] = str(folder)
    environment = {name: text for name, text in os.environ.items() if name not in ("PYTHONPATH", "HQ_ADDON_PARENT")}
    script = str(HERE / "install_in_blender.py")
    if bpy.app.binary_path:
        options = ["-b", "--factory-startup", "--python-exit-code", "1", "-P", script, "--"]
        command = [bpy.app.binary_path, *options]
    else:
        command = [sys.executable, "-s", script]
    words = [*command, str(path), kind, case]
    done = subprocess.run(words, capture_output=True, text=True, timeout=240, env={**environment, **own}, cwd=folder)
    assert done.returncode == 0 and f"INSTALLED {case}" in done.stdout, done.stdout + done.stderr
    assert "Traceback" not in done.stderr, done.stderr


@pytest.mark.parametrize("kind", KINDS)
def test_installed_it_remeshes_and_leaves_nothing_behind(zips, kind, tmp_path):
    in_blender(zips[kind], kind, "works", tmp_path)


@pytest.mark.parametrize("kind", KINDS)
def test_without_the_compiled_part_it_says_so(zips, kind, tmp_path):
    bare = tmp_path / "bare.zip"
    with zipfile.ZipFile(zips[kind]) as whole, zipfile.ZipFile(bare, "w") as rest:
        for name in whole.namelist():
            data = whole.read(name)
            if name.endswith("blender_manifest.toml"):
                data = data.partition(b"wheels = [")[0]
            if not name.endswith((".so", ".whl")):
                rest.writestr(name, data)
    in_blender(bare, kind, "native_part_missing", tmp_path)


@pytest.mark.skipif(not CHECKER.is_file(), reason="Blender 4.2")
def test_blender_s_checker_finds_the_extension_valid(zips):
    assert "Success" in python(CHECKER, "validate", zips["extension"])


def test_a_zip_has_what_it_needs_and_nothing_else(zips):
    extension, legacy = (zipfile.ZipFile(zips[kind]).namelist() for kind in ("extension", "legacy"))
    assert all(name.startswith("hybrid_quad/") for name in legacy)
    modules = [name for name in legacy if name.endswith(".so")]
    assert len(modules) == PYTHONS and all(name.startswith("hybrid_quad/_native.") for name in modules)
    assert RELEASED or f"hybrid_quad/{Path(native.load().__file__).name}" in modules
    assert sum(name.endswith(".whl") for name in extension) == PYTHONS
    for names in (extension, legacy):
        assert not [name for name in names if "__pycache__" in name or "\\" in name]
    # A manifest makes an extension of a zip, and that needs wheels.
    assert "blender_manifest.toml" in extension and "hybrid_quad/blender_manifest.toml" not in legacy
