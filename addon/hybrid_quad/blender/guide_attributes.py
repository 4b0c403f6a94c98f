"""Attributes in which directions, densities and numbers of quads are stored."""

from __future__ import annotations

import bpy
import numpy as np

from ..core.guide_values import sound_density, transformed_guides
from ..core.mesh_arrays import FloatArray, IntArray

GUIDE_ATTRIBUTE = "hybrid_quad_guide"  # FLOAT_VECTOR, point or face domain, object space; length: strength
DENSITY_ATTRIBUTE = "hybrid_quad_density"  # FLOAT, point domain; 2: edges half as long

COUNT_ATTRIBUTE = "hybrid_quad_count"  # INT, edge domain; quads along the chain of edges of this value, 0: free


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
    attribute = mesh.attributes.get(GUIDE_ATTRIBUTE)
    if attribute is None or attribute.data_type != "FLOAT_VECTOR" or attribute.domain not in ("POINT", "FACE"):
        return None
    values = np.empty(3 * len(attribute.data), np.float32)
    attribute.data.foreach_get("vector", values)
    guides = transformed_guides(values, linear)
    return guides if guides.any() else None


def are_of_faces(mesh: bpy.types.Mesh) -> bool:
    """Whether the directions painted on a mesh are on its faces."""
    attribute = mesh.attributes.get(GUIDE_ATTRIBUTE)
    return attribute is not None and attribute.domain == "FACE"


def read_density(mesh: bpy.types.Mesh) -> FloatArray | None:
    """(n,) float64 densities painted on a mesh's vertices, or None where there are none."""
    attribute = mesh.attributes.get(DENSITY_ATTRIBUTE)
    if attribute is None or (attribute.domain, attribute.data_type) != ("POINT", "FLOAT"):
        return None
    values = np.empty(len(attribute.data), np.float32)
    attribute.data.foreach_get("value", values)
    density = sound_density(values)
    return density if (density != 1).any() else None


def read_counts(mesh: bpy.types.Mesh) -> IntArray | None:
    """(k,) numbers of quads that edges ask for along the chain they are part of, or None where none does."""
    attribute = mesh.attributes.get(COUNT_ATTRIBUTE)
    if attribute is None or (attribute.domain, attribute.data_type) != ("EDGE", "INT"):
        return None
    values = np.empty(len(attribute.data), np.int32)
    attribute.data.foreach_get("value", values)
    return values if (values > 0).any() else None
