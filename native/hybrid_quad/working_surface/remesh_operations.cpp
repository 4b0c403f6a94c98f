#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "hybrid_quad/mesh/segment_index.h"
#include "hybrid_quad/working_surface/surface_remesher.h"

namespace hybrid_quad {

namespace {

constexpr double kSurfaceError = 0.08;   ///< over h: how far an operation may take the surface from the input
constexpr double kCurveError = 0.02;     ///< over h: the same for feature curves
constexpr double kThin = 0.01;           ///< over h: the normal of a face of less height says nothing
constexpr double kNormalCosine = 0.7;    ///< a face may turn by 45 degrees when a vertex goes
constexpr double kSameCosine = 0.97;    ///< normals that agree so well cannot hide that a surface leaves the input
constexpr double kStill = 0.03;          ///< over h: vertices do not move by less
constexpr double kHair = 1e-6;           ///< of the way to the middle of a face: opens a face without area
constexpr double kTooLong = 4.0 / 3;     ///< of the aimed length: what a collapse does not make longer
constexpr double kPoorShape = 0.25;      ///< shape below which a collapse may not make a triangle worse

/// 1 for an equilateral triangle, 0 for one without area.
double shape(const Vector3& a, const Vector3& b, const Vector3& c, double twice_area) {
  const double sides = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return sides > 0 ? 2 * std::sqrt(3.0) * twice_area / sides : 0;
}
double shape(const Vector3& a, const Vector3& b, const Vector3& c) { return shape(a, b, c, (b - a).cross(c - a).norm()); }

double longest_side2(const Vector3& a, const Vector3& b, const Vector3& c) {
  return std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
}

/// What is larger by less is as large: halves of edges and of triangles are, and rounding must not tell them apart.
constexpr double kMore = 1 + 1e-9;

double cotangent_at(const Vector3& apex, const Vector3& a, const Vector3& b) {
  const double sine = (a - apex).cross(b - apex).norm(), cosine = (a - apex).dot(b - apex);
  if (sine > 0) return cosine / sine;
  return cosine < 0 ? -1e30 : cosine > 0 ? 1e30 : 0;
}

}  // namespace

/// New vertex at the given part of h; h ends there afterwards.
int SurfaceRemesher::split(int h, double at) {
  const int a = mesh_.from(h), b = mesh_.to(h);
  VertexData d;
  d.target = (1 - at) * vertex_[a].target + at * vertex_[b].target;
  d.error = std::max(vertex_[a].error, vertex_[b].error);
  d.hint = vertex_[a].on_feature ? vertex_[b].hint : vertex_[a].hint;
  d.on_feature = is_feature(h);
  if (is_feature(h)) ++curve_edges_[mesh_.curve(h)];
  const Vector3 p = mesh_.position(a) + at * mesh_.edge_vector(h);
  const int m = mesh_.split_edge(h, p);
  vertex_.push_back(d);
  changed_at_.resize(mesh_.face_slots());
  relaxed_at_.push_back(0);
  set_changed_around(m);
  return m;
}

/// A curve's vertex goes only along its curve, which keeps enough edges and enough vertices to tell its direction.
bool SurfaceRemesher::may_leave_curve_vertex(int h) const {
  const int c = mesh_.curve(h);
  if (c < 0 || vertex_[mesh_.from(h)].is_corner) return false;
  if (curve_edges_[c] <= (curve_is_loop_[c] ? 4 : 2)) return false;
  if (curve_is_loop_[c] && vertex_[mesh_.from(h)].input >= 0 && curve_originals_[c] <= 3) return false;

  // The curve's other edge at the vertex.
  const int a = mesh_.from(h), b = mesh_.to(h);
  int before = -1;
  mesh_.visit_outgoing(a, [&](int k) {
    if (mesh_.curve(k) == c && mesh_.to(k) != b) before = mesh_.to(k);
    const int p = EditableMesh::previous(k);
    if (mesh_.opposite(p) < 0 && mesh_.curve(p) == c && mesh_.from(p) != b) before = mesh_.from(p);
  });
  if (before < 0) return false;
  const double target = vertex_[a].target;
  const Vector3 &p = mesh_.position(before), &q = mesh_.position(b);
  if ((q - p).norm() > 0.95 * options_.feature_edge_limit * target) return false;
  return vertex_[a].error + std::sqrt(nearest_on_segment(mesh_.position(a), {p, q}).squared_distance) <= kCurveError * target;
}

/// Whether no inner edge between two feature vertices comes about when from(h) goes to to(h).
bool SurfaceRemesher::keeps_feature_distance(int h) const {
  const int a = mesh_.from(h), b = mesh_.to(h);
  if (!vertex_[b].on_feature) return true;
  const int c = mesh_.apex(h), d = mesh_.opposite(h) >= 0 ? mesh_.apex(mesh_.opposite(h)) : -1;
  bool keeps = true;
  const auto check = [&](int w) { keeps = keeps && (w == b || w == c || w == d || !vertex_[w].on_feature); };
  mesh_.visit_outgoing(a, [&](int k) {
    check(mesh_.to(k));
    check(mesh_.apex(k));
  });
  return keeps;
}

/// Whether an edge of from(h) surely gets longer than keeps_shape() lets it when from(h) goes to to(h): that settles nearly all.
bool SurfaceRemesher::stretches_edge(int h) const {
  constexpr double kSurely = 1 + 1e-9;
  const int a = mesh_.from(h), dying = h / 3, other_dying = mesh_.opposite(h) >= 0 ? mesh_.opposite(h) / 3 : -1;
  if (vertex_[a].on_feature) return false;
  const Vector3 p = mesh_.position(a), q = mesh_.position(mesh_.to(h));
  const double too_long2 = kSurely * std::pow(kTooLong * options_.edge_fraction * vertex_[a].target, 2);
  const auto stretches = [&](int k) {
    if (k / 3 == dying || k / 3 == other_dying) return false;
    const Vector3& x = mesh_.position(mesh_.to(k));
    const double length2 = (x - q).squaredNorm();
    return length2 > too_long2 && length2 > kSurely * kMore * kMore * (x - p).squaredNorm();
  };
  int across = h;  // in a fan of six the edge that leads away from to(h)
  for (int turn = 0; turn < 3 && across >= 0; ++turn) across = mesh_.rotate_ccw(across);
  if (across >= 0 && stretches(across)) return true;
  const int start = mesh_.outgoing(a);
  int k = start;
  do {
    if (stretches(k)) return true;
    k = mesh_.rotate_ccw(k);
  } while (k >= 0 && k != start);
  return false;
}

/// Whether the faces about from(h) stay where they are, and as good, when it goes to to(h). \param error what is lost
bool SurfaceRemesher::keeps_shape(int h, double& error) const {
  const int a = mesh_.from(h), b = mesh_.to(h);
  const int dying = h / 3, other_dying = mesh_.opposite(h) >= 0 ? mesh_.opposite(h) / 3 : -1;
  const Vector3 p = mesh_.position(a), q = mesh_.position(b);
  const double target = vertex_[a].target;
  const double too_long = kTooLong * options_.edge_fraction * target;
  const bool on_curve = vertex_[a].on_feature;
  const auto region_normal = [&](int region) {
    Vector3 n = Vector3::Zero();
    mesh_.visit_outgoing(a, [&](int k) {
      if (mesh_.region(k / 3) == region) n += mesh_.area_normal(k / 3);
    });
    return n;
  };
  struct Before {
    double worst = 1;
    int flat = 0;  // faces without area
  };
  const auto shapes_before = [&] {  // only where a face comes out poor
    Before before;
    mesh_.visit_outgoing(a, [&](int k) {
      const double shape_before = shape(p, mesh_.position(mesh_.to(k)), mesh_.position(mesh_.apex(k)));
      before.worst = std::min(before.worst, shape_before);
      before.flat += !(shape_before > 0);
    });
    return before;
  };
  bool keeps = true, turns = false;
  int flat_after = 0;
  mesh_.visit_outgoing(a, [&](int k) {
    const int f = k / 3;
    if (!keeps || f == dying || f == other_dying) return;
    const Vector3 &x = mesh_.position(mesh_.to(k)), &y = mesh_.position(mesh_.apex(k));
    const Vector3 before = (x - p).cross(y - p), after = (x - q).cross(y - q);
    const double size_before = before.norm(), size_after = after.norm();
    const bool thin = !(size_before > kThin * target * std::sqrt(longest_side2(p, x, y)));
    const Vector3 reference = thin ? region_normal(mesh_.region(f)) : before;
    const double new_shape = shape(q, x, y, size_after);
    turns |= after.dot(reference) < kSameCosine * size_after * reference.norm();
    // A fin at an edge without length goes before the edge can, and leaves a face without area as it had one.
    const bool is_flat = !(size_after > 0);
    flat_after += is_flat;
    if (is_flat)
      keeps = flat_after <= shapes_before().flat;
    else
      keeps = after.dot(reference) >= (thin ? 0.3 : kNormalCosine) * size_after * reference.norm() &&
              (new_shape >= kPoorShape || new_shape > kMore * shapes_before().worst) &&
              ((x - q).norm() <= too_long || (x - q).norm() <= kMore * (x - p).norm() || on_curve);
  });
  if (!keeps) return false;
  double nearest2 = std::numeric_limits<double>::infinity();
  mesh_.visit_outgoing(a, [&](int k) {
    if (k / 3 == dying || k / 3 == other_dying) return;
    nearest2 = std::min(nearest2, (nearest_on_triangle(p, q, mesh_.position(mesh_.to(k)), mesh_.position(mesh_.apex(k))) - p).squaredNorm());
  });
  if (turns && !on_curve) {
    mesh_.visit_outgoing(a, [&](int k) {
      if (!keeps || k / 3 == dying || k / 3 == other_dying) return;
      const Vector3 middle = (q + mesh_.position(mesh_.to(k)) + mesh_.position(mesh_.apex(k))) / 3;
      keeps = walked_distance2(a, middle) <= std::pow(kSurfaceError * target, 2);
    });
    if (!keeps) return false;
  }
  error = vertex_[a].error + (std::isfinite(nearest2) ? std::sqrt(nearest2) : 0);
  return error <= kSurfaceError * target;
}

bool SurfaceRemesher::try_collapse(int h) {
  const int a = mesh_.from(h), b = mesh_.to(h), c = mesh_.curve(h);
  if (vertex_[a].on_feature && !may_leave_curve_vertex(h)) return false;
  if (final_phase_ && !keeps_feature_distance(h)) return false;
  double error = 0;
  if (stretches_edge(h) || !keeps_shape(h, error) || !mesh_.can_collapse(h)) return false;
  if (c >= 0) {
    --curve_edges_[c];
    curve_originals_[c] -= vertex_[a].input >= 0;
    error = std::min(error, kCurveError * vertex_[b].target);
  }
  set_changed_around(a);
  mesh_.collapse(h);
  if (!vertex_[b].on_feature || c >= 0) vertex_[b].error = std::max(vertex_[b].error, error);
  return true;
}

bool SurfaceRemesher::wants_flip(int h) const {
  const int o = mesh_.opposite(h);
  if (o < 0 || is_feature(h)) return false;
  const int c = mesh_.apex(h), d = mesh_.apex(o);
  if (vertex_[c].on_feature && vertex_[d].on_feature && final_phase_) return false;
  const Vector3 &a = mesh_.position(mesh_.from(h)), &b = mesh_.position(mesh_.to(h));
  const auto is_acute = [&](const Vector3& apex) { return (a - apex).dot(b - apex) >= 0; };
  if (is_acute(mesh_.position(c)) && is_acute(mesh_.position(d))) return false;  // neither cotangent is negative
  return cotangent_at(mesh_.position(c), a, b) + cotangent_at(mesh_.position(d), a, b) < -1e-6;
}

bool SurfaceRemesher::flip_keeps_shape(int h) const {
  const int o = mesh_.opposite(h);
  const Vector3 &a = mesh_.position(mesh_.from(h)), &b = mesh_.position(mesh_.to(h));
  const Vector3 &c = mesh_.position(mesh_.apex(h)), &d = mesh_.position(mesh_.apex(o));
  const Vector3 n1 = (d - a).cross(c - a), n2 = (b - d).cross(c - d);
  const Vector3 m1 = mesh_.area_normal(h / 3), m2 = mesh_.area_normal(o / 3);
  const Vector3 m = m1 + m2;
  const double target = edge_target(h);
  const double size1 = n1.norm(), size2 = n2.norm(), size = m.norm();
  if (!(n1.dot(m) > 0.7 * size1 * size) || !(n2.dot(m) > 0.7 * size2 * size)) return false;
  if (m1.dot(m2) < 0.5 * m1.norm() * m2.norm() &&
      std::min(m1.norm(), m2.norm()) > kThin * target * (b - a).norm())
    return false;
  // The diagonals pass each other at this distance.
  const Vector3 across = (b - a).cross(d - c);
  const double gap = std::abs((c - a).dot(across)), limit = 0.05 * target;
  if (gap > limit * across.norm()) return false;
  if (m1.dot(m2) > kSameCosine * m1.norm() * m2.norm()) return true;
  // Many small changes add up: the new diagonal must lie as near to the input as an edge may, or as the old one.
  const int v = vertex_[mesh_.from(h)].on_feature ? mesh_.to(h) : mesh_.from(h);
  const double strays2 = walked_distance2(v, 0.5 * (c + d));
  return strays2 <= std::pow(kSurfaceError * target, 2) || strays2 <= kMore * walked_distance2(v, 0.5 * (a + b));
}

/// Squared distance from p to the input about v's face there, found by walking: never too small.
double SurfaceRemesher::walked_distance2(int v, const Vector3& p) const {
  const int region = mesh_.region(mesh_.outgoing(v) / 3), hint = vertex_[v].hint;
  if (hint < 0 || input_region_[hint] != region) return 0;
  return index_.walk(p, hint).squared_distance;
}

/// \param normal  unit, of v's fan
SurfacePoint SurfaceRemesher::project(int v, const Vector3& normal, const Vector3& p) const {
  const int region = mesh_.region(mesh_.outgoing(v) / 3);
  const double target = vertex_[v].target;
  SurfaceIndex::Filter filter;
  filter.region = region;
  filter.hint = vertex_[v].hint;
  filter.normal = normal;
  filter.min_cosine = 0.2;
  if (filter.hint >= 0 && input_region_[filter.hint] == region) {
    const SurfacePoint walked = index_.walk(p, filter.hint);
    const double near = 0.1 * target;
    if (walked.squared_distance < near * near &&
        index_.mesh().normal(walked.face).dot(filter.normal) > 0.5)
      return walked;
  }
  return index_.nearest(p, filter);
}

bool SurfaceRemesher::move_keeps_surface(int v, const SurfacePoint& q) const {
  const Vector3 n = index_.mesh().normal(q.face);
  const Vector3& old = mesh_.position(v);
  const double limit = kSurfaceError * vertex_[v].target;
  bool keeps = true;
  mesh_.visit_outgoing(v, [&](int k) {
    const Vector3 &x = mesh_.position(mesh_.to(k)), &y = mesh_.position(mesh_.apex(k));
    const Vector3 after = (x - q.position).cross(y - q.position);
    if (!keeps || after.dot(n) > kSameCosine * after.norm()) return;
    const double strays2 = index_.walk((q.position + x + y) / 3, q.face).squared_distance;
    if (strays2 > limit * limit) keeps = strays2 <= kMore * index_.walk((old + x + y) / 3, q.face).squared_distance;
  });
  return keeps;
}

bool SurfaceRemesher::move_keeps_shape(int v, const Vector3& p) const {
  const Vector3& old = mesh_.position(v);
  bool keeps = true;
  double worst_before = 1, worst_after = 1;
  mesh_.visit_outgoing(v, [&](int k) {
    const Vector3 &x = mesh_.position(mesh_.to(k)), &y = mesh_.position(mesh_.apex(k));
    const Vector3 before = (x - old).cross(y - old), after = (x - p).cross(y - p);
    const double size_before = before.norm(), size_after = after.norm();
    const double shape_before = shape(old, x, y, size_before);
    worst_before = std::min(worst_before, shape_before);
    worst_after = std::min(worst_after, shape(p, x, y, size_after));
    keeps = keeps && size_after > 0 && (shape_before < 0.02 || after.dot(before) >= 0.7 * size_before * size_after);
  });
  return keeps && worst_after > std::min(0.5, worst_before * 0.999);
}

/// Since v was last to move towards the middle of its faces; if it did, that is a change as well.
bool SurfaceRemesher::has_changed_around(int v) const {
  const int start = mesh_.outgoing(v);
  int h = start;
  do {
    if (changed_at_[h / 3] >= relaxed_at_[v]) return true;
    h = mesh_.rotate_ccw(h);
  } while (h >= 0 && h != start);
  return false;
}

/// Moves v towards the middle of its faces, within the surface.
void SurfaceRemesher::relax_vertex(int v) {
  if (!has_changed_around(v)) return;
  relaxed_at_[v] = time_;
  Vector3 sum = Vector3::Zero(), n = Vector3::Zero();
  double weight = 0;
  const Vector3 p = mesh_.position(v);
  mesh_.visit_outgoing(v, [&](int k) {
    const Vector3 area_normal = mesh_.area_normal(k / 3);
    const double area = area_normal.norm();
    sum += area / 3 * (p + mesh_.position(mesh_.to(k)) + mesh_.position(mesh_.apex(k)));
    weight += area;
    n += area_normal;
  });
  const double length2 = n.squaredNorm();
  if (!(weight > 0) || !(length2 > 0)) return;
  Vector3 step = sum / weight - p;
  step -= n * (n.dot(step) / length2);
  if (step.squaredNorm() < std::pow(kStill * vertex_[v].target, 2)) return;
  const Vector3 normal = n.normalized();
  for (const double part : {1.0, 0.5, 0.25}) {
    const SurfacePoint q = project(v, normal, p + part * step);
    if (q.face < 0) return;
    if (q.squared_distance > std::pow(0.3 * vertex_[v].target, 2) || !move_keeps_shape(v, q.position) ||
        !move_keeps_surface(v, q))
      continue;
    mesh_.set_position(v, q.position);
    vertex_[v].hint = q.face;
    vertex_[v].input = -1;
    vertex_[v].error = 0;
    set_changed_around(v);
    return;
  }
}

/// Moves a corner of f, rather a free one, by a hair into one of its other faces, so that f has an area and none has lost its own.
bool SurfaceRemesher::try_open(int f) {
  const auto rank = [this](int v) { return vertex_[v].is_corner ? 2 : vertex_[v].on_feature ? 1 : 0; };
  const auto is_flat = [this](int k) { return !(mesh_.area_normal(k).norm() > 0); };
  std::array<int, 3> corners{mesh_.from(3 * f), mesh_.from(3 * f + 1), mesh_.from(3 * f + 2)};
  std::stable_sort(corners.begin(), corners.end(), [&](int v, int w) { return rank(v) < rank(w); });
  for (const int v : corners) {
    const Vector3 p = mesh_.position(v);
    std::vector<int> flat;
    std::vector<Vector3> middles;
    mesh_.visit_outgoing(v, [&](int h) {
      if (is_flat(h / 3)) flat.push_back(h / 3);
      middles.push_back((p + mesh_.position(mesh_.to(h)) + mesh_.position(mesh_.apex(h))) / 3);
    });
    for (const Vector3& middle : middles) {
      mesh_.set_position(v, p + kHair * (middle - p));
      bool opens = !is_flat(f);
      mesh_.visit_outgoing(v, [&](int h) {
        opens = opens && (!is_flat(h / 3) || std::find(flat.begin(), flat.end(), h / 3) != flat.end());
      });
      if (opens) return true;
    }
    mesh_.set_position(v, p);
  }
  return false;
}

}  // namespace hybrid_quad
