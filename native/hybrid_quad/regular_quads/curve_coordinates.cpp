#include "hybrid_quad/regular_quads/curve_coordinates.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hybrid_quad {

namespace {

/// Where an edge of a curve lies in the mesh: a half-edge and whether it runs along the curve or against it.
struct CurveEdge {
  int halfedge = -1;
  bool along = true;
};

CurveEdge find_edge(const TriangleMesh& mesh, int a, int b) {
  for (const int start : {a, b}) {
    const int other = start == a ? b : a;
    int h = mesh.outgoing(start);
    const int first = h;
    while (h >= 0) {
      if (mesh.to(h) == other) return {h, start == a};
      h = mesh.rotate_ccw(h);
      if (h == first) break;
    }
  }
  throw InternalError("regular quads", "a feature curve does not follow mesh edges");
}

std::int64_t round_to_grid(std::int64_t x) {
  const std::int64_t half = kGridUnit / 2;
  const std::int64_t shifted = x + half;
  return (shifted >= 0 ? shifted / kGridUnit : -((-shifted + kGridUnit - 1) / kGridUnit)) * kGridUnit;
}

class CurveBuilder {
 public:
  CurveBuilder(const WorkingSurface& surface, const FrameField& frames, const SpanningParameterization& param,
               CurveCoordinates& out)
      : surface_(surface), frames_(frames), param_(param), out_(out) {}

  /// Gives every border loop of a region at least four quad edges, by more on its longest curve: nothing that an indexed
  /// mesh can hold fits into fewer.
  void widen_short_loops() {
    constexpr std::int64_t kLeast = 4;
    const TriangleMesh& mesh = surface_.mesh;
    std::vector<char> seen(mesh.halfedge_count(), 0);
    for (int seed = 0; seed < mesh.halfedge_count(); ++seed) {
      if (seen[seed] || !surface_.features.is_feature(seed)) continue;
      std::int64_t total = 0;
      int longest = -1;
      int h = seed;
      do {
        seen[h] = 1;
        const int c = surface_.features.halfedge_curve[h];
        // Every curve of the loop is met at its first edge once on each pass along it.
        if (out_.halfedge_index[h] == 0) {
          total += count_of(c);
          if (longest < 0 || gives_way_before(c, longest)) longest = c;
        }
        int n = TriangleMesh::next(h);
        while (!surface_.features.is_feature(n)) n = TriangleMesh::next(mesh.opposite(n));
        h = n;
      } while (h != seed);
      if (total >= kLeast || longest < 0) continue;
      const std::int64_t count = count_of(longest) + 2 * ((kLeast - total + 1) / 2);
      locate_edges(longest);
      auto& s = out_.curves[longest].position;
      interpolate(s, 0, static_cast<int>(s.size()) - 1, s[0] + count * kGridUnit);
      ++out_.altered_counts;
    }
  }

  /// Curves that meet in a corner must give it one sign. They do where the parameterization has its corners at integers; where it
  /// has not, each curve rounds in a chart of its own: then the first curve's sign holds, and the others change theirs and, where
  /// that takes an odd number of edges instead of an even one, get one more.
  void agree_on_corners() {
    std::vector<int> sign(surface_.mesh.vertex_count(), -1);  // 0 or 1
    for (int c = 0; c < static_cast<int>(out_.curves.size()); ++c) {
      const FeatureCurve& curve = surface_.features.curves[c];
      if (curve.closed) continue;
      auto& coordinates = out_.curves[c];
      const auto sign_at = [&](std::int64_t s) { return static_cast<int>((s / kGridUnit + coordinates.parity) & 1); };
      int& start = sign[curve.vertices.front()];
      if (start < 0) start = sign_at(coordinates.position.front());
      if (start != sign_at(coordinates.position.front())) coordinates.parity ^= 1;
      int& end = sign[curve.vertices.back()];
      if (end < 0) end = sign_at(coordinates.position.back());
      if (end == sign_at(coordinates.position.back())) continue;
      locate_edges(c);
      interpolate(coordinates.position, 0, static_cast<int>(coordinates.position.size()) - 1,
                  coordinates.position.back() + kGridUnit);
      ++out_.altered_counts;
    }
  }

  void build(int id) {
    const FeatureCurve& curve = surface_.features.curves[id];
    locate_edges(id);
    const int edges = static_cast<int>(edges_.size());
    auto& result = out_.curves[id];
    result.position.assign(edges + 1, 0);
    has_jump_.assign(edges, 0);
    start_of_curve(curve, result);
    for (int i = 0; i < edges; ++i) {
      const std::int64_t jump = jump_before(edges_[i], result.position[i], result.parity);
      if (jump != 0) has_jump_[std::max(0, i - 1)] = 1;
      if (i > 0) result.position[i] += jump;
      result.position[i + 1] = result.position[i] + (i == 0 ? jump : 0) + tangential(edges_[i], param_.halfedge_uv);
    }
    make_monotone(curve, result);
  }

 private:
  std::int64_t count_of(int c) const { return (out_.curves[c].position.back() - out_.curves[c].position.front()) / kGridUnit; }

  /// A curve with an asked count is widened only where there is no other.
  bool gives_way_before(int c, int other) const {
    const bool fixed = surface_.features.curves[c].asked_count > 0, other_fixed = surface_.features.curves[other].asked_count > 0;
    return fixed != other_fixed ? other_fixed : length_of(c) > length_of(other);
  }

  double length_of(int c) const {
    const std::vector<int>& vertices = surface_.features.curves[c].vertices;
    double sum = 0;
    for (std::size_t i = 0; i + 1 < vertices.size(); ++i)
      sum += (surface_.mesh.position(vertices[i + 1]) - surface_.mesh.position(vertices[i])).norm();
    return sum;
  }

  /// Finds the mesh edges of a curve and the arc length at its vertices.
  void locate_edges(int id) {
    const FeatureCurve& curve = surface_.features.curves[id];
    const int edges = static_cast<int>(curve.vertices.size()) - 1;
    arc_length_.assign(edges + 1, 0.0);
    edges_.resize(edges);
    for (int i = 0; i < edges; ++i) {
      edges_[i] = find_edge(surface_.mesh, curve.vertices[i], curve.vertices[i + 1]);
      arc_length_[i + 1] = arc_length_[i] + surface_.mesh.edge_length(edges_[i].halfedge);
      out_.halfedge_index[edges_[i].halfedge] = i;
      const int o = surface_.mesh.opposite(edges_[i].halfedge);
      if (o >= 0) out_.halfedge_index[o] = i;
    }
  }

  /// The axis (0 = u, 1 = v) that the curve follows in the gauge of the edge's face, and its sense along the curve.
  std::pair<int, int> axis_of(const CurveEdge& e) const {
    const Vector2 asked = frames_.grid_vector(surface_.mesh, e.halfedge) * (e.along ? 1.0 : -1.0);
    const GridVector& d = param_.halfedge_uv[e.halfedge];
    // Of a slanted frame the edge may have more of the other axis.
    const bool is_on_isoline = (d[0] == 0) != (d[1] == 0);
    const int axis = (is_on_isoline ? d[0] != 0 : std::abs(asked[0]) >= std::abs(asked[1])) ? 0 : 1;
    return {axis, asked[axis] >= 0 ? 1 : -1};
  }

  std::int64_t tangential(const CurveEdge& e, const std::vector<GridVector>& halfedge_uv) const {
    const auto [axis, sense] = axis_of(e);
    return halfedge_uv[e.halfedge][axis] * sense * (e.along ? 1 : -1);
  }

  /// How far the chart beside an edge is from a curve that has come to x before it, as its lines and the signs of its grid points go: not
  /// at all, unless something singular lies between.
  std::int64_t jump_before(const CurveEdge& e, std::int64_t x, int parity) const {
    constexpr std::int64_t kPeriod = 2 * kGridUnit;
    CurveEdge beside = e;
    const int o = surface_.mesh.opposite(e.halfedge);
    if (!param_.is_regular[e.halfedge / 3]) beside = {o, !e.along};
    if (beside.halfedge < 0 || !param_.is_regular[beside.halfedge / 3]) return 0;
    const auto [axis, sense] = axis_of(beside);
    const GridVector& uv = start_of(beside);
    const std::int64_t line = round_to_grid(uv[1 - axis]) / kGridUnit;
    const std::int64_t jump = (uv[axis] * sense + (line - parity) * kGridUnit - x) % kPeriod;
    return jump > kGridUnit ? jump - kPeriod : jump <= -kGridUnit ? jump + kPeriod : jump;
  }

  /// Where the curve comes to an edge, in the chart beside it.
  const GridVector& start_of(const CurveEdge& e) const { return param_.corner_uv[e.along ? e.halfedge : TriangleMesh::next(e.halfedge)]; }

  void start_of_curve(const FeatureCurve& curve, CurveCoordinates::Curve& result) const {
    const CurveEdge& e = edges_[0];
    const auto [axis, sense] = axis_of(e);
    const GridVector& uv = start_of(e);
    result.position[0] = uv[axis] * sense;
    if (!curve.closed) result.position[0] = round_to_grid(result.position[0]);
    result.parity = static_cast<int>((round_to_grid(uv[1 - axis]) / kGridUnit) & 1);
  }

  void make_monotone(const FeatureCurve& curve, CurveCoordinates::Curve& result) {
    auto& s = result.position;
    const int n = static_cast<int>(s.size()) - 1;
    std::int64_t last = s[0] + round_to_grid(s[n] - s[0]);
    const std::int64_t least = (curve.closed ? 4 : 1) * kGridUnit;
    const std::int64_t found = (last - s[0]) / kGridUnit;
    // Only an asked count of the parity that Psi's corners have can be had.
    const bool is_asked = curve.asked_count > 0 && (curve.asked_count - found) % 2 == 0;
    if (last - s[0] < least || (is_asked && found != curve.asked_count)) {
      const std::int64_t count = is_asked ? curve.asked_count : curve.closed ? 4 : (found & 1) ? 1 : 2;
      last = s[0] + count * kGridUnit;
      ++out_.altered_counts;
      interpolate(s, 0, n, last);
      return;
    }
    const bool end_is_sound = last == s[n];
    s[n] = last;
    // A vertex is sound where everything before it is smaller and everything after it is larger.
    std::vector<char> sound(n + 1, 1);
    std::int64_t bound = s[0];
    for (int i = 1; i < n; ++i) {
      if (s[i] <= bound || s[i] >= last) sound[i] = 0;
      bound = std::max(bound, std::min(s[i], last));
    }
    bound = last;
    for (int i = n - 1; i > 0; --i) {
      if (s[i] >= bound) sound[i] = 0;
      bound = std::min(bound, std::max(s[i], s[0]));
    }
    for (int i = 0; i < n;) {
      int j = i + 1;
      while (!sound[j]) ++j;
      const bool exact = j == i + 1 && (j < n || end_is_sound) && !has_jump_[i];
      if (!exact) interpolate(s, i, j, s[j]);
      i = j;
    }
  }

  /// Spreads s[i]..end over the vertices i..j by arc length and marks the edges between them.
  void interpolate(std::vector<std::int64_t>& s, int i, int j, std::int64_t end) {
    const std::int64_t begin = s[i];
    const double length = std::max(arc_length_[j] - arc_length_[i], 1e-300);
    for (int k = i + 1; k < j; ++k) {
      const double t = (arc_length_[k] - arc_length_[i]) / length;
      const auto wish = begin + static_cast<std::int64_t>(std::llround(t * static_cast<double>(end - begin)));
      s[k] = std::min(std::max(wish, s[k - 1] + 1), end - (j - k));
    }
    s[j] = end;
    for (int k = i; k < j; ++k) {
      ++out_.altered_edges;
      const int h = edges_[k].halfedge, o = surface_.mesh.opposite(h);
      out_.is_altered[h] = 1;
      if (o >= 0) out_.is_altered[o] = 1;
    }
  }

  const WorkingSurface& surface_;
  const FrameField& frames_;
  const SpanningParameterization& param_;
  CurveCoordinates& out_;
  std::vector<CurveEdge> edges_;
  std::vector<double> arc_length_;
  std::vector<char> has_jump_;  ///< edges at which charts beside the curve do not continue each other
};

}  // namespace

CurveCoordinates build_curve_coordinates(const WorkingSurface& surface, const FrameField& frames,
                                         const SpanningParameterization& param) {
  CurveCoordinates out;
  out.curves.resize(surface.features.curves.size());
  out.halfedge_index.assign(surface.mesh.halfedge_count(), -1);
  out.is_altered.assign(surface.mesh.halfedge_count(), 0);
  CurveBuilder builder(surface, frames, param, out);
  for (int c = 0; c < static_cast<int>(out.curves.size()); ++c) builder.build(c);
  builder.agree_on_corners();
  builder.widen_short_loops();
  return out;
}

}  // namespace hybrid_quad
