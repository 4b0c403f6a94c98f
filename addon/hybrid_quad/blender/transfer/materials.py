"""Material slots."""

from __future__ import annotations

from typing import NamedTuple

import bpy


class MaterialSlot(NamedTuple):
    """A slot of a mesh.

    Attributes
    ----------
    material : Material or None
    name : str
        Of the material, by which it is found again where undo has put another one in its place.
    """

    material: bpy.types.Material | None
    name: str


def read(mesh: bpy.types.Mesh) -> tuple[MaterialSlot, ...]:
    """The slots of an evaluated mesh."""
    own = [material.original if material else None for material in mesh.materials]
    return tuple(MaterialSlot(material, material.name if material else "") for material in own)


def write(mesh: bpy.types.Mesh, slots: tuple[MaterialSlot, ...]) -> None:
    """Gives a mesh these slots."""
    mesh.materials.clear()
    for slot in slots:
        mesh.materials.append(_found(slot))


def _found(slot: MaterialSlot) -> bpy.types.Material | None:
    try:
        return slot.material and slot.material.id_data
    except ReferenceError:  # it was removed, or undo made it anew
        return bpy.data.materials.get(slot.name)
