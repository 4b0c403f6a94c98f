"""The kinds of data that a result can take along, each with a switch."""

from __future__ import annotations

from typing import Any, NamedTuple


class Kind(NamedTuple):
    """Something that a result takes along or leaves behind.

    Attributes
    ----------
    name : str
        Of the setting, without ``use_``.
    group : str
        Heading in the panel.
    label : str
    description : str
        Tooltip of its switch.
    """

    name: str
    group: str
    label: str
    description: str

    @property
    def setting(self) -> str:
        return f"use_{self.name}"

    @property
    def argument(self) -> str:
        """Of the batch command, without the dashes."""
        return f"transfer-{self.name.replace('_', '-')}"


KINDS = (
    Kind("materials", "Surface", "Materials", "Material slots, and the material of every face"),
    Kind(
        "uv_maps",
        "Surface",
        "UV Maps",
        "All UV maps. A face stays in one island; for exact borders keep the edges of UV islands",
    ),
    Kind("color_attributes", "Surface", "Color Attributes", "Colors painted on vertices or face corners"),
    Kind("attributes", "Surface", "Attributes", "All other attributes: numbers, vectors, Booleans and texts"),
    Kind("face_sets", "Surface", "Face Sets", "Face sets of Sculpt Mode (from Blender 3.5 on)"),
    Kind("mask", "Surface", "Mask", "Mask of Sculpt Mode"),
    Kind("custom_normals", "Surface", "Custom Normals", "Custom normals of the face corners, if there are any"),
    Kind("sharp_edges", "Edges", "Sharp", "Mark kept edges sharp that are, by mark or angle"),
    Kind("seams", "Edges", "Seams", "Mark kept edges that are UV seams, and edges at which a seam cuts the UV map"),
    Kind("creases", "Edges", "Creases", "Give kept edges and corners their creases for subdivision surfaces"),
    Kind("bevel_weights", "Edges", "Bevel Weights", "Give kept edges and corners their bevel weights"),
    Kind("freestyle_marks", "Edges", "Freestyle Marks", "Mark kept edges, and faces, that are marked for Freestyle"),
    Kind("vertex_groups", "Deform", "Vertex Groups", "All vertex groups with their weights"),
    Kind(
        "shape_keys",
        "Deform",
        "Shape Keys",
        "All shape keys with their values and drivers. The shape without any of them is then remeshed",
    ),
    Kind(
        "modifiers",
        "Deform",
        "Modifiers",
        "Modifiers that are off in viewports, and those that rig the mesh (armature, lattice): its shape without them is "
        "remeshed. Other visible modifiers are applied",
    ),
    Kind("parent", "Object", "Parent", "Parent of the object, for a result in a new object"),
    Kind("collections", "Object", "Collections", "Collections of the object, for a result in a new object"),
    Kind("constraints", "Object", "Constraints", "Constraints of the object, for a result in a new object"),
    Kind("animation", "Object", "Animation", "Action, drivers and tracks of the object, for a result in a new object"),
    Kind("custom_properties", "Object", "Custom Properties", "Custom properties of the object and its mesh"),
)
NAMES = frozenset(kind.name for kind in KINDS)


def asked_by(settings: Any) -> frozenset[str]:
    """Names of the kinds that an object's settings ask for."""
    return frozenset(kind.name for kind in KINDS if getattr(settings.transfer, kind.setting))
