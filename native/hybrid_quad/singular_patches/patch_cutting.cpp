#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "hybrid_quad/singular_patches/patch_triangles.h"

namespace hybrid_quad {

namespace {

constexpr double kPi = 3.14159265358979323846;

PhasePair phase_of(const Vector2& uv) {
  return {std::polar(1.0, kPi * (uv[0] + uv[1])), std::polar(1.0, kPi * (uv[0] - uv[1]))};
}

std::complex<double> unit(const std::complex<double>& z) {
  const double length = std::abs(z);
  return length > 1e-12 ? z / length : std::complex<double>(1, 0);
}

std::array<double, 2> phase_step(const Vector2& duv) { return {kPi * (duv[0] + duv[1]), kPi * (duv[0] - duv[1])}; }

class PatchCutter {
 public:
  PatchCutter(const GridOverlay& overlay, const SpanningParameterization& param, const WorkingSurface& surface,
              const FrameField& frames, const std::vector<int>& pieces)
      : overlay_(overlay), param_(param), surface_(surface), frames_(frames), pieces_(pieces),
        target_length_(surface.target_length[overlay.piece_face[pieces.front()]]) {}

  PatchTriangles cut() {
    index_halfedges();
    join_corners();
    triangulate();
    glue();
    trace_arcs();
    return std::move(out_);
  }

 private:
  void index_halfedges() {
    for (const int piece : pieces_) {
      for (int k = overlay_.piece_begin[piece]; k < overlay_.piece_begin[piece + 1]; ++k) {
        local_.emplace(k, static_cast<int>(halfedges_.size()));
        halfedges_.push_back(k);
      }
    }
  }

  /// The local index of the half-edge across k inside the patch, or -1 where k is on the patch's border.
  int across(int k) const {
    const int o = overlay_.opposite[k];
    if (o < 0 || overlay_.curve[k] >= 0) return -1;
    const auto it = local_.find(o);
    return it == local_.end() ? -1 : it->second;
  }

  /// One vertex a fan: corners at the same overlay vertex are joined across inner edges only, so a border that touches
  /// itself in a point stays a manifold.
  void join_corners() {
    const int n = static_cast<int>(halfedges_.size());
    std::vector<int> root(n);
    std::iota(root.begin(), root.end(), 0);
    const auto find = [&](int x) {
      while (root[x] != x) x = root[x] = root[root[x]];
      return x;
    };
    const auto join = [&](int x, int y) {
      x = find(x);
      y = find(y);
      if (x != y) root[std::max(x, y)] = std::min(x, y);
    };
    for (int i = 0; i < n; ++i) {
      const int k = halfedges_[i], j = across(k);
      if (j < 0) continue;
      join(i, local_.at(overlay_.next(halfedges_[j])));
      join(local_.at(overlay_.next(k)), j);
    }
    corner_vertex_.assign(n, -1);
    for (int i = 0; i < n; ++i) {
      const int r = find(i);
      if (corner_vertex_[r] < 0) corner_vertex_[r] = add_vertex(overlay_.origin[halfedges_[r]]);
      corner_vertex_[i] = corner_vertex_[r];
    }
  }

  int add_vertex(int overlay_vertex) {
    out_.positions.push_back(overlay_.vertices[overlay_vertex].position);
    out_.grid_sign.push_back(overlay_.vertices[overlay_vertex].grid_sign);
    out_.node.push_back(-1);
    return static_cast<int>(out_.positions.size()) - 1;
  }

  void add_triangle(const std::array<int, 3>& corners, const std::array<PhasePair, 3>& phases,
                    const std::array<std::array<double, 2>, 3>& wanted) {
    out_.faces.push_back(corners);
    for (int i = 0; i < 3; ++i) {
      out_.phase.push_back(phases[i]);
      out_.step.push_back(lifted_step(phases[i], phases[(i + 1) % 3], wanted[i]));
    }
  }

  /// A measure of an edge in quads, bounded by twice what its length asks for: where the parameterization stretches a
  /// sliver over many quads, the patch must not follow.
  Vector2 bounded(const Vector2& quads, const Vector3& from, const Vector3& to) const {
    constexpr double kStretch = 2.0, kAlways = 0.25;
    const double most = kStretch * (to - from).norm() / target_length_ + kAlways;
    const double length = quads.norm();
    return length > most ? Vector2(quads * (most / length)) : quads;
  }

  const Vector3& position(int k) const { return overlay_.vertices[overlay_.origin[k]].position; }

  /// What the step along an overlay half-edge should be: the chart's where a face at it has one, else its share of what
  /// the frames on its two sides ask for (the paper's connection), whatever integers were chosen there.
  Vector2 wanted_step(int k) const {
    const int h = overlay_.surface_halfedge[k];
    if (h < 0 || overlay_.piece_regular[overlay_.piece_of[k]]) return overlay_.uv[overlay_.next(k)] - overlay_.uv[k];
    const double length = surface_.mesh.edge_length(h);
    const double share = length > 0 ? (position(overlay_.next(k)) - position(k)).norm() / length : 0;
    const int o = overlay_.opposite[k];
    if (o >= 0 && overlay_.piece_regular[overlay_.piece_of[o]]) {
      const GridVector& d = param_.halfedge_uv[h];
      return Vector2(static_cast<double>(d[0]), static_cast<double>(d[1])) * (share / kGridUnit);
    }
    Vector2 asked = frames_.grid_vector(surface_.mesh, h);
    const int across = surface_.mesh.opposite(h);
    if (across >= 0) asked = 0.5 * (asked - turned(frames_.grid_vector(surface_.mesh, across), frames_.matching[across]));
    return asked * share;
  }

  std::array<double, 2> step_along(int k) const {
    return phase_step(bounded(wanted_step(k), position(k), position(overlay_.next(k))));
  }

  void triangulate() {
    first_triangle_halfedge_.assign(halfedges_.size(), -1);
    for (const int piece : pieces_) {
      const int begin = overlay_.piece_begin[piece], n = overlay_.piece_begin[piece + 1] - begin;
      const int base = local_.at(begin);
      std::vector<PhasePair> phase(n);
      for (int i = 0; i < n; ++i) phase[i] = phase_of(overlay_.uv[begin + i]);
      if (n == 3) {
        for (int i = 0; i < 3; ++i)
          first_triangle_halfedge_[base + i] = 3 * static_cast<int>(out_.faces.size()) + i;
        add_triangle({corner_vertex_[base], corner_vertex_[base + 1], corner_vertex_[base + 2]}, {phase[0], phase[1], phase[2]},
                     {step_along(begin), step_along(begin + 1), step_along(begin + 2)});
        continue;
      }
      fan(piece, begin, n, base, phase);
    }
  }

  /// A star of triangles around the piece's centre: no triangle without area, whatever points lie on its sides.
  void fan(int piece, int begin, int n, int base, const std::vector<PhasePair>& phase) {
    Vector3 centre = Vector3::Zero();
    Vector2 centre_uv = Vector2::Zero();
    PhasePair mean{0, 0};
    for (int i = 0; i < n; ++i) {
      centre += overlay_.vertices[overlay_.origin[begin + i]].position / n;
      centre_uv += overlay_.uv[begin + i] / n;
      mean.a += phase[i].a;
      mean.b += phase[i].b;
    }
    const bool regular = overlay_.piece_regular[piece] != 0;
    const PhasePair centre_phase = regular ? phase_of(centre_uv) : PhasePair{unit(mean.a), unit(mean.b)};
    const int c = static_cast<int>(out_.positions.size());
    out_.positions.push_back(centre);
    out_.grid_sign.push_back(0);
    out_.node.push_back(-1);
    for (int i = 0; i < n; ++i) {
      const int j = (i + 1) % n;
      const Vector2 out_step = regular ? Vector2(centre_uv - overlay_.uv[begin + j]) : Vector2(Vector2::Zero());
      const Vector2 in_step = regular ? Vector2(overlay_.uv[begin + i] - centre_uv) : Vector2(Vector2::Zero());
      first_triangle_halfedge_[base + i] = 3 * static_cast<int>(out_.faces.size());
      add_triangle({corner_vertex_[base + i], corner_vertex_[base + j], c}, {phase[i], phase[j], centre_phase},
                   {step_along(begin + i), phase_step(bounded(out_step, position(begin + j), centre)),
                    phase_step(bounded(in_step, centre, position(begin + i)))});
    }
  }

  void glue() {
    out_.opposite.assign(3 * out_.faces.size(), -1);
    for (std::size_t i = 0; i < halfedges_.size(); ++i) {
      const int j = across(halfedges_[i]);
      if (j >= 0) out_.opposite[first_triangle_halfedge_[i]] = first_triangle_halfedge_[j];
    }
    for (const int piece : pieces_) {
      const int base = local_.at(overlay_.piece_begin[piece]);
      const int n = overlay_.piece_begin[piece + 1] - overlay_.piece_begin[piece];
      if (n == 3) continue;
      for (int i = 0; i < n; ++i) {
        const int a = first_triangle_halfedge_[base + i] + 1, b = first_triangle_halfedge_[base + (i + 1) % n] + 2;
        out_.opposite[a] = b;
        out_.opposite[b] = a;
      }
    }
  }

  /// Border half-edges in chains between grid points, with where on the chain each begins and ends (by arc length).
  void trace_arcs() {
    out_.arc.assign(3 * out_.faces.size(), -1);
    out_.arc_span.assign(3 * out_.faces.size(), {0, 0});
    std::vector<int> chain;
    for (std::size_t i = 0; i < halfedges_.size(); ++i) {
      const int k = halfedges_[i];
      if (across(k) >= 0 || overlay_.vertices[overlay_.origin[k]].grid_sign == 0) continue;
      chain.clear();
      double length = 0;
      int e = k;
      do {
        chain.push_back(e);
        length += segment_length(e);
        e = next_border(e);
      } while (overlay_.vertices[overlay_.origin[e]].grid_sign == 0 && chain.size() <= halfedges_.size());
      if (overlay_.vertices[overlay_.origin[e]].grid_sign == 0) throw InternalError("singular patches", "a border has no grid point");
      double walked = 0;
      for (const int s : chain) {
        const int t = first_triangle_halfedge_[local_.at(s)];
        const double begin = walked;
        walked += segment_length(s);
        out_.arc[t] = k;
        out_.arc_span[t] = {length > 0 ? begin / length : 0, length > 0 ? walked / length : 1};
      }
      out_.arc_span[first_triangle_halfedge_[local_.at(chain.back())]][1] = 1;
      out_.node[corner_vertex_[i]] = overlay_.origin[k];
    }
    for (std::size_t i = 0; i < halfedges_.size(); ++i)
      if (across(halfedges_[i]) < 0 && out_.arc[first_triangle_halfedge_[i]] < 0)
        throw InternalError("singular patches", "a border loop has no grid point");
  }

  double segment_length(int k) const {
    return (overlay_.vertices[overlay_.target(k)].position - overlay_.vertices[overlay_.origin[k]].position).norm();
  }

  int next_border(int k) const {
    int n = overlay_.next(k);
    for (int j = across(n); j >= 0; j = across(n)) n = overlay_.next(halfedges_[j]);
    return n;
  }

  const GridOverlay& overlay_;
  const SpanningParameterization& param_;
  const WorkingSurface& surface_;
  const FrameField& frames_;
  const std::vector<int>& pieces_;
  double target_length_;
  std::unordered_map<int, int> local_;  // overlay half-edge -> index into halfedges_; looked up, never iterated
  std::vector<int> halfedges_;
  std::vector<int> corner_vertex_;
  std::vector<int> first_triangle_halfedge_;
  PatchTriangles out_;
};

}  // namespace

std::array<double, 2> lifted_step(const PhasePair& p, const PhasePair& q, const std::array<double, 2>& wanted) {
  const auto lift = [](const std::complex<double>& from, const std::complex<double>& to, double step) {
    const double base = std::arg(to * std::conj(from));
    return base + 2 * kPi * std::round((step - base) / (2 * kPi));
  };
  return {lift(p.a, q.a, wanted[0]), lift(p.b, q.b, wanted[1])};
}

PatchTriangles triangulate_patch(const GridOverlay& overlay, const SpanningParameterization& param,
                                 const WorkingSurface& surface, const FrameField& frames,
                                 const std::vector<int>& pieces) {
  return PatchCutter(overlay, param, surface, frames, pieces).cut();
}

}  // namespace hybrid_quad
