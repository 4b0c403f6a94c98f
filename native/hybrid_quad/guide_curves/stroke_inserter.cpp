#include "hybrid_quad/guide_curves/stroke_inserter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace hybrid_quad {

namespace {

constexpr double kSnap = 0.02;     ///< of an edge: nearer to its end, the line goes through the end
constexpr double kOnEdge = 1e-6;   ///< of a triangle's height
constexpr int kDeepest = 20;       ///< halvings of the way between two samples
constexpr int kMostSteps = 1000;   ///< halvings for each sample of a run

std::array<int, 2> sorted_pair(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

std::vector<int> all_faces(const TriangleMesh& mesh) {
  std::vector<int> faces(mesh.face_count());
  std::iota(faces.begin(), faces.end(), 0);
  return faces;
}

/// Where, from 0 to 1, segment (a, b) comes nearest to the segment (p, q).
double crossing(const Vector3& a, const Vector3& b, const Vector3& p, const Vector3& q) {
  const Vector3 u = b - a, v = q - p, w = a - p;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  const double t = determinant > 1e-12 * uu * vv ? (uv * vw - vv * uw) / determinant : -uw / uu;
  return std::clamp(t, 0.0, 1.0);
}

}  // namespace

StrokeInserter::StrokeInserter(const TriangleMesh& mesh, const SurfaceIndex& index,
                               const std::vector<std::array<int, 2>>& marked_edges)
    : index_(index), mesh_(mesh, {}, all_faces(mesh)) {
  for (std::size_t i = 0; i < marked_edges.size(); ++i)
    owners_[sorted_pair(marked_edges[i][0], marked_edges[i][1])] = {-1 - static_cast<int>(i)};
}

int StrokeInserter::split(int h, const Vector3& p) {
  const int a = mesh_.from(h), b = mesh_.to(h), first = mesh_.face_slots();
  const int region = mesh_.region(h / 3);
  const int m = mesh_.split_edge(h, p);
  vertex_face_.push_back(region);
  for (int f = first; f < mesh_.face_slots(); ++f) {
    std::vector<int>& parts = parts_[mesh_.region(f)];
    if (parts.empty()) parts.push_back(mesh_.region(f));
    parts.push_back(f);
  }
  const auto found = owners_.find(sorted_pair(a, b));
  if (found != owners_.end()) {
    const std::vector<int> owners = std::move(found->second);
    owners_.erase(found);
    owners_[sorted_pair(a, m)] = owners;
    owners_[sorted_pair(m, b)] = owners;
  }
  for (std::size_t i = 0, count = chain_.size(); i < count; ++i)
    if (chain_[i] == sorted_pair(a, b)) {
      chain_[i] = sorted_pair(a, m);
      chain_.push_back(sorted_pair(m, b));
    }
  return m;
}

bool StrokeInserter::has_corner(int f, int v) const {
  return mesh_.from(3 * f) == v || mesh_.from(3 * f + 1) == v || mesh_.from(3 * f + 2) == v;
}

/// The least of p's heights above the three sides, each as a part of the triangle's height there; negative outside.
double StrokeInserter::depth_in(int f, const Vector3& p, int* shallowest) const {
  const Vector3 normal = mesh_.area_normal(f);
  double least = std::numeric_limits<double>::infinity();
  for (int h = 3 * f; h < 3 * f + 3; ++h) {
    const double depth = mesh_.edge_vector(h).cross(p - mesh_.position(mesh_.from(h))).dot(normal);
    if (depth < least) {
      least = depth;
      if (shallowest) *shallowest = h;
    }
  }
  return least / std::max(normal.squaredNorm(), std::numeric_limits<double>::min());
}

int StrokeInserter::locate(const SurfacePoint& p) const {
  const auto parts = parts_.find(p.face);
  if (parts == parts_.end()) return p.face;
  int best = p.face;
  double most = -std::numeric_limits<double>::infinity();
  for (const int f : parts->second) {
    const double depth = depth_in(f, p.position);
    if (depth > most) {
      most = depth;
      best = f;
    }
  }
  return best;
}

std::vector<int> StrokeInserter::faces_about(int v) const {
  std::vector<int> faces;
  mesh_.visit_outgoing(v, [&](int h) { faces.push_back(h / 3); });
  return faces;
}

std::vector<int> StrokeInserter::faces_at(const Target& target) const {
  return target.vertex >= 0 ? faces_about(target.vertex) : std::vector<int>{locate(target.point)};
}

int StrokeInserter::longest_side(int f) const {
  int longest = 3 * f;
  for (int h = 3 * f + 1; h < 3 * f + 3; ++h)
    if (mesh_.edge_vector(h).squaredNorm() > mesh_.edge_vector(longest).squaredNorm()) longest = h;
  return longest;
}

void StrokeInserter::refine(const std::vector<SurfacePoint>& samples, double longest) {
  for (const SurfacePoint& sample : samples)
    for (;;) {
      int h = longest_side(locate(sample));
      if (mesh_.edge_vector(h).norm() <= longest) break;
      // Longest edges first (Rivara 1984), so that triangles next to small ones do not become needles.
      for (;;) {
        const int o = mesh_.opposite(h);
        if (o < 0) break;
        const int other = longest_side(o / 3);
        if (!(mesh_.edge_vector(other).squaredNorm() > mesh_.edge_vector(h).squaredNorm())) break;
        h = other;
      }
      split(h, 0.5 * (mesh_.position(mesh_.from(h)) + mesh_.position(mesh_.to(h))));
    }
}

/// The vertex at p, made where there is none.
int StrokeInserter::insert_point(const SurfacePoint& p) {
  const int f = locate(p);
  for (int h = 3 * f; h < 3 * f + 3; ++h) {
    const int v = mesh_.from(h);
    const double near = kSnap * std::min(mesh_.edge_vector(h).norm(), mesh_.edge_vector(EditableMesh::previous(h)).norm());
    if ((mesh_.position(v) - p.position).norm() <= near) return v;
  }
  int side = -1;
  if (depth_in(f, p.position, &side) <= kOnEdge) return split(side, p.position);
  // From a corner through p to the side across, and then on that line.
  const int h = EditableMesh::next(side), corner = mesh_.apex(h);
  const Vector3 a = mesh_.position(mesh_.from(h)), b = mesh_.position(mesh_.to(h)), c = mesh_.position(corner);
  const double t = std::clamp(crossing(a, b, c, p.position + 4 * (p.position - c)), 0.0, 1.0);
  const int across = split(h, a + t * (b - a));
  int line = -1;
  mesh_.visit_outgoing(across, [&](int out) {
    if (mesh_.to(out) == corner) line = out;
  });
  return split(line, p.position);
}

void StrokeInserter::step_to(Walk& walk, int v) {
  if (v == walk.vertex) return;
  chain_.push_back(sorted_pair(walk.vertex, v));
  walk.vertex = v;
}

/// Goes to the target if it is in a triangle about the walk's vertex.
bool StrokeInserter::enter(Walk& walk, const Target& target, const std::vector<int>& faces) {
  for (const int f : faces) {
    if (!has_corner(f, walk.vertex)) continue;
    walk.place = target.point.position;
    walk.face = f;
    if (target.vertex >= 0) step_to(walk, target.vertex);
    return true;
  }
  return false;
}

/// The half-edge of a face beyond which one of the others is, or -1.
int StrokeInserter::shared_edge(int face, const std::vector<int>& others) const {
  for (int h = 3 * face; h < 3 * face + 3; ++h)
    if (mesh_.opposite(h) >= 0 && std::find(others.begin(), others.end(), mesh_.opposite(h) / 3) != others.end()) return h;
  return -1;
}

/// Over the side across from the walk's vertex.
void StrokeInserter::cross(Walk& walk, int h, const Vector3& towards) {
  const int u = mesh_.from(h), w = mesh_.to(h);
  const Vector3 a = mesh_.position(u), b = mesh_.position(w);
  const double t = crossing(a, b, walk.place, towards);
  const int v = t < kSnap ? u : t > 1 - kSnap ? w : split(h, a + t * (b - a));
  step_to(walk, v);
  walk.place = a + t * (b - a);
}

bool StrokeInserter::connect(Walk& walk, const Target& target, int depth) {
  const std::vector<int> faces = faces_at(target);
  if (enter(walk, target, faces)) return true;
  const int h = shared_edge(walk.face, faces);
  if (h >= 0) {
    cross(walk, h, target.point.position);
    if (enter(walk, target, faces_at(target))) return true;
  }
  if (depth == kDeepest || --steps_left_ < 0) {
    for (const int f : faces)
      for (int i = 0; i < 3; ++i) {
        const int v = mesh_.from(3 * f + i);
        if (!has_corner(walk.face, v)) continue;
        step_to(walk, v);
        return enter(walk, target, faces);
      }
    return false;
  }
  if (h >= 0) walk.face = mesh_.outgoing(walk.vertex) / 3;
  const Target middle{index_.nearest(0.5 * (walk.place + target.point.position)), -1};
  return connect(walk, middle, depth + 1) && connect(walk, target, depth + 1);
}

bool StrokeInserter::insert(const StrokeTrace::Run& run, int guide) {
  const int first = insert_point(run.samples.front());
  const int last = run.closed ? first : insert_point(run.samples.back());
  chain_.clear();
  steps_left_ = kMostSteps * static_cast<int>(run.samples.size());
  Walk walk{first, mesh_.position(first), mesh_.outgoing(first) / 3};
  bool arrived = true;
  for (std::size_t i = 1; i + 1 < run.samples.size() && arrived; ++i) arrived = connect(walk, {run.samples[i], -1}, 0);
  if (arrived) {
    SurfacePoint end = run.samples.back();
    end.position = mesh_.position(last);
    arrived = connect(walk, {end, last}, 0);
  }
  if (arrived)
    for (const Edge& e : chain_) {
      std::vector<int>& owners = owners_[e];
      if (std::find(owners.begin(), owners.end(), guide) == owners.end()) owners.push_back(guide);
    }
  chain_.clear();
  return arrived;
}

EmbeddedStrokes StrokeInserter::take() {
  EmbeddedStrokes out;
  EditableMesh::Compacted compacted = mesh_.compacted();
  std::vector<int> now(mesh_.vertex_slots(), -1);
  for (std::size_t v = 0; v < compacted.vertex_slot.size(); ++v) now[compacted.vertex_slot[v]] = static_cast<int>(v);
  for (const auto& [edge, owners] : owners_)
    for (const int owner : owners) {
      const int a = now[edge[0]], b = now[edge[1]];
      if (owner >= 0) {
        out.edges.push_back({a, b, owner});
        continue;
      }
      out.marked_edges.push_back({a, b});
      out.source.push_back(-1 - owner);
    }
  out.face = std::move(compacted.face_region);
  out.vertex_face = vertex_face_;
  out.mesh = std::move(compacted.mesh);
  return out;
}

}  // namespace hybrid_quad
