"""The values that brushes change, as they lie in a mesh's attributes."""

from __future__ import annotations

from typing import Any, NamedTuple

import bpy
import numpy as np

from ...core.guide_values import transformed_guides
from ...core.mesh_arrays import FloatArray
from ...core.painting.brush_surface import Indices
from ...core.painting.density_values import log_density
from ..guide_attributes import DENSITY_ATTRIBUTE, GUIDE_ATTRIBUTE


class _Storage(NamedTuple):
    name: str
    data_type: str
    domains: tuple[str, ...]
    key: str
    width: int
    never_painted: float


_STORAGES = {
    "DIRECTION": _Storage(GUIDE_ATTRIBUTE, "FLOAT_VECTOR", ("POINT", "FACE"), "vector", 3, 0.0),
    "DENSITY": _Storage(DENSITY_ATTRIBUTE, "FLOAT", ("POINT",), "value", 1, 1.0),
}


class WrongAttributeError(ValueError):
    """An attribute has the name of one of ours, but another type or domain."""


def are_of_faces(mesh: bpy.types.Mesh, kind: str) -> bool:
    """Whether values of a kind (``"DIRECTION"``, ``"DENSITY"``) are on the mesh's faces.

    Raises
    ------
    WrongAttributeError
    """
    attribute = _attribute(mesh, _STORAGES[kind])
    return attribute is not None and attribute.domain == "FACE"


def is_there(mesh: bpy.types.Mesh, kind: str) -> bool:
    """Whether there are values of a kind.

    Raises
    ------
    WrongAttributeError
    """
    return _attribute(mesh, _STORAGES[kind]) is not None


def read(mesh: bpy.types.Mesh, kind: str, linear: FloatArray) -> FloatArray:
    """What brushes work on: (n, 3) directions in the space that `linear` leads to, or (n,) logarithms of densities.

    Raises
    ------
    WrongAttributeError
    """
    storage = _STORAGES[kind]
    values = _values(mesh, storage, _attribute(mesh, storage)).astype(np.float64)
    return transformed_guides(values, linear) if kind == "DIRECTION" else log_density(values.ravel())


def write(mesh: bpy.types.Mesh, kind: str, elements: Indices, values: FloatArray, linear: FloatArray) -> None:
    """Stores the values of some elements, (k, 3) or (k,), as :func:`read` gives them; the others stay bit by bit.

    Makes the attribute where there is none.
    """
    storage = _STORAGES[kind]
    attribute = _attribute(mesh, storage)
    stored = _values(mesh, storage, attribute)
    if attribute is None:
        attribute = mesh.attributes.new(storage.name, storage.data_type, storage.domains[0])
    new = transformed_guides(values, np.linalg.inv(linear)) if kind == "DIRECTION" else np.exp(values)[:, None]
    stored[elements] = new
    # Fetched anew: making an attribute can move the others.
    mesh.attributes[storage.name].data.foreach_set(storage.key, stored.ravel())
    mesh.update()


def remove(mesh: bpy.types.Mesh, kind: str) -> bool:
    """Removes all values of a kind; returns whether there were any."""
    attribute = _attribute(mesh, _STORAGES[kind])
    if attribute is None:
        return False
    mesh.attributes.remove(attribute)
    mesh.update()
    return True


def _values(mesh: bpy.types.Mesh, storage: _Storage, attribute: Any) -> Any:
    if attribute is None:
        return np.full((len(mesh.vertices), storage.width), storage.never_painted, np.float32)
    values = np.empty(storage.width * len(attribute.data), np.float32)
    attribute.data.foreach_get(storage.key, values)
    return values.reshape(-1, storage.width)


def _attribute(mesh: bpy.types.Mesh, storage: _Storage) -> Any:
    attribute = mesh.attributes.get(storage.name)
    if attribute is None:
        return None
    if attribute.data_type != storage.data_type or attribute.domain not in storage.domains:
        domains = " or ".join(domain.lower() for domain in storage.domains)
        raise WrongAttributeError(
            f'The attribute "{storage.name}" is not a {storage.data_type.lower().replace("_", " ")} of {domains}s: '
            "convert or remove it (Object Data > Attributes)"
        )
    return attribute
