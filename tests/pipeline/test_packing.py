"""Wheels as the scripts pack them, of the module that these tests use."""

import base64
import csv
import hashlib
import io
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import hybrid_quad
from hybrid_quad.core import native


def run(*words, **options):
    return subprocess.run([sys.executable, *map(str, words)], capture_output=True, text=True, timeout=120, **options)


@pytest.fixture(scope="module")
def wheel(root, tmp_path_factory):
    """The compiled part alone."""
    folder = tmp_path_factory.mktemp("wheel")
    script = root / "scripts" / "lib" / "pack_wheel.py"
    done = run(script, "native", native.load().__file__, "--version", "1.2.3", "--output", folder)
    assert done.returncode == 0, done.stderr
    return Path(done.stdout.strip())


def test_the_record_lists_every_file_with_its_hash(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        rows = list(csv.reader(io.StringIO(archive.read("hybrid_quad_native-1.2.3.dist-info/RECORD").decode())))
        assert sorted(row[0] for row in rows) == sorted(names)
        for name, value, size in rows:
            if name.endswith("/RECORD"):
                continue
            data = archive.read(name)
            expected = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            assert (value, size) == (f"sha256={expected}", str(len(data)))


def test_pip_takes_it_for_this_python(wheel):
    done = run("-m", "pip", "install", "--dry-run", "--no-deps", "--no-index", wheel)
    if "No module named pip" in done.stderr:
        pytest.skip("no pip")
    assert "hybrid-quad-native-1.2.3" in done.stdout.replace("_", "-"), done.stderr


def test_under_another_name_the_package_finds_it_and_raises_its_own_errors(wheel, tmp_path):
    """As in Blender, where extensions are packages within packages."""
    inner = tmp_path / "outer" / "renamed"
    ignored = shutil.ignore_patterns("_native*", "__pycache__")
    shutil.copytree(Path(hybrid_quad.__file__).parent, inner, ignore=ignored)
    (inner.parent / "__init__.py").touch()
    code = (
        "import outer.renamed as package\n"
        "from outer.renamed.core.errors import InputError\n"
        "square = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]\n"
        "print(len(package.remesh(square, [(0, 1, 2, 3)], quads=100).quads))\n"
        "try: package.remesh(square, [(0, 1, 1)], quads=100)\n"
        "except InputError as error: print('refused', error.code)\n"
    )
    missing = run("-c", code, cwd=tmp_path)
    assert "install the zip for this version of Blender" in missing.stderr
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
    done = run("-c", code, cwd=tmp_path)
    words = done.stdout.split()
    assert words[1] == "refused" and 50 < int(words[0]) < 200, done.stdout + done.stderr
