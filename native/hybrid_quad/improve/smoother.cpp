#include "hybrid_quad/improve/smoother.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/improve/vertex_colours.h"

namespace hybrid_quad {

namespace {

constexpr double kSmallestEps = 1e-3;
constexpr double kLongestStep = 0.4;  ///< in edge lengths
constexpr int kBacktracks = 4;
constexpr double kBacktrack = 0.35;
constexpr int kMoves = 200, kSums = 5000;  ///< that are worth a thread

Vector3 unit_or(const Vector3& v, const Vector3& otherwise) {
  const double length = v.norm();
  return length > 0 && std::isfinite(length) ? Vector3(v / length) : otherwise;
}

}  // namespace

struct Smoother::Derivatives {
  double gradient[2] = {0, 0};
  double hessian[3] = {0, 0, 0};  ///< 00, 01, 11
};

Smoother::Smoother(Workpiece& piece, const SmootherOptions& options)
    : piece_(piece), options_(options), guides_(piece, options.guides) {
  if (options.asked_lengths != nullptr) asked_areas_ = AskedAreas(piece.input, *options.asked_lengths);
  update_frames(true);
}

/// Calls work(i) for every entry, each independent of the others, on all threads.
/// \param chunk  so many are worth a thread
template <class Work>
void Smoother::for_each(const std::vector<int>& list, int chunk, const Work& work) const {
  const int count = static_cast<int>(list.size());
  parallel_for((count + chunk - 1) / chunk, options_.threads, [&](int c) {
    for (int i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) work(list[i]);
  });
}

void Smoother::update_reference(int q) {
  const auto& v = piece_.mesh.quad(q);
  const auto& p = piece_.mesh.positions;
  ReferencePlace place{0.25 * (p[v[0]] + p[v[1]] + p[v[2]] + p[v[3]]), {-1, -1, -1, -1}};
  for (int i = 0; i < 4; ++i)
    if (piece_.mesh.is_free(v[i])) place.face[i] = piece_.face[v[i]];
  auto& [latest, other] = references_[q];
  if (place == latest.place) return;
  std::swap(latest, other);
  if (!(place == latest.place)) latest = reference_at(place, q);
  centre_face_[q] = latest.face;
  frames_[q].reference = latest.normal;
}

Smoother::Reference Smoother::reference_at(const ReferencePlace& place, int q) const {
  // Walks from the corners stay on their sheet, however near another one is.
  Vector3 around = Vector3::Zero();
  SurfacePoint nearest;
  for (int i = 0; i < 4; ++i) {
    if (place.face[i] < 0) continue;
    around += piece_.input.normal(place.face[i]);
    if (std::find(place.face.begin(), place.face.begin() + i, place.face[i]) != place.face.begin() + i) continue;
    const SurfacePoint walked = piece_.walk(place.centre, place.face[i]);
    if (nearest.face < 0 || walked.squared_distance < nearest.squared_distance) nearest = walked;
  }
  if (nearest.face < 0) {
    SurfaceIndex::Filter filter;
    filter.region = piece_.region_filter(piece_.region[q]);
    filter.hint = centre_face_[q];
    nearest = piece_.index.nearest(place.centre, filter);
    if (nearest.face < 0) nearest = piece_.index.nearest(place.centre);
  }
  const Vector3 below = nearest.face >= 0 ? piece_.input.normal(nearest.face) : Vector3(0, 0, 1);
  return {place, unit_or(around + 2 * below, below), nearest.face};
}

void Smoother::update_shape(int q) {
  constexpr double kAgrees = 0.3, kLongest = 4.0, kLongestInStrip = 32.0, kLeastArea = 0.02;
  const auto& v = piece_.mesh.quad(q);
  const auto& p = piece_.mesh.positions;
  QuadFrame& frame = frames_[q];
  const Vector3 area = 0.5 * (p[v[2]] - p[v[0]]).cross(p[v[3]] - p[v[1]]);
  const Vector3 own = unit_or(area, frame.reference);
  frame.normal = own.dot(frame.reference) > kAgrees ? own : frame.reference;
  const double u = 0.5 * ((p[v[0]] - p[v[1]]).norm() + (p[v[2]] - p[v[3]]).norm());
  const double w = 0.5 * ((p[v[1]] - p[v[2]]).norm() + (p[v[3]] - p[v[0]]).norm());
  // Between two curves the width is given: what can change there is how straight a quad crosses.
  const bool is_in_strip = std::none_of(v.begin(), v.end(), [&](int corner) { return piece_.mesh.is_free(corner); });
  const double longest = is_in_strip ? kLongestInStrip : kLongest;
  const double ratio = u > 0 && w > 0 ? std::clamp(w / u, 1 / longest, longest) : 1.0;
  frame.aspect = is_in_strip ? ratio : std::pow(ratio, options_.aspect_power);
  own_area_[q] = std::max(area.dot(frame.normal), std::max(kLeastArea * u * w, 1e-6 * piece_.h * piece_.h));
}

void Smoother::update_area(int q) {
  constexpr double kMostChange = 4;
  double sum = 0;
  for (const int v : piece_.mesh.quad(q)) {
    double around = 0;
    for (const int other : piece_.mesh.quads_at(v)) around += own_area_[other];
    sum += around / piece_.mesh.valence(v);
  }
  frames_[q].area = 0.25 * sum;
  if (asked_areas_.empty() || centre_face_[q] < 0) return;
  // What is far too small or too large gets there in several sweeps.
  frames_[q].area = std::clamp(asked_areas_.at(centre_face_[q]), frames_[q].area / kMostChange, kMostChange * frames_[q].area);
}

void Smoother::update_frames(bool with_references) {
  std::vector<int> all(piece_.mesh.quad_count());
  std::iota(all.begin(), all.end(), 0);
  asked_areas_.set_number_of_quads(piece_.mesh.live_quads());
  update_frames(all, with_references);
}

void Smoother::update_frames(const std::vector<int>& quads, bool with_references) {
  frames_.resize(piece_.mesh.quad_count());
  own_area_.resize(piece_.mesh.quad_count(), piece_.h * piece_.h);
  centre_face_.resize(piece_.mesh.quad_count(), -1);
  references_.resize(piece_.mesh.quad_count());
  for_each(quads, with_references ? kMoves : kSums, [&](int q) {
    if (!piece_.mesh.alive(q)) return;
    if (with_references) update_reference(q);
    update_shape(q);
  });
  for_each(quads, kSums, [&](int q) {
    if (piece_.mesh.alive(q)) update_area(q);
  });
}

double Smoother::signed_quality(int q) const {
  const auto& v = piece_.mesh.quad(q);
  const auto& p = piece_.mesh.positions;
  double least = 1;
  for (int i = 0; i < 4; ++i) {
    const Vector3 forth = p[v[(i + 1) & 3]] - p[v[i]], back = p[v[(i + 3) & 3]] - p[v[i]];
    const double size = forth.norm() * back.norm();
    least = std::min(least, size > 0 ? forth.cross(back).dot(frames_[q].normal) / size : -1.0);
  }
  return least;
}

bool Smoother::is_tangled() const {
  constexpr double kSmall = 0.02;
  const auto& p = piece_.mesh.positions;
  for (int q = 0; q < piece_.mesh.quad_count(); ++q) {
    if (!piece_.mesh.alive(q)) continue;
    const auto& v = piece_.mesh.quad(q);
    for (int i = 0; i < 4; ++i)
      if ((p[v[(i + 1) & 3]] - p[v[i]]).cross(p[v[(i + 3) & 3]] - p[v[i]]).dot(frames_[q].normal) < kSmall * frames_[q].area)
        return true;
  }
  return false;
}

Vector3 Smoother::vertex_normal(int v) const {
  Vector3 sum = Vector3::Zero();
  for (const int q : piece_.mesh.quads_at(v)) sum += frames_[q].normal;
  return unit_or(sum, Vector3(0, 0, 1));
}

double Smoother::edge_size(int v) const {
  double sum = 0;
  for (const int q : piece_.mesh.quads_at(v)) sum += frames_[q].area;
  return std::sqrt(sum / piece_.mesh.valence(v));
}

double Smoother::energy(int v, const Vector3& at) const {
  const auto& p = piece_.mesh.positions;
  double sum = 0;
  for (const int q : piece_.mesh.quads_at(v)) {
    const auto& corner = piece_.mesh.quad(q);
    const QuadFrame& frame = frames_[q];
    const int k = piece_.mesh.corner_of(q, v);
    const double w = (k & 1) ? 1 / frame.aspect : frame.aspect, inverse = 1 / w;
    const Vector3 forth = p[corner[(k + 1) & 3]] - at, back = p[corner[(k + 3) & 3]] - at;
    const Vector3& far = p[corner[(k + 2) & 3]];
    const Vector3 beyond_forth = far - p[corner[(k + 1) & 3]], beyond_back = far - p[corner[(k + 3) & 3]];
    const double forth2 = forth.squaredNorm(), back2 = back.squaredNorm();
    sum += CornerEnergy::value_of(w * forth2 + inverse * back2, frame.normal.dot(forth.cross(back)), frame.area, eps_, options_.area_weight);
    sum += CornerEnergy::value_of(inverse * beyond_forth.squaredNorm() + w * forth2,
                                  -frame.normal.dot(beyond_forth.cross(forth)), frame.area, eps_, options_.area_weight);
    sum += CornerEnergy::value_of(inverse * back2 + w * beyond_back.squaredNorm(),
                                  -frame.normal.dot(back.cross(beyond_back)), frame.area, eps_, options_.area_weight);
  }
  return sum;
}

double Smoother::energy(int v, const Vector3& at, const Vector3* basis, int dimensions, Derivatives& derivatives) const {
  const auto& p = piece_.mesh.positions;
  double sum = 0;
  // length_slope: dL/dx; length_curvature: d2L/dx2, a multiple of the identity; area_slope: dD/dx (D is linear in x).
  const auto add = [&](double length, double d, const QuadFrame& frame, const Vector3& length_slope, double length_curvature,
                       const Vector3& area_slope) {
    const CornerEnergy c(length, d, frame.area, eps_, options_.area_weight);
    sum += c.value * c.value;
    double l[2], a[2], g[2];
    for (int i = 0; i < dimensions; ++i) {
      l[i] = length_slope.dot(basis[i]);
      a[i] = area_slope.dot(basis[i]);
      g[i] = c.by_length * l[i] + c.by_area * a[i];
      derivatives.gradient[i] += 2 * c.value * g[i];
    }
    const auto second = [&](int i, int j) {
      const double h = (i == j ? c.by_length * length_curvature : 0.0) + c.by_length_area * (l[i] * a[j] + l[j] * a[i]) +
                       c.by_area_area * a[i] * a[j];
      return 2 * (c.value * h + g[i] * g[j]);
    };
    derivatives.hessian[0] += second(0, 0);
    if (dimensions == 2) {
      derivatives.hessian[1] += second(0, 1);
      derivatives.hessian[2] += second(1, 1);
    }
  };
  for (const int q : piece_.mesh.quads_at(v)) {
    const auto& corner = piece_.mesh.quad(q);
    const QuadFrame& frame = frames_[q];
    const Vector3& n = frame.normal;
    const int k = piece_.mesh.corner_of(q, v);
    const double w = (k & 1) ? 1 / frame.aspect : frame.aspect, inverse = 1 / w;
    const Vector3& far = p[corner[(k + 2) & 3]];
    const Vector3 forth = p[corner[(k + 1) & 3]] - at, back = p[corner[(k + 3) & 3]] - at;
    const Vector3 beyond_forth = far - p[corner[(k + 1) & 3]], beyond_back = far - p[corner[(k + 3) & 3]];
    const double forth2 = forth.squaredNorm(), back2 = back.squaredNorm();
    add(w * forth2 + inverse * back2, n.dot(forth.cross(back)), frame, -2 * (w * forth + inverse * back), 2 * (w + inverse),
        n.cross(back - forth));
    add(inverse * beyond_forth.squaredNorm() + w * forth2, -n.dot(beyond_forth.cross(forth)), frame, -2 * w * forth, 2 * w,
        n.cross(beyond_forth));
    add(inverse * back2 + w * beyond_back.squaredNorm(), -n.dot(back.cross(beyond_back)), frame, -2 * inverse * back,
        2 * inverse, -n.cross(beyond_back));
  }
  return sum;
}

/// What pulls at v, be it free or on a curve.
GuidePull Smoother::pulls_at(int v, double size) const {
  GuidePull sum;
  if (options_.rings != nullptr) options_.rings->add_to(sum, v, piece_.mesh.positions, vertex_normal(v), size);
  if (options_.points != nullptr) options_.points->add_to(sum, v, piece_.mesh.positions, size);
  if (options_.tips != nullptr) options_.tips->pulls().add_to(sum, v, piece_.mesh.positions, size);
  return sum;
}

/// The same, and what guides ask of the edges at a free vertex.
GuidePull Smoother::guide_pull(int v, double size) const {
  GuidePull sum = pulls_at(v, size);
  if (guides_.empty()) return sum;
  const Vector3 own = guides_.at(v), normal = piece_.input.normal(piece_.face[v]);
  if (own.isZero(0)) return sum;
  const auto add_edge = [&](int other) {
    const Vector3 edge = piece_.mesh.positions[other] - piece_.mesh.positions[v];
    // The guide in the middle of the edge, or an edge would be pulled to the inside of every bend.
    const auto along_edge = [&](const Vector3& guide) {
      const Vector3 turned = normal.cross(guide);
      const Vector3& axis = std::abs(edge.dot(guide)) > std::abs(edge.dot(turned)) ? guide : turned;
      return edge.dot(axis) < 0 ? Vector3(-axis) : axis;
    };
    Vector3 along = along_edge(own);
    if (piece_.mesh.is_free(other) && piece_.face[other] >= 0) along = 0.5 * (along + along_edge(guides_.at(other)));
    const Vector3 across = normal.cross(along);  // as long as the guide is strong
    const double weight = options_.guide_weight / (size * size);
    sum.pull += weight * edge.dot(across) * across;
    sum.stiffness += weight * across * across.transpose();
  };
  // Around an inner vertex, every edge is the first one there of one quad.
  for (const int q : piece_.mesh.quads_at(v)) add_edge(piece_.mesh.quad(q)[(piece_.mesh.corner_of(q, v) + 1) & 3]);
  return sum;
}

double Smoother::move(int v) {
  if (piece_.mesh.valence(v) == 0 || piece_.mesh.is_pinned(v)) return 0;
  const double size = edge_size(v);
  if (!(size > 0)) return 0;
  if (piece_.mesh.is_free(v)) return piece_.face[v] >= 0 ? move_free(v, size) / size : 0;
  if (piece_.may_slide(v)) return move_on_curve(v, size) / size;
  return 0;
}

double Smoother::move_free(int v, double size) {
  const Vector3 start = piece_.mesh.positions[v], normal = vertex_normal(v);
  const Vector3 axis = std::abs(normal.x()) < 0.7 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
  Vector3 basis[2];
  basis[0] = normal.cross(axis).normalized();
  basis[1] = normal.cross(basis[0]);
  Derivatives d;
  const double before = energy(v, start, basis, 2, d);
  guides_.remember(v);
  const GuidePull guide = guide_pull(v, size);
  for (int i = 0; i < 2; ++i) d.gradient[i] -= 2 * guide.pull.dot(basis[i]);
  for (int i = 0; i < 3; ++i) d.hessian[i] += 2 * basis[i / 2].dot(guide.stiffness * basis[(i + 1) / 2]);
  double h00 = d.hessian[0], h01 = d.hessian[1], h11 = d.hessian[2];
  const double trace = h00 + h11, half_gap = std::sqrt(0.25 * (h00 - h11) * (h00 - h11) + h01 * h01);
  const double least = 0.5 * trace - half_gap, most = std::max(std::abs(least), std::abs(0.5 * trace + half_gap));
  if (least < 1e-3 * most) {
    const double shift = 1e-3 * most - least;
    h00 += shift;
    h11 += shift;
  }
  const double determinant = h00 * h11 - h01 * h01;
  Vector3 step = -((h11 * d.gradient[0] - h01 * d.gradient[1]) * basis[0] + (h00 * d.gradient[1] - h01 * d.gradient[0]) * basis[1]) /
                 determinant;
  const double length = step.norm();
  if (!std::isfinite(length) || length < 1e-7 * size) return 0;
  if (length > kLongestStep * size) step *= kLongestStep * size / length;
  for (int k = 0; k < kBacktracks; ++k) {
    const SurfacePoint target = piece_.walk(start + step, piece_.face[v]);
    if (target.face >= 0 && energy(v, target.position) + guide.change(target.position - start) < before) {
      piece_.mesh.positions[v] = target.position;
      piece_.face[v] = target.face;
      guides_.remember(v);
      return (target.position - start).norm();
    }
    step *= kBacktrack;
  }
  return 0;
}

double Smoother::move_on_curve(int v, double size) {
  constexpr double kPartOfGap = 0.8;
  const CurveGeometry& curve = piece_.curves[piece_.mesh.anchor(v)];
  const Vector3 start = piece_.mesh.positions[v];
  const double arc = piece_.arc[v];
  const Vector3 tangent = curve.tangent(arc);
  Derivatives d;
  double before = energy(v, start, &tangent, 1, d);
  const double density = std::max(1e-12, curve.weight_density(arc));
  const double ahead = piece_.weighted_gap(v, 1) / density, behind = piece_.weighted_gap(v, -1) / density;
  // The more a curve bends, the more even spacing matters: what is straight has no chord error.
  constexpr double kWhereCurved = 0.8;
  const double stiffness = options_.chord_spring * (1 + kWhereCurved * (density * density - 1)) / (size * size);
  const auto spring = [&](double t) {
    return stiffness * ((ahead - t) * (ahead - t) + (behind + t) * (behind + t));
  };
  before += spring(0);
  const GuidePull pulls = pulls_at(v, size);
  const double gradient = d.gradient[0] + 2 * stiffness * (behind - ahead) - 2 * pulls.pull.dot(tangent);
  double hessian = std::abs(d.hessian[0] + 4 * stiffness) + 2 * tangent.dot(pulls.stiffness * tangent);
  if (!(hessian > 0)) return 0;
  double t = -gradient / hessian;
  if (!std::isfinite(t) || std::abs(t) < 1e-7 * size) return 0;
  t = std::max(-kLongestStep * size, std::min(kLongestStep * size, t));
  t = std::max(-kPartOfGap * piece_.gap(v, -1), std::min(kPartOfGap * piece_.gap(v, 1), t));
  for (int k = 0; k < kBacktracks; ++k) {
    const double target = curve.normalized(arc + t);
    const Vector3 position = curve.at(target);
    if (energy(v, position) + spring(t) + pulls.change(position - start) < before) {
      piece_.arc[v] = target;
      piece_.mesh.positions[v] = position;
      return (position - start).norm();
    }
    t *= kBacktrack;
  }
  return 0;
}

void Smoother::relax(const std::vector<int>& vertices, int sweeps, double eps) {
  const double kept = eps_;
  eps_ = eps;
  std::vector<int> quads;
  for (const int v : vertices) quads.insert(quads.end(), piece_.mesh.quads_at(v).begin(), piece_.mesh.quads_at(v).end());
  std::sort(quads.begin(), quads.end());
  quads.erase(std::unique(quads.begin(), quads.end()), quads.end());
  guides_.make_room();
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    update_frames(quads, sweep == 0);
    double largest = 0;
    for (const int v : vertices) largest = std::max(largest, move(v));
    if (largest < options_.still) break;
  }
  update_frames(quads, false);
  eps_ = kept;
}

void Smoother::smooth(int sweeps, const RunContext& context) {
  const int n = piece_.mesh.vertex_count();
  const std::vector<std::vector<int>> colours = vertices_by_colour(piece_.mesh);
  std::vector<char> active(n, 1), moved(n, 0);
  guides_.make_room();
  if (options_.tips != nullptr) options_.tips->attach(piece_.mesh);
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    context.checkpoint(static_cast<double>(sweep) / sweeps);
    update_frames(sweep == 0 || sweep == 4 || sweep == 12);
    if (sweep == 0 || sweep == 4 || sweep == 8) {
      const bool tangled = is_tangled();
      eps_ = !tangled ? kSmallestEps : sweep == 0 ? 0.3 : sweep == 4 ? 0.1 : 0.03;
      if (tangled) std::fill(active.begin(), active.end(), 1);
    }
    std::fill(moved.begin(), moved.end(), 0);
    for (const std::vector<int>& vertices : colours)
      for_each(vertices, kMoves, [&](int v) { moved[v] = active[v] && move(v) > options_.still; });
    std::fill(active.begin(), active.end(), 0);
    bool any = false;
    for (int v = 0; v < n; ++v) {
      if (!moved[v]) continue;
      any = true;
      for (const int q : piece_.mesh.quads_at(v))
        for (const int w : piece_.mesh.quad(q)) active[w] = 1;
    }
    if (!any && sweep > 8) break;
  }
  eps_ = kSmallestEps;
  update_frames(false);
}

}  // namespace hybrid_quad
