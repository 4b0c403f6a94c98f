"""Attributes in which directions, densities and numbers of quads are stored."""

from __future__ import annotations

import bpy
import numpy as np

from ..core.guide_values import sound_density, transformed_guides
from ..core.mesh_arrays import FloatArray, IntArray

GUIDE_ATTRIBUTE = "hybrid_quad_guide"  # in object space; length: strength
DENSITY_ATTRIBUTE = "hybrid_quad_density"  # 2: edges half as long
COUNT_ATTRIBUTE = "hybrid_quad_count"  # quads along the chain of edges of this value, 0: free

# The type, and the domains, in which each is read.
FORMS = {
    GUIDE_ATTRIBUTE: ("FLOAT_VECTOR", ("POINT", "FACE")),
    DENSITY_ATTRIBUTE: ("FLOAT", ("POINT",)),
    COUNT_ATTRIBUTE: ("INT", ("EDGE",)),
}


def unread(mesh: bpy.types.Mesh) -> list[str]:
    """A sentence for each attribute that has one of these names, but another form than is read."""
    return [
        f'The attribute "{name}" does nothing: it is {found.data_type} of {found.domain}, not {kind} of {" or ".join(domains)}'
        for name, (kind, domains) in FORMS.items()
        if (found := mesh.attributes.get(name)) is not None and _attribute(mesh, name) is None
    ]


def _attribute(mesh: bpy.types.Mesh, name: str) -> bpy.types.Attribute | None:
    """The attribute where it is there in the form in which it is read."""
    found = mesh.attributes.get(name)
    kind, domains = FORMS[name]
    return found if found is not None and found.data_type == kind and found.domain in domains else None


def read_guides(mesh: bpy.types.Mesh, linear: FloatArray) -> FloatArray | None:
    """Directions painted on a mesh, or None where there are none.

    Parameters
    ----------
    linear : (3, 3) float64
        From the mesh's space to that of the result.

    Returns
    -------
    (n, 3) or (#F, 3) float64, or None
        One for each vertex or each polygon, after the attribute's domain.
    """
    attribute = _attribute(mesh, GUIDE_ATTRIBUTE)
    if attribute is None:
        return None
    values = np.empty(3 * len(attribute.data), np.float32)
    attribute.data.foreach_get("vector", values)
    guides = transformed_guides(values, linear)
    return guides if guides.any() else None


def are_of_faces(mesh: bpy.types.Mesh) -> bool:
    """Whether the directions painted on a mesh are on its faces."""
    attribute = _attribute(mesh, GUIDE_ATTRIBUTE)
    return attribute is not None and attribute.domain == "FACE"


def read_density(mesh: bpy.types.Mesh) -> FloatArray | None:
    """(n,) float64 densities painted on a mesh's vertices, or None where there are none."""
    attribute = _attribute(mesh, DENSITY_ATTRIBUTE)
    if attribute is None:
        return None
    values = np.empty(len(attribute.data), np.float32)
    attribute.data.foreach_get("value", values)
    density = sound_density(values)
    return density if (density != 1).any() else None


def read_counts(mesh: bpy.types.Mesh) -> IntArray | None:
    """(k,) numbers of quads that edges ask for along the chain they are part of, or None where none does."""
    attribute = _attribute(mesh, COUNT_ATTRIBUTE)
    if attribute is None:
        return None
    values = np.empty(len(attribute.data), np.int32)
    attribute.data.foreach_get("value", values)
    return values if (values > 0).any() else None
