#include "hybrid_quad/assemble/assemble.h"

#include <string>

namespace hybrid_quad {

namespace {

class Assembler {
 public:
  Assembler(const WorkingSurface& surface, const RegularQuads& regular, const SingularPatches& singular)
      : surface_(surface), overlay_(regular.overlay), regular_(regular), singular_(singular) {}

  QuadComplex assemble() {
    add_regular();
    for (std::size_t p = 0; p < singular_.patches.size(); ++p) add_patch(singular_.patches[p]);
    glue();
    make_vertices();
    return std::move(out_);
  }

 private:
  /// What a dart's origin is known as before vertices exist.
  struct Origin {
    int overlay_vertex;  ///< -1 inside a patch
    Vector3 position;
    int region;
    int near_face;  ///< of the input
  };

  void add_dart(int first_halfedge, int opposite, Origin origin) {
    first_halfedge_.push_back(first_halfedge);
    out_.opposite.push_back(opposite);
    out_.curve.push_back(first_halfedge < 0 ? -1 : overlay_.curve[first_halfedge]);
    origin_.push_back(origin);
  }

  void add_regular() {
    for (const auto& sides : regular_.side)
      for (const int k : sides) {
        const int v = overlay_.origin[k];
        const int face = overlay_.piece_face[overlay_.piece_of[k]];
        add_dart(k, -1, {v, overlay_.vertices[v].position, surface_.features.face_region[face], near_face_of(face)});
      }
  }

  void add_patch(const FilledPatch& patch) {
    const int base = static_cast<int>(out_.opposite.size());
    const PatchQuads& q = patch.quads;
    const int near_face = near_face_of_border(q);
    for (std::size_t d = 0; d < q.opposite.size(); ++d) {
      const int local = q.quads[d / 4][d % 4];
      const int node = q.node[local];
      add_dart(q.arc[d], q.opposite[d] < 0 ? -1 : base + q.opposite[d],
               {node, node >= 0 ? overlay_.vertices[node].position : q.positions[local], patch.region, near_face});
    }
  }

  /// An input face about a face of the working surface; of a corner off the curves, where there is one.
  int near_face_of(int face) const {
    const std::array<int, 3>& corners = surface_.mesh.face(face);
    for (const int v : corners)
      if (!surface_.features.on_feature[v]) return surface_.near_face[v];
    return surface_.near_face[corners[0]];
  }

  int near_face_of_border(const PatchQuads& quads) const {
    for (const int k : quads.arc)
      if (k >= 0) return near_face_of(overlay_.piece_face[overlay_.piece_of[k]]);
    return -1;
  }

  bool is_border(int k) const {
    const int o = overlay_.opposite[k];
    if (o < 0 || overlay_.curve[k] >= 0) return true;
    const int piece = overlay_.piece_of[k], other = overlay_.piece_of[o];
    if (regular_.piece_cell[piece] >= 0) return overlay_.on_isoline[k] != 0;
    return singular_.piece_patch[piece] != singular_.piece_patch[other];
  }

  /// The last half-edge of the grid edge that begins with k, seen from the same quad or patch.
  int last_of_chain(int k) const {
    std::size_t steps = 0;
    while (overlay_.vertices[overlay_.target(k)].grid_sign == 0) {
      int n = overlay_.next(k);
      while (!is_border(n)) n = overlay_.next(overlay_.opposite[n]);
      k = n;
      if (++steps > overlay_.origin.size()) throw InternalError("assemble", "a grid edge has no end");
    }
    return k;
  }

  void glue() {
    std::vector<int> dart_at(overlay_.origin.size(), -1);
    for (std::size_t d = 0; d < first_halfedge_.size(); ++d) {
      const int k = first_halfedge_[d];
      if (k < 0) continue;
      if (dart_at[k] >= 0) throw InternalError("assemble", "a grid edge has two quads on one side");
      dart_at[k] = static_cast<int>(d);
    }
    for (std::size_t d = 0; d < first_halfedge_.size(); ++d) {
      if (first_halfedge_[d] < 0) continue;
      const int across = overlay_.opposite[last_of_chain(first_halfedge_[d])];
      if (across < 0) continue;
      if (dart_at[across] < 0) throw InternalError("assemble", "a grid edge has no quad on its other side");
      out_.opposite[d] = dart_at[across];
    }
  }

  void make_vertices() {
    out_.vertex = vertex_orbits(out_.opposite);
    std::vector<std::vector<int>> orbits;
    for (int d = 0; d < static_cast<int>(out_.vertex.size()); ++d) {
      if (out_.vertex[d] == static_cast<int>(orbits.size())) orbits.emplace_back();
      orbits[out_.vertex[d]].push_back(d);
    }
    for (const std::vector<int>& orbit : orbits) add_vertex(orbit);
  }

  void add_vertex(const std::vector<int>& orbit) {
    int overlay_vertex = -1, curve = -1;
    for (const int d : orbit) {
      const int v = origin_[d].overlay_vertex;
      if (v >= 0 && overlay_vertex >= 0 && v != overlay_vertex) throw InternalError("assemble", "two grid points in one vertex");
      if (v >= 0) overlay_vertex = v;
      for (const int side : {d, QuadComplex::previous(d)})
        if (out_.curve[side] >= 0) curve = out_.curve[side];
    }
    const Origin& origin = origin_[orbit.front()];
    out_.near_face.push_back(origin.near_face);
    const int surface_vertex = overlay_vertex < 0 ? -1 : overlay_.vertices[overlay_vertex].surface_vertex;
    out_.positions.push_back(overlay_vertex < 0 ? origin.position : overlay_.vertices[overlay_vertex].position);
    if (surface_vertex >= 0 && surface_.features.is_corner[surface_vertex]) {
      out_.kind.push_back(VertexKind::kCorner);
      out_.anchor.push_back(surface_.input_vertex[surface_vertex]);
    } else if (curve >= 0) {
      out_.kind.push_back(VertexKind::kCurve);
      out_.anchor.push_back(curve);
    } else {
      out_.kind.push_back(VertexKind::kFree);
      out_.anchor.push_back(origin.region);
    }
  }

  const WorkingSurface& surface_;
  const GridOverlay& overlay_;
  const RegularQuads& regular_;
  const SingularPatches& singular_;
  QuadComplex out_;
  std::vector<int> first_halfedge_;  // per dart: first overlay half-edge of its grid edge, -1 inside a patch
  std::vector<Origin> origin_;       // per dart
};

}  // namespace

QuadComplex assemble_quads(const WorkingSurface& surface, const RegularQuads& regular, const SingularPatches& singular) {
  return Assembler(surface, regular, singular).assemble();
}

}  // namespace hybrid_quad
