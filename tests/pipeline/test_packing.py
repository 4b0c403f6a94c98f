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


@pytest.mark.parametrize(
    ("module", "platform", "tag", "blender"),
    [
        ("_native.cpython-310-x86_64-linux-gnu.so", None, "cp310-cp310-linux_x86_64", "linux-x64"),
        ("_native.cp311-win_amd64.pyd", None, "cp311-cp311-win_amd64", "windows-x64"),
        ("_native.cp311-win_amd64.pyd", "win_amd64", "cp311-cp311-win_amd64", "windows-x64"),
        ("_native.cpython-313-darwin.so", "macosx_11_0_arm64", "cp313-cp313-macosx_11_0_arm64", "macos-arm64"),
        ("_native.cpython-313-darwin.so", "macosx_11_0_x86_64", "cp313-cp313-macosx_11_0_x86_64", "macos-x64"),
    ],
)
def test_a_zip_is_for_the_platform_of_its_modules(root, tmp_path, module, platform, tag, blender):
    (tmp_path / module).write_bytes(b"compiled")
    scripts = root / "scripts" / "lib"
    options = ["--platform", platform] if platform else []
    packed = run(
        scripts / "pack_wheel.py", "native", tmp_path / module, *options, "--version", "1.2.3", "--output", tmp_path
    )
    assert Path(packed.stdout.strip()).name == f"hybrid_quad_native-1.2.3-{tag}.whl", packed.stderr
    wheel = tmp_path / f"hybrid_quad_native-1.2.3-{tag}.whl"
    extension = run(scripts / "pack_addon.py", "extension", wheel, "--output", tmp_path)
    assert extension.stdout.strip().endswith(f"-{blender}.zip"), extension.stderr
    with zipfile.ZipFile(extension.stdout.strip()) as archive:
        manifest = archive.read("blender_manifest.toml").decode()
        assert f'platforms = ["{blender}"]' in manifest and f'"./wheels/{wheel.name}"' in manifest
        assert archive.read(f"wheels/{wheel.name}") == wheel.read_bytes()
    legacy = run(scripts / "pack_addon.py", "legacy", wheel, "--output", tmp_path)
    with zipfile.ZipFile(legacy.stdout.strip()) as archive:
        assert archive.read(f"hybrid_quad/{module}") == b"compiled"


@pytest.mark.parametrize(
    ("module", "platform"),
    [
        ("_native.cpython-313-darwin.so", None),  # for which processor?
        ("_native.cpython-313-darwin.so", "win_amd64"),
        ("_native.cp311-win_amd64.pyd", "win_arm64"),
        ("_native.so", None),
        ("_native.pypy310-pp73-x86_64-linux-gnu.so", None),
    ],
)
def test_a_module_of_no_known_platform_is_not_packed(root, tmp_path, module, platform):
    (tmp_path / module).write_bytes(b"compiled")
    script = root / "scripts" / "lib" / "pack_wheel.py"
    options = ["--platform", platform] if platform else []
    done = run(script, "native", tmp_path / module, *options, "--version", "1.2.3", "--output", tmp_path)
    assert done.returncode != 0 and module in done.stderr
    assert not list(tmp_path.glob("*.whl"))


def test_a_zip_is_for_one_platform(root, tmp_path):
    wheels = [tmp_path / f"hybrid_quad_native-1-cp311-cp311-{tag}.whl" for tag in ("win_amd64", "macosx_11_0_arm64")]
    for wheel in wheels:
        zipfile.ZipFile(wheel, "w").close()
    done = run(root / "scripts" / "lib" / "pack_addon.py", "extension", *wheels, "--output", tmp_path)
    assert done.returncode != 0 and "win_amd64" in done.stderr and not list(tmp_path.glob("*.zip"))
