#include <algorithm>
#include <cmath>

#include "hybrid_quad/singular_patches/patch_triangles.h"

namespace hybrid_quad {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kNodeValue = 1.01;

int next_halfedge(int h) { return TriangleMesh::next(h); }

std::vector<char> border_vertices(const PatchTriangles& patch) {
  std::vector<char> border(patch.positions.size(), 0);
  for (std::size_t h = 0; h < patch.opposite.size(); ++h)
    if (patch.opposite[h] < 0)
      border[patch.faces[h / 3][h % 3]] = border[patch.faces[h / 3][(h % 3 + 1) % 3]] = 1;
  return border;
}

double step_in_quads(const std::array<double, 2>& s) {  // u = (alpha + beta) / 2 pi, v = (alpha - beta) / 2 pi
  return std::sqrt(2 * (s[0] * s[0] + s[1] * s[1])) / (2 * kPi);
}

PhasePair advanced(const PhasePair& p, const std::array<double, 2>& step, double part) {
  return {p.a * std::polar(1.0, part * step[0]), p.b * std::polar(1.0, part * step[1])};
}

/// One round: every marked edge is halved, every face cut to fit (one, two or four parts a face).
class RefinementRound {
 public:
  RefinementRound(const PatchTriangles& patch, const std::vector<char>& marked) : in_(patch), marked_(marked) {}

  PatchTriangles run() {
    out_.positions = in_.positions;
    out_.node = in_.node;
    out_.grid_sign = in_.grid_sign;
    middle_.assign(in_.opposite.size(), -1);
    for (std::size_t h = 0; h < in_.opposite.size(); ++h) {
      if (!marked_[h] || middle_[h] >= 0) continue;
      middle_[h] = static_cast<int>(out_.positions.size());
      if (in_.opposite[h] >= 0) middle_[in_.opposite[h]] = middle_[h];
      out_.positions.push_back((position(h) + position(next_halfedge(static_cast<int>(h)))) / 2);
      out_.node.push_back(-1);
      out_.grid_sign.push_back(0);
    }
    halves_.assign(in_.opposite.size(), {-1, -1});
    for (std::size_t f = 0; f < in_.faces.size(); ++f) cut(static_cast<int>(f));
    out_.opposite.resize(3 * out_.faces.size(), -1);
    for (std::size_t h = 0; h < in_.opposite.size(); ++h) {
      const int o = in_.opposite[h];
      if (o < 0) continue;
      out_.opposite[halves_[h][0]] = halves_[o][marked_[h] ? 1 : 0];
      if (marked_[h]) out_.opposite[halves_[h][1]] = halves_[o][0];
    }
    for (const auto& [a, b] : inner_) {
      out_.opposite[a] = b;
      out_.opposite[b] = a;
    }
    return std::move(out_);
  }

 private:
  using Step = std::array<double, 2>;

  /// A corner of a new face: an old corner or the middle of an old half-edge; `local` is its place in (alpha, beta)
  /// relative to the old face's first corner.
  struct Point {
    int vertex;
    PhasePair phase;
    Step local;
  };

  const Vector3& position(int h) const { return in_.positions[in_.faces[h / 3][h % 3]]; }

  /// Where the old face's corner lies, for a phase that closes around the face.
  Step local_corner(int h) const {
    const Step& ab = in_.step[h - h % 3];
    if (h % 3 == 0) return {0, 0};
    if (h % 3 == 1) return ab;
    const Step& bc = in_.step[h - h % 3 + 1];
    return {ab[0] + bc[0], ab[1] + bc[1]};
  }

  /// Around a vortex no local place is right: new sides then take the shortest step, which keeps the vortex in one part.
  std::array<bool, 2> closes(int f) const {
    std::array<bool, 2> out;
    for (int c = 0; c < 2; ++c)
      out[c] = std::abs(in_.step[3 * f][c] + in_.step[3 * f + 1][c] + in_.step[3 * f + 2][c]) < 1;
    return out;
  }

  Point corner(int h) const { return {in_.faces[h / 3][h % 3], in_.phase[h], local_corner(h)}; }
  Point middle(int h) const {
    const Step at = local_corner(h);
    return {middle_[h], advanced(in_.phase[h], in_.step[h], 0.5), {at[0] + in_.step[h][0] / 2, at[1] + in_.step[h][1] / 2}};
  }

  /// Adds a face; `from[i]` is the old half-edge its side i is (a half of), or -1 for a new inner side.
  int add_face(const std::array<Point, 3>& p, const std::array<int, 3>& from) {
    const int f = static_cast<int>(out_.faces.size());
    out_.faces.push_back({p[0].vertex, p[1].vertex, p[2].vertex});
    std::array<Step, 3> step{};
    for (int i = 0; i < 3; ++i) {
      const Point& q = p[(i + 1) % 3];
      if (from[i] >= 0) {
        const double part = marked_[from[i]] ? 0.5 : 1.0;
        step[i] = {part * in_.step[from[i]][0], part * in_.step[from[i]][1]};
      } else {
        step[i] = lifted_step(p[i].phase, q.phase, {closes_[0] ? q.local[0] - p[i].local[0] : 0.0,
                                                closes_[1] ? q.local[1] - p[i].local[1] : 0.0});
      }
    }
    for (int i = 0; i < 3; ++i) {
      out_.phase.push_back(p[i].phase);
      out_.step.push_back(step[i]);
      const int h = from[i];
      int arc = -1;
      std::array<double, 2> span{0, 0};
      if (h >= 0) {
        const bool second = marked_[h] && p[i].vertex == middle_[h];
        halves_[h][second] = 3 * f + i;
        arc = in_.arc[h];
        span = in_.arc_span[h];
        const double half = (span[0] + span[1]) / 2;
        if (marked_[h]) span[second ? 0 : 1] = half;
      }
      out_.arc.push_back(arc);
      out_.arc_span.push_back(span);
    }
    return 3 * f;
  }

  void cut(int f) {
    closes_ = closes(f);
    int marks = 0, first = 0;
    for (int i = 0; i < 3; ++i) marks += marked_[3 * f + i] != 0;
    if (marks == 0) {
      add_face({corner(3 * f), corner(3 * f + 1), corner(3 * f + 2)}, {3 * f, 3 * f + 1, 3 * f + 2});
      return;
    }
    if (marks == 3) {
      const int a = 3 * f, b = a + 1, c = a + 2;
      const int centre = add_face({middle(a), middle(b), middle(c)}, {-1, -1, -1});
      inner_.push_back({add_face({corner(a), middle(a), middle(c)}, {a, -1, c}) + 1, centre + 2});
      inner_.push_back({add_face({corner(b), middle(b), middle(a)}, {b, -1, a}) + 1, centre});
      inner_.push_back({add_face({corner(c), middle(c), middle(b)}, {c, -1, b}) + 1, centre + 1});
      return;
    }
    // Turn the face so that with one mark it is on side 0, with two on sides 1 and 2.
    while ((marked_[3 * f + first] != 0) != (marks == 1)) ++first;
    const int a = 3 * f + first, b = next_halfedge(a), c = next_halfedge(b);
    if (marks == 1) {
      const int left = add_face({corner(a), middle(a), corner(c)}, {a, -1, c});
      const int right = add_face({middle(a), corner(b), corner(c)}, {a, b, -1});
      inner_.push_back({left + 1, right + 2});
      return;
    }
    const int tip = add_face({middle(b), corner(c), middle(c)}, {b, c, -1});
    const double to_b = (out_.positions[middle_[c]] - position(b)).squaredNorm();
    const double to_a = (out_.positions[middle_[b]] - position(a)).squaredNorm();
    if (to_b <= to_a) {
      const int low = add_face({corner(a), corner(b), middle(c)}, {a, -1, c});
      const int high = add_face({corner(b), middle(b), middle(c)}, {b, -1, -1});
      inner_.push_back({low + 1, high + 2});
      inner_.push_back({high + 1, tip + 2});
    } else {
      const int low = add_face({corner(a), corner(b), middle(b)}, {a, b, -1});
      const int high = add_face({corner(a), middle(b), middle(c)}, {-1, -1, c});
      inner_.push_back({low + 2, high});
      inner_.push_back({high + 1, tip + 2});
    }
  }

  const PatchTriangles& in_;
  const std::vector<char>& marked_;
  PatchTriangles out_;
  std::array<bool, 2> closes_{true, true};  // of the face that is being cut
  std::vector<int> middle_;
  std::vector<std::array<int, 2>> halves_;
  std::vector<std::array<int, 2>> inner_;
};

}  // namespace

void refine_patch(PatchTriangles& patch, double longest, double target_length, const RunContext& context) {
  constexpr int kRounds = 16;
  constexpr std::size_t kMostFaces = 4000000;
  constexpr double kShortest = 0.05;  // quads; next to a vortex the phases turn fast at every scale
  for (int round = 0; round < kRounds && patch.faces.size() < kMostFaces; ++round) {
    context.checkpoint();
    const std::vector<char> border = border_vertices(patch);
    std::vector<char> marked(patch.opposite.size(), 0);
    bool any = false;
    for (int h = 0; h < static_cast<int>(patch.opposite.size()); ++h) {
      const int a = patch.faces[h / 3][h % 3], b = patch.faces[h / 3][(h % 3 + 1) % 3];
      const int o = patch.opposite[h];
      if (o >= 0 && o < h) continue;  // both are marked together
      const double length = (patch.positions[a] - patch.positions[b]).norm();
      double quads = step_in_quads(patch.step[h]);
      if (o >= 0) quads = std::max(quads, step_in_quads(patch.step[o]));
      const bool bridge = o >= 0 && border[a] && border[b];
      const bool is_long = length > 2 * longest * target_length;
      const bool is_fast = quads > longest && length > kShortest * target_length;
      if (!bridge && !is_long && !is_fast) continue;
      marked[h] = 1;
      if (o >= 0) marked[o] = 1;
      any = true;
    }
    if (!any) return;
    patch = RefinementRound(patch, marked).run();
  }
}

PatchSurface finish_patch(const PatchTriangles& patch, const GridOverlay& overlay, double target_length) {
  PatchSurface out;
  const int n = static_cast<int>(patch.positions.size());
  out.morse.assign(n, 0.0);
  out.node = patch.node;
  out.boundary_arc = patch.arc;
  out.target_length = target_length;
  for (std::size_t h = 0; h < patch.opposite.size(); ++h) {
    const int v = patch.faces[h / 3][h % 3];
    // Inner grid points are extrema already; a hair more keeps rounding from moving them.
    out.morse[v] = patch.grid_sign[v] != 0 ? 1.001 * patch.grid_sign[v] : std::clamp(patch.phase[h].morse(), -1.0, 1.0);
  }
  for (std::size_t h = 0; h < patch.opposite.size(); ++h) {
    if (patch.arc[h] < 0) continue;
    const double sign = overlay.vertices[overlay.origin[patch.arc[h]]].grid_sign;
    const double at = patch.arc_span[h][0];
    // The linear part keeps the function strictly monotone where the cosine is flat to the last bit.
    out.morse[patch.faces[h / 3][h % 3]] = sign * (0.99 * std::cos(kPi * at) + 0.01 * (1 - 2 * at));
  }
  for (int v = 0; v < n; ++v)
    if (patch.node[v] >= 0) out.morse[v] = kNodeValue * overlay.vertices[patch.node[v]].grid_sign;
  out.mesh = TriangleMesh(patch.positions, patch.faces, patch.opposite);
  return out;
}

}  // namespace hybrid_quad
