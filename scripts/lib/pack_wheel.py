#!/usr/bin/env python3
"""Packs compiled modules into wheels; needs nothing but Python.

    pack_wheel.py native MODULE... --version 0.1.0 --licences FOLDER --output FOLDER
    pack_wheel.py package MODULE... --base hybrid_quad-0.1.0-py3-none-any.whl --licences FOLDER --output FOLDER

MODULE is a file such as ``_native.cpython-311-x86_64-linux-gnu.so`` or ``_native.cp311-win_amd64.pyd``; each gives a wheel
for the Python in its name. For macOS ``--platform`` says the processor and the oldest system, such as ``macosx_11_0_arm64``.
``native``: the wheel hybrid_quad_native, only the module, which Blender's extension brings along.
``package``: the whole Python package, made of a wheel without any compiled part.

Wheels for Linux are tagged ``linux_x86_64``; which glibc they need is for auditwheel to say.
"""

from __future__ import annotations

import argparse
import base64
import hashlib
import re
import zipfile
from pathlib import Path

# The Python, and for Linux and Windows the processor.
_MODULES = {
    "linux_": re.compile(r"_native\.cpython-(3\d+)-(\w+)-linux-gnu\.so"),
    "win_": re.compile(r"_native\.cp(3\d+)-win_(\w+)\.pyd"),
    "macosx_": re.compile(r"_native\.cpython-(3\d+)-darwin\.so()"),
}
COMPILED = (".so", ".pyd")
_MADE_AT = (1980, 1, 1, 0, 0, 0)  # the same bytes whenever it is packed
NATIVE_PACKAGE = '"""The compiled part of hybrid_quad; use it through that package."""\n'


def main() -> None:
    """Writes the wheels and prints their paths."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=["native", "package"])
    parser.add_argument("modules", nargs="+", type=Path, metavar="MODULE")
    parser.add_argument("--version", help="of the wheels (native)")
    parser.add_argument("--base", type=Path, help="wheel without a compiled part (package)")
    parser.add_argument("--platform", help="as a wheel's name says it (macOS)")
    parser.add_argument("--licences", type=Path, help="folder with the licences of what is linked in")
    parser.add_argument("--output", type=Path, required=True)
    args = parser.parse_args()
    if (args.version is None) == (args.kind == "native") or (args.base is None) == (args.kind == "package"):
        parser.error("native takes --version, package takes --base")
    args.output.mkdir(parents=True, exist_ok=True)
    for module in args.modules:
        tag = wheel_tag(module, args.platform)
        content = native_content(args.version) if args.kind == "native" else package_content(args.base)
        print(write_wheel(content, module, tag, args.licences, args.output))


def wheel_tag(module: Path, platform: str | None = None) -> str:
    """Python, ABI and platform of a module, for example ``cp311-cp311-linux_x86_64``.

    Parameters
    ----------
    platform : str, optional
        For macOS, where a module's name does not say it, for example ``macosx_11_0_arm64``.
    """
    for system, pattern in _MODULES.items():
        match = pattern.fullmatch(module.name)
        if match is None:
            continue
        named = platform or (system + match[2] if match[2] else "")
        if not named.startswith(system) or not named.endswith(match[2]):
            raise SystemExit(f"{module}: its platform is {system}..., not {named or 'known'}: see --platform")
        return f"cp{match[1]}-cp{match[1]}-{named}"
    raise SystemExit(f"{module}: not a module of CPython for Linux, Windows or macOS")


def native_content(version: str) -> dict[str, bytes]:
    """Files of the wheel hybrid_quad_native but for the module, by name."""
    metadata = f"Metadata-Version: 2.1\nName: hybrid-quad-native\nVersion: {version}\n"
    metadata += "Summary: The compiled part of hybrid_quad, as Blender's extensions bring it along\n"
    metadata += "License: GPL-3.0-or-later\nRequires-Python: >=3.10\n"
    return {
        "hybrid_quad_native/__init__.py": NATIVE_PACKAGE.encode(),
        f"hybrid_quad_native-{version}.dist-info/METADATA": metadata.encode(),
    }


def package_content(base: Path) -> dict[str, bytes]:
    """Files of a wheel that has no compiled part, by name."""
    with zipfile.ZipFile(base) as archive:
        content = {name: archive.read(name) for name in archive.namelist() if not name.endswith("/")}
    compiled = [name for name in content if name.endswith(COMPILED)]
    if compiled:
        raise SystemExit(f"{base}: has a compiled part already: {compiled}")
    return {name: data for name, data in content.items() if not name.endswith(("/RECORD", "/WHEEL"))}


def write_wheel(content: dict[str, bytes], module: Path, tag: str, licences: Path | None, output: Path) -> Path:
    """Adds the module, the licences and what a wheel says of itself."""
    info = next(name for name in content if name.endswith(".dist-info/METADATA")).partition("/")[0]
    name = info.removesuffix(".dist-info")
    package = name.partition("-")[0]
    content = {**content, f"{package}/{module.name}": module.read_bytes()}
    for licence in sorted(licences.iterdir()) if licences else ():
        content[f"{info}/licenses/{licence.name}"] = licence.read_bytes()
    about = f"Wheel-Version: 1.0\nGenerator: hybrid_quad pack_wheel\nRoot-Is-Purelib: false\nTag: {tag}\n"
    content[f"{info}/WHEEL"] = about.encode()
    rows = [f"{path},sha256={digest(data)},{len(data)}" for path, data in content.items()]
    content[f"{info}/RECORD"] = "\n".join([*rows, f"{info}/RECORD,,", ""]).encode()
    wheel = output / f"{name}-{tag}.whl"
    return write_zip(wheel, content)


def write_zip(path: Path, content: dict[str, bytes]) -> Path:
    """A zip of files by name."""
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in content.items():
            entry = zipfile.ZipInfo(name, _MADE_AT)
            entry.external_attr = (0o755 if name.endswith(COMPILED) else 0o644) << 16
            archive.writestr(entry, data, zipfile.ZIP_DEFLATED)
    return path


def digest(data: bytes) -> str:
    """As a wheel's RECORD has it."""
    return base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


if __name__ == "__main__":
    main()
