#include "hybrid_quad/sizing/thin_parts.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/base/parallel.h"

namespace hybrid_quad {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kOpposite = -0.3;  ///< cosine of the normals of two sides of a part

class ThicknessProbe {
 public:
  ThicknessProbe(const SurfaceIndex& index, double reach, bool with_few_sides)
      : index_(index), reach_(reach), with_few_sides_(with_few_sides) {}

  /// Radius of the ball inside that touches at p, or `largest` where no opposite side is nearer.
  double radius(const Vector3& p, const Vector3& normal, double largest) const {
    constexpr int kSteps = 8;
    constexpr double kTouches = 0.99;
    double r = largest;
    for (int step = 0; step < kSteps; ++step) {
      const Vector3 centre = p - r * normal;
      SurfaceIndex::Filter inside;
      inside.within = kTouches * r;
      const SurfacePoint q = index_.nearest(centre, inside);
      if (q.face < 0) break;
      const double height = normal.dot(p - q.position);
      if (index_.mesh().normal(q.face).dot(normal) > kOpposite || height <= 0) return with_few_sides_ ? r : largest;
      r = std::min(r, (p - q.position).squaredNorm() / (2 * height));
    }
    return r;
  }

  /// Whether a part ends on both sides of its middle within reach, in some direction across: a tube or a tip, no sheet.
  /// \param along  not along the normal; the first direction, so that none of space is preferred
  bool is_narrow(const Vector3& centre, const Vector3& normal, const Vector3& along) const {
    constexpr int kDirections = 4;
    const Vector3 y = normal.cross(along).normalized(), x = y.cross(normal);
    for (int i = 0; i < kDirections; ++i) {
      const double angle = kPi * i / kDirections;
      const Vector3 d = reach_ * (std::cos(angle) * x + std::sin(angle) * y);
      if (is_outside(centre + d) && is_outside(centre - d)) return true;
    }
    return false;
  }

 private:
  bool is_outside(const Vector3& p) const {
    const SurfacePoint q = index_.nearest(p);
    return q.face < 0 || index_.mesh().normal(q.face).dot(p - q.position) > 0;
  }

  const SurfaceIndex& index_;
  double reach_;
  bool with_few_sides_;
};

Vector3 vertex_normal(const TriangleMesh& mesh, int v) {
  Vector3 sum = Vector3::Zero();
  const int first = mesh.outgoing(v);
  for (int h = first; h >= 0;) {
    sum += mesh.area_normal(h / 3);
    h = mesh.rotate_ccw(h);
    if (h == first) break;
  }
  return sum.normalized();
}

double probes_for(const TriangleMesh& mesh, double length) {
  constexpr double kProbesPerQuad = 4, kLeastProbes = 1000;
  const double quads = mesh.total_area() / (length * length);
  return std::max(kLeastProbes, kProbesPerQuad * quads);
}

ThinTubes probed(const SurfaceIndex& index, double length, double probes, bool with_few_sides, const RunContext& context) {
  const TriangleMesh& mesh = index.mesh();
  const int stride = std::max(1, static_cast<int>(mesh.vertex_count() / probes));
  const double enough = 2 * length / kPi;  // a circle of this radius has room for four quads
  const ThicknessProbe probe(index, 0.9 * length, with_few_sides);
  const auto radius_at = [&](int v) {
    if (mesh.outgoing(v) < 0) return enough;
    const Vector3 normal = vertex_normal(mesh, v);
    if (!(normal.squaredNorm() > 0.5)) return enough;
    const double r = probe.radius(mesh.position(v), normal, enough);
    const bool is_thin = r < enough && probe.is_narrow(mesh.position(v) - r * normal, normal, mesh.edge_vector(mesh.outgoing(v)));
    return is_thin ? r : enough;
  };
  std::vector<double> radius((mesh.vertex_count() - 1) / stride + 1);
  parallel_chunks(static_cast<int>(radius.size()), context, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) radius[i] = radius_at(i * stride);
  });
  ThinTubes tubes;
  for (std::size_t i = 0; i < radius.size(); ++i)
    if (radius[i] < enough) tubes.places.push_back({static_cast<int>(i) * stride, radius[i] * kPi / 2});
  tubes.share = static_cast<double>(tubes.places.size()) / static_cast<double>(radius.size());
  return tubes;
}

}  // namespace

std::vector<ThinPlace> thin_places(const SurfaceIndex& index, double length, const RunContext& context) {
  return probed(index, length, probes_for(index.mesh(), length), false, context).places;
}

ThinTubes thin_tubes(const SurfaceIndex& index, double length, const RunContext& context) {
  return probed(index, length, probes_for(index.mesh(), length), true, context);
}

bool is_wire(const SurfaceIndex& index, double length, const RunContext& context) {
  constexpr double kFew = 64;
  return is_wire(probed(index, length, kFew, true, context));
}

bool is_wire(const ThinTubes& tubes) {
  constexpr double kNearlyAll = 0.7;
  return tubes.share >= kNearlyAll;
}

}  // namespace hybrid_quad
