"""What the command says on the error stream."""

from __future__ import annotations

import contextlib
import sys
from typing import Any, TextIO

from ..core.errors import InputError

_SHOWN = 10


def say(text: str) -> None:
    """One message on the error stream, under the program's name."""
    write_error(f"hybrid-quad: {text}\n")


def write_error(text: str) -> None:
    """Lines on the error stream; lost where there is none, or it takes nothing: what is said decides about no run."""
    if sys.stderr is not None:
        with contextlib.suppress(OSError, ValueError):  # ValueError: closed
            sys.stderr.write(text)
            sys.stderr.flush()


def show(text: str) -> None:
    """One line of what was asked for, on the output stream; letters that it lacks, as of a file's name, as numbers.

    Raises
    ------
    OSError
        If the stream takes nothing; names it.
    """
    try:
        print(_in_encoding(text, sys.stdout), flush=True)
    except OSError as error:
        raise OSError(error.errno, error.strerror, "standard output") from error


def _in_encoding(text: str, stream: TextIO | None) -> str:
    if stream is None:
        return text
    try:
        text.encode(stream.encoding, stream.errors or "strict")
    except UnicodeEncodeError:
        return text.encode(stream.encoding, "backslashreplace").decode(stream.encoding)
    return text


def list_elements(kind: str, elements: list[str]) -> str:
    """For example ``"faces 3, 8, 10 ... (217 in all)"``; empty for no elements."""
    if not elements:
        return ""
    plural = {"vertex": "vertices"}.get(kind, f"{kind}s") if len(elements) > 1 else kind
    more = f" ... ({len(elements)} in all)" if len(elements) > _SHOWN else ""
    return f"{plural} {', '.join(elements[:_SHOWN])}{more}"


def describe_elements(error: InputError) -> str:
    """The elements an error names, counted from 0, in parentheses, or an empty string."""
    names = [str(element) for element in error.elements]
    if error.element_kind == "edge":
        names = [f"{a}-{b}" for a, b in zip(names[0::2], names[1::2], strict=True)]
    text = list_elements(error.element_kind, names)
    return f" ({text}, counted from 0)" if text else ""


def describe_symmetry(symmetry: dict[str, Any]) -> str:
    """One line for the report's ``symmetry``: the planes used, and how symmetric the surface is about each."""
    parts = [
        f"{axis} {deviation['max']:.3g} %{' (used)' if axis in symmetry['planes'] else ''}"
        for axis, deviation in symmetry["deviation_percent"].items()
    ]
    return f"deviation from symmetry, of the diagonal: {', '.join(parts)}"


def verdict_on(defect: dict[str, Any]) -> str:
    """What remesh does about a defect in its JSON form."""
    if not defect["repairable"]:
        return "remesh refuses it"
    return "left by remesh" if defect["kept"] else "repaired by remesh"


def what_became_of(defect: dict[str, Any]) -> str:
    """Of a defect that a run found, in its JSON form: "repaired", or "left as it is"."""
    return "left as it is" if defect["kept"] else "repaired"


def describe_defect(defect: dict[str, Any], verdict: str = "") -> str:
    """One line for a defect in its JSON form: what, where, and what becomes of it."""
    elements = defect["elements"]
    names = [f"{e[0]}-{e[1]}" if defect["element_kind"] == "edge" else str(e) for e in elements]
    where = list_elements(defect["element_kind"], names)
    remedy = f"{verdict}: {defect['remedy']}" if verdict else defect["remedy"]
    return f"{defect['code']}: {'; '.join(part for part in (where, remedy) if part)}"
