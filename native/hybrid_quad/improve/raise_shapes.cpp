#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "hybrid_quad/improve/flaw_measure.h"
#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

namespace {

std::vector<int> sorted_unique(std::vector<int> list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

double shape_of(const EditMesh& mesh, int q) {
  const EditMesh::Quad& v = mesh.quad(q);
  return scaled_jacobian(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]], mesh.positions[v[3]]);
}

/// Of some quads together.
struct Shapes {
  int flawed = 0, folded = 0;
  double worst = 1, lack = 0;  ///< the least scaled Jacobian; what all lack to a fair one, summed

  bool are_better_than(const Shapes& other) const {
    constexpr double kBetter = 0.01;
    if (flawed > other.flawed || folded > other.folded || worst < other.worst) return false;
    return folded < other.folded || lack < other.lack - kBetter;
  }
};

/// Moves the vertices of a quad and of rings around it downhill on the sum over corners of exp(-sine / softness), each in turn to
/// the best of some places a step away. While that is soft all quads have a say, in the end the worst alone.
class ShapeDescent {
 public:
  ShapeDescent(Workpiece& piece, const FlawMeasure& measure, int q, int rings) : piece_(piece), measure_(measure) {
    const EditMesh::Quad& corners = piece.mesh.quad(q);
    std::vector<int> inside(corners.begin(), corners.end());
    for (int ring = 0; ring < rings; ++ring) {
      std::vector<int> more = inside;
      for (const int other : quads_at(inside)) more.insert(more.end(), piece.mesh.quad(other).begin(), piece.mesh.quad(other).end());
      inside = sorted_unique(std::move(more));
    }
    for (const int v : inside)
      if (piece.may_move(v)) vertices_.push_back(v);
    quads_ = quads_at(vertices_);
  }

  int size() const { return static_cast<int>(vertices_.size()); }

  /// \returns whether shapes are better now; everything is as before otherwise
  bool run() {
    const Shapes before = shapes();
    std::vector<VertexPlace> old;
    for (const int v : vertices_) old.push_back(piece_.place_of(v));
    descend();
    if (shapes().are_better_than(before)) return true;
    for (std::size_t i = 0; i < vertices_.size(); ++i) piece_.put(vertices_[i], old[i]);
    return false;
  }

 private:
  std::vector<int> quads_at(const std::vector<int>& vertices) const {
    std::vector<int> quads;
    for (const int v : vertices) quads.insert(quads.end(), piece_.mesh.quads_at(v).begin(), piece_.mesh.quads_at(v).end());
    return sorted_unique(std::move(quads));
  }

  Shapes shapes() const {
    constexpr double kFair = 0.3;
    Shapes now;
    for (const int q : quads_) {
      const double shape = shape_of(piece_.mesh, q);
      now.flawed += measure_.is_flawed(q);
      now.folded += shape <= 0;
      now.worst = std::min(now.worst, shape);
      now.lack += std::max(0.0, kFair - shape);
    }
    return now;
  }

  void descend() {
    constexpr std::array<double, 4> kSoftness{0.3, 0.15, 0.07, 0.03};
    constexpr int kSweeps = 12;
    constexpr double kFirstStep = 0.2, kLeastStep = 0.004;  // of the edges around
    for (const double softness : kSoftness) {
      softness_ = softness;
      std::vector<double> steps(vertices_.size(), kFirstStep);
      for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (std::size_t i = 0; i < vertices_.size(); ++i)
          if (steps[i] > kLeastStep && !move(vertices_[i], steps[i])) steps[i] *= 0.5;
    }
  }

  double energy(int v) const {
    double sum = 0;
    const auto& p = piece_.mesh.positions;
    for (const int q : piece_.mesh.quads_at(v)) {
      const EditMesh::Quad& c = piece_.mesh.quad(q);
      Vector3 normal = (p[c[2]] - p[c[0]]).cross(p[c[3]] - p[c[1]]);
      const double length = normal.norm();
      if (!(length > 0)) return std::numeric_limits<double>::infinity();
      normal /= length;
      for (int i = 0; i < 4; ++i) {
        const Vector3 forth = p[c[(i + 1) & 3]] - p[c[i]], back = p[c[(i + 3) & 3]] - p[c[i]];
        const double size = forth.norm() * back.norm();
        sum += std::exp(-(size > 0 ? forth.cross(back).dot(normal) / size : -1.0) / softness_);
      }
    }
    return sum;
  }

  int flawed_at(int v) const {
    int flawed = 0;
    for (const int q : piece_.mesh.quads_at(v)) flawed += measure_.is_flawed(q);
    return flawed;
  }

  /// To the best place that leaves no more quads at v flawed: a sine by the quad's own normal does not tell that it is turned over.
  /// \returns whether one is better than where v is
  bool move(int v, double step) {
    const double now = energy(v);
    const int flawed = flawed_at(v);
    const VertexPlace here = piece_.place_of(v);
    std::vector<std::pair<double, VertexPlace>> better;
    for (const VertexPlace& place : places_at(v, step)) {
      piece_.put(v, place);
      if (const double there = energy(v); there < now) better.emplace_back(there, place);
    }
    std::stable_sort(better.begin(), better.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    for (const auto& [there, place] : better) {
      piece_.put(v, place);
      if (flawed_at(v) <= flawed) return true;
    }
    piece_.put(v, here);
    return false;
  }

  std::vector<VertexPlace> places_at(int v, double step) const {
    constexpr int kDirections = 8;
    constexpr double kTurn = 2 * 3.14159265358979323846 / kDirections;
    const VertexPlace here = piece_.place_of(v);
    const double edge = piece_.edge_at(v);
    std::vector<VertexPlace> places;
    if (!piece_.mesh.is_free(v)) {
      const CurveGeometry& curve = piece_.curves[piece_.mesh.anchor(v)];
      for (const int direction : {1, -1}) {
        const double arc = curve.normalized(here.arc + direction * step * piece_.room(v, direction, edge));
        places.push_back({curve.at(arc), here.face, arc});
      }
      return places;
    }
    // Directions of the face, the same however the surface lies in space.
    const Vector3 normal = piece_.input.normal(here.face);
    const Vector3 x = step * edge * piece_.input.edge_vector(3 * here.face).normalized(), y = normal.cross(x);
    for (int k = 0; k < kDirections; ++k) {
      const SurfacePoint target = piece_.walk(here.position + std::cos(k * kTurn) * x + std::sin(k * kTurn) * y, here.face);
      if (target.face >= 0) places.push_back({target.position, target.face, here.arc});
    }
    return places;
  }

  Workpiece& piece_;
  const FlawMeasure& measure_;
  std::vector<int> vertices_, quads_;
  double softness_ = 1;
};

}  // namespace

int raise_shapes(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                 const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole) {
  constexpr double kPoor = 0.2;
  constexpr int kMostRings = 3;
  constexpr int kLeastEffort = 2000, kEffort = 4;  // vertices moved down, and for every vertex of the mesh
  Workpiece piece(quads, input, features, index);
  if (options.target_length > 0) piece.h = options.target_length;
  std::vector<std::pair<double, int>> poor;
  for (int q = 0; q < piece.mesh.quad_count(); ++q)
    if (const double shape = shape_of(piece.mesh, q); shape < kPoor) poor.emplace_back(shape, q);
  if (poor.empty() || !(piece.h > 0)) return 0;
  std::sort(poor.begin(), poor.end());
  piece.locate_all();
  const FlawMeasure measure(piece, whole ? *whole : index, options.agreement);
  long long effort = kLeastEffort + static_cast<long long>(kEffort) * piece.mesh.vertex_count();
  int raised = 0;
  for (const auto& [shape, q] : poor)
    for (int rings = 0; rings <= kMostRings && effort > 0 && shape_of(piece.mesh, q) < kPoor; ++rings) {
      context.checkpoint();
      ShapeDescent descent(piece, measure, q, rings);
      effort -= descent.size();
      raised += descent.run();
    }
  if (raised > 0) quads = piece.mesh.extract(piece.face);
  return raised;
}

}  // namespace hybrid_quad
