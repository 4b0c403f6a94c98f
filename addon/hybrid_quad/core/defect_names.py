"""What is wrong with a mesh, as people read it in a window: files and scripts have the codes, a window has these words."""

from __future__ import annotations

# Of one element and of several; where a defect has no elements both are alike.
WORDS = {
    "non_manifold_edge": ("edge in more than two faces", "edges in more than two faces"),
    "non_manifold_vertex": ("vertex that only joins sheets", "vertices that only join sheets"),
    "twisted_edge": ("edge that joins the two sides", "edges that join the two sides"),
    "flipped_face": ("flipped face", "flipped faces"),
    "unwelded_vertex": ("unmerged vertex", "unmerged vertices"),
    "nearly_welded_vertex": ("nearly merged vertex", "nearly merged vertices"),
    "pinhole": ("vertex around a hole too small to see", "vertices around holes too small to see"),
    "t_junction": ("vertex on the edge of another face", "vertices on edges of other faces"),
    "duplicate_face": ("duplicate face", "duplicate faces"),
    "zero_area_face": ("face without area", "faces without area"),
    "repeated_index_face": ("face with a repeated corner", "faces with repeated corners"),
    "too_few_corners": ("face with too few corners", "faces with too few corners"),
    "isolated_vertex": ("loose vertex", "loose vertices"),
    "loose_edge": ("loose edge", "loose edges"),
    "self_intersection": ("intersecting face", "intersecting faces"),
    "unknown_intersection": ("faces that may intersect", "faces that may intersect"),
    "touching_vertex": ("vertex where sheets touch", "vertices where sheets touch"),
    "far_vertex": ("far-off vertex", "far-off vertices"),
    "tiny_component": ("face of a tiny part", "faces of tiny parts"),
    "thin_component": ("face of a part thin as a hair", "faces of parts thin as hairs"),
    "not_a_surface": ("edge as inside a volume mesh", "edges as inside a volume mesh"),
    "non_orientable": ("face of a one-sided surface", "faces of a one-sided surface"),
    "non_finite_vertex": ("vertex at no finite place", "vertices at no finite place"),
    "coordinate_outlier": ("vertex much too far off", "vertices much too far off"),
    "index_out_of_range": ("face with an unknown vertex", "faces with unknown vertices"),
    "coordinates_too_large": ("vertex with too large coordinates", "vertices with too large coordinates"),
    "coordinates_too_small": ("mesh too small to compute with", "mesh too small to compute with"),
    "coordinates_too_coarse": ("mesh too far from its origin", "mesh too far from its origin"),
    "malformed_faces": ("malformed face", "malformed faces"),
    "empty_mesh": ("mesh without faces", "mesh without faces"),
    "no_area": ("mesh without area", "mesh without area"),
}


def in_words(code: str, count: int = 0) -> str:
    """A defect and how many elements have it, for example ``"2 flipped faces"``; without a number where that is 0."""
    text = code.replace("_", " ")
    one, many = WORDS.get(code, (text, text))
    return f"{count:,} {one if count == 1 else many}" if count else many
