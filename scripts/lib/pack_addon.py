#!/usr/bin/env python3
"""Packs the add-on and wheels of its compiled part into zips for Blender; needs nothing but Python.

    pack_addon.py extension WHEEL... --output FOLDER      Blender 4.2 and newer: the wheels lie inside, listed in the manifest
    pack_addon.py legacy WHEEL... --output FOLDER         Blender 3.4 to 4.1: their modules lie beside the add-on's files

WHEEL is one of hybrid_quad_native, for a Python that these Blenders ship.
"""

from __future__ import annotations

import argparse
import re
import zipfile
from pathlib import Path

from pack_wheel import write_zip

ADDON = Path(__file__).resolve().parents[2] / "addon" / "hybrid_quad"
MANIFEST = "blender_manifest.toml"
LICENCE = ADDON.parents[1] / "LICENSE"
# Blender's names of the platforms that wheels are made for, by the ends of the wheels' names.
PLATFORMS = {
    "linux-x64": re.compile(r"(many)?linux\w*_x86_64"),
    "windows-x64": re.compile(r"win_amd64"),
    "macos-arm64": re.compile(r"macosx_\d+_\d+_arm64"),
    "macos-x64": re.compile(r"macosx_\d+_\d+_x86_64"),
}
_SKIPPED = {".pyc", ".so", ".pyd"}


def main() -> None:
    """Writes the zip and prints its path."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=["extension", "legacy"])
    parser.add_argument("wheels", nargs="+", type=Path, metavar="WHEEL")
    parser.add_argument("--output", type=Path, required=True)
    args = parser.parse_args()
    args.output.mkdir(parents=True, exist_ok=True)
    platform = platform_of(args.wheels)
    manifest = (ADDON / MANIFEST).read_text(encoding="utf-8")
    version = re.search(r'^version = "(.+)"$', manifest, re.MULTILINE)
    assert version is not None
    content = sources()
    if args.kind == "extension":
        content[MANIFEST] = with_wheels(manifest, platform, args.wheels).encode()
        content.update({f"wheels/{wheel.name}": wheel.read_bytes() for wheel in args.wheels})
        name, folder = f"hybrid_quad-{version[1]}-{platform}.zip", ""
    else:
        # With a manifest Blender 4.2 would take it for an extension, and then its compiled part would be missing.
        del content[MANIFEST]
        content.update(modules(args.wheels))
        name, folder = f"hybrid_quad-{version[1]}-legacy-{platform}.zip", "hybrid_quad/"
    print(write_zip(args.output / name, {folder + path: data for path, data in content.items()}))


def platform_of(wheels: list[Path]) -> str:
    """Blender's name of the one platform that all the wheels are for."""
    tags = {wheel.stem.rpartition("-")[2].partition(".")[0] for wheel in wheels}
    platforms = {name for tag in tags for name, pattern in PLATFORMS.items() if pattern.fullmatch(tag)}
    if len(platforms) != 1 or not all(PLATFORMS[min(platforms)].fullmatch(tag) for tag in tags):
        raise SystemExit(f"wheels for one of {sorted(PLATFORMS)} are needed, not for {sorted(tags)}")
    return platforms.pop()


def sources() -> dict[str, bytes]:
    """The add-on's files but for compiled ones, by name, with the licence."""
    files = sorted(path for path in ADDON.rglob("*") if path.is_file() and path.suffix not in _SKIPPED)
    content = {path.relative_to(ADDON).as_posix(): path.read_bytes() for path in files}
    return {**content, "LICENSE": LICENCE.read_bytes()}


def with_wheels(manifest: str, platform: str, wheels: list[Path]) -> str:
    """The manifest of the extension for one platform: says which wheels there are; what only a build reads is left out."""
    head = manifest.partition("[build]")[0]
    lines = ["wheels = [", *(f'  "./wheels/{wheel.name}",' for wheel in sorted(wheels)), "]"]
    return head + f'platforms = ["{platform}"]\n' + "\n".join(lines) + "\n"


def modules(wheels: list[Path]) -> dict[str, bytes]:
    """The compiled modules in wheels, by name, and once the licences of what is linked in."""
    content = {}
    for wheel in wheels:
        with zipfile.ZipFile(wheel) as archive:
            for name in archive.namelist():
                file = name.rpartition("/")[2]
                if name.startswith("hybrid_quad_native/_native."):
                    content[file] = archive.read(name)
                elif file and ".dist-info/licenses/" in name:
                    content[f"licenses/{file}"] = archive.read(name)
    return content


if __name__ == "__main__":
    main()
