#include "hybrid_quad/improve/shape_descent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace hybrid_quad {

namespace {

std::vector<int> sorted_unique(std::vector<int> list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

}  // namespace

double shape_of(const EditMesh& mesh, int q) {
  const EditMesh::Quad& v = mesh.quad(q);
  return scaled_jacobian(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]], mesh.positions[v[3]]);
}

std::vector<int> quads_at(const EditMesh& mesh, const std::vector<int>& vertices) {
  std::vector<int> quads;
  for (const int v : vertices) quads.insert(quads.end(), mesh.quads_at(v).begin(), mesh.quads_at(v).end());
  return sorted_unique(std::move(quads));
}

std::vector<int> with_ring(const EditMesh& mesh, const std::vector<int>& vertices) {
  std::vector<int> more = vertices;
  for (const int q : quads_at(mesh, vertices)) more.insert(more.end(), mesh.quad(q).begin(), mesh.quad(q).end());
  return sorted_unique(std::move(more));
}

bool Shapes::are_better_than(const Shapes& other) const {
  constexpr double kBetter = 0.01;
  if (flaws > other.flaws || folded > other.folded || worst < other.worst) return false;
  return folded < other.folded || lack < other.lack - kBetter;
}

bool Shapes::are_kept_since(const Shapes& before) const {
  constexpr double kFairShape = 0.4;
  return flaws <= before.flaws && folded <= before.folded && worst >= std::min(before.worst, kFairShape);
}

Shapes shapes_of(const EditMesh& mesh, const std::vector<int>& quads, const FlawMeasure& measure) {
  constexpr double kFair = 0.3;
  Shapes now;
  for (const int q : quads) {
    const double shape = shape_of(mesh, q);
    now.flaws += measure.flaws(q);
    now.folded += shape <= kFolded;
    now.worst = std::min(now.worst, shape);
    now.lack += std::max(0.0, kFair - shape);
  }
  return now;
}

ShapeDescent::ShapeDescent(Workpiece& piece, const FlawMeasure& measure, const std::vector<int>& vertices)
    : piece_(piece), measure_(measure) {
  for (const int v : vertices)
    if (piece.may_move(v)) vertices_.push_back(v);
  quads_ = quads_at(piece.mesh, vertices_);
}

bool ShapeDescent::run(const DescentPlan& plan) {
  const Shapes before = shapes_of(piece_.mesh, quads_, measure_);
  std::vector<VertexPlace> old;
  for (const int v : vertices_) old.push_back(piece_.place_of(v));
  descend(plan);
  if (shapes_of(piece_.mesh, quads_, measure_).are_better_than(before)) return true;
  for (std::size_t i = 0; i < vertices_.size(); ++i) piece_.put(vertices_[i], old[i]);
  return false;
}

void ShapeDescent::descend(const DescentPlan& plan) {
  constexpr double kFirstStep = 0.2, kLeastStep = 0.004;  // of the edges around
  for (const double softness : plan.softness) {
    softness_ = softness;
    std::vector<double> steps(vertices_.size(), kFirstStep);
    for (int sweep = 0; sweep < plan.sweeps; ++sweep)
      for (std::size_t i = 0; i < vertices_.size(); ++i)
        if (steps[i] > kLeastStep && !move(vertices_[i], steps[i])) steps[i] *= 0.5;
  }
}

double ShapeDescent::energy(int v, double enough) const {
  double sum = 0;
  const auto& p = piece_.mesh.positions;
  for (const int q : piece_.mesh.quads_at(v)) {
    if (sum >= enough) break;
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

int ShapeDescent::flaws_at(int v, int enough) const {
  int flaws = 0;
  for (const int q : piece_.mesh.quads_at(v)) {
    flaws += measure_.flaws(q);
    if (flaws >= enough) break;
  }
  return flaws;
}

/// To the best place that leaves no more flaws at v: a sine by the quad's own normal does not tell that it is turned over.
/// \returns whether one is better than where v is
bool ShapeDescent::move(int v, double step) {
  const double now = energy(v, std::numeric_limits<double>::infinity());
  const VertexPlace here = piece_.place_of(v);
  std::vector<std::pair<double, VertexPlace>> better;
  for (const VertexPlace& place : places_at(v, step)) {
    piece_.put(v, place);
    if (const double there = energy(v, now); there < now) better.emplace_back(there, place);
  }
  piece_.put(v, here);
  if (better.empty()) return false;
  std::stable_sort(better.begin(), better.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
  std::optional<int> flaws;  // where v is; mostly a place without any is found before it matters
  for (const auto& [there, place] : better) {
    piece_.put(v, place);
    if (flaws_at(v, 1) == 0) return true;
    if (!flaws) {
      piece_.put(v, here);
      flaws = flaws_at(v, std::numeric_limits<int>::max());
      piece_.put(v, place);
    }
    if (flaws_at(v, *flaws + 1) <= *flaws) return true;
  }
  piece_.put(v, here);
  return false;
}

std::vector<VertexPlace> ShapeDescent::places_at(int v, double step) const {
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

}  // namespace hybrid_quad
