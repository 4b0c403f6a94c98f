"""Settings of an asset: names of `hybrid-quad remesh`'s options with underscores, values in one form whoever wrote them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

Value = bool | int | float | str
Settings = dict[str, Value]

# "file": a path, relative to the file that names it; what is in the file counts, not where it lies.
KINDS: dict[str, type | str] = {
    "quads": int,
    "edge_length": float,
    "chord_error": float,
    "sharp_angle": float,
    "no_sharp": bool,
    "features": "file",
    "curve_counts": "file",
    "guides": "file",
    "guide_kind": str,
    "guide_radius": float,
    "guide_strength": float,
    "density": "file",
    "frames": "file",
    "field_smoothness": float,
    "adaptivity": float,
    "narrow_quads": int,
    "anisotropy": float,
    "size_fidelity": float,
    "fit_limit": bool,
    "symmetry": str,
    "symmetry_center": str,
    "part": "file",
    "odd_border": str,
    "solver": str,
    "seed": int,
    "threads": int,
    "time_limit": float,
    "memory_limit": float,
}

# Make no difference to a result, so a result stays good where they change.
LIMITS = ("threads", "time_limit", "memory_limit")

# An asset that says one of these takes none of the others from the settings for all.
_TOGETHER = ({"quads", "edge_length", "chord_error"}, {"sharp_angle", "no_sharp"})


class SettingError(ValueError):
    """A setting that there is not, or a value that it cannot have."""


def unknown_names(names: Iterable[str]) -> list[str]:
    """Those of some names that are no settings."""
    return sorted(name for name in names if name not in KINDS)


def canonical(given: Mapping[str, Any], folder: Path) -> Settings:
    """Settings with values of their kind; empty ones (``""``, None, flags that are off) are left out.

    Parameters
    ----------
    given : mapping
        As CSV, JSON or the command line has them. ``sharp_angle`` may be ``"none"``.
    folder : Path
        Where relative paths begin.

    Raises
    ------
    SettingError
    """
    settings: Settings = {}
    for name, value in given.items():
        if value is None or value == "":
            continue
        if name not in KINDS:
            raise SettingError(f"there is no setting {name!r}")
        if name == "sharp_angle" and str(value).strip().lower() == "none":
            settings["no_sharp"] = True
            continue
        read = _read(name, value, folder)
        if read is not False:
            settings[name] = read
    return dict(sorted(settings.items()))


def merged(defaults: Settings, own: Settings) -> Settings:
    """An asset's own settings, and those of all where it has none that say the same."""
    replaced = set(own).union(*(group for group in _TOGETHER if group & set(own)))
    return dict(sorted({**{name: v for name, v in defaults.items() if name not in replaced}, **own}.items()))


def as_arguments(settings: Mapping[str, Value]) -> list[str]:
    """Words of a command line."""
    words = []
    for name, value in settings.items():
        option = "--" + name.replace("_", "-")
        words += [option] if value is True else [f"{option}={value}"]  # "=": a value may begin with "-"
    return words


def files_of(settings: Mapping[str, Value]) -> dict[str, Path]:
    """The files that settings name."""
    return {name: Path(str(value)) for name, value in settings.items() if KINDS[name] == "file"}


def _read(name: str, value: Any, folder: Path) -> Value:
    kind = KINDS[name]
    if kind == "file":
        return str((folder / str(value)).absolute())
    if kind is str:
        return ",".join(str(v) for v in value) if isinstance(value, (list, tuple)) else str(value).strip()
    if kind is bool:
        word = str(value).strip().lower()
        if word not in _WORDS:
            raise SettingError(f"{name} must be true or false, not {value!r}")
        return _WORDS[word]
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise SettingError(f"{name} must be a number, not {value!r}") from None
    if isinstance(value, bool):
        raise SettingError(f"{name} must be a number, not {value!r}")
    if kind is int:
        if not number.is_integer():
            raise SettingError(f"{name} must be a whole number, not {value!r}")
        return (
            int(value) if isinstance(value, (int, str)) and str(value).strip().lstrip("+-").isdigit() else int(number)
        )
    return number


_WORDS = {"true": True, "yes": True, "1": True, "false": False, "no": False, "0": False}
