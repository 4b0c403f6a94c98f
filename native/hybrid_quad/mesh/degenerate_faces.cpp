#include "hybrid_quad/mesh/degenerate_faces.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "hybrid_quad/mesh/editable_mesh.h"

namespace hybrid_quad {

namespace {

constexpr double kRelativeHeight = 1e-10;
constexpr int kMaxPasses = 20;

bool is_face_without_area(const EditableMesh& m, int f) {
  return has_no_area(m.position(m.from(3 * f)), m.position(m.from(3 * f + 1)), m.position(m.from(3 * f + 2)));
}

/// The face's half-edges by length, longest first.
std::array<int, 3> by_length(const EditableMesh& m, int f) {
  std::array<int, 3> h{3 * f, 3 * f + 1, 3 * f + 2};
  std::stable_sort(h.begin(), h.end(), [&m](int x, int y) {
    return m.edge_vector(x).squaredNorm() > m.edge_vector(y).squaredNorm();
  });
  return h;
}

bool try_collapse(EditableMesh& m, int h) {
  const auto may_move = [&m](int k) { return !m.is_boundary_vertex(m.from(k)) || m.opposite(k) < 0; };
  if (may_move(h) && m.can_collapse(h)) {
    m.collapse(h);
    return true;
  }
  const int o = m.opposite(h);
  if (o < 0 || !may_move(o) || !m.can_collapse(o)) return false;
  m.collapse(o);
  return true;
}

/// A flip helps if both new faces have area, or if it shortens the longest side of a row of caps.
bool try_flip(EditableMesh& m, int h) {
  if (!m.can_flip(h)) return false;
  const Vector3 &a = m.position(m.from(h)), &b = m.position(m.to(h)), &c = m.position(m.apex(h)),
                &d = m.position(m.apex(m.opposite(h)));
  const bool has_area = !has_no_area(a, d, c) && !has_no_area(d, b, c);
  const bool shortens = is_face_without_area(m, m.opposite(h) / 3) && (c - d).squaredNorm() < (a - b).squaredNorm();
  if (!has_area && !shortens) return false;
  m.flip_edge(h);
  return true;
}

bool resolve(EditableMesh& m, int f) {
  const auto h = by_length(m, f);
  const bool needle = m.edge_vector(h[2]).norm() <= kRelativeHeight * m.edge_vector(h[0]).norm();
  if (needle) return try_collapse(m, h[2]);
  return try_flip(m, h[0]);
}

/// Takes faces away as long as one can be: the next of a row is at the border only then.
bool take_away_at_border(EditableMesh& m, const std::vector<int>& faces) {
  std::vector<int> waiting(faces.rbegin(), faces.rend());
  bool changed = false;
  while (!waiting.empty()) {
    const int f = waiting.back();
    waiting.pop_back();
    if (!m.is_face(f) || !is_face_without_area(m, f) || !m.can_take_away(f)) continue;
    const auto h = by_length(m, f);
    const auto is_open = [&m](int k) { return m.opposite(k) < 0; };
    if (std::count_if(h.begin(), h.end(), is_open) == 1 && !is_open(h[0])) continue;
    for (const int k : h)
      if (!is_open(k)) waiting.push_back(m.opposite(k) / 3);
    m.take_away(f);
    changed = true;
  }
  return changed;
}

}  // namespace

bool has_no_area(const Vector3& a, const Vector3& b, const Vector3& c) {
  const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return !((b - a).cross(c - a).norm() > kRelativeHeight * longest2);
}

std::vector<int> faces_without_area(const TriangleMesh& mesh) {
  std::vector<int> list;
  for (int f = 0; f < mesh.face_count(); ++f) {
    const auto& t = mesh.face(f);
    if (has_no_area(mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2]))) list.push_back(f);
  }
  return list;
}

ResolvedMesh resolve_faces_without_area(const TriangleMesh& mesh) {
  std::vector<int> waiting = faces_without_area(mesh);
  ResolvedMesh result;
  if (waiting.empty()) {
    result.mesh = mesh;
    result.vertex_source.resize(mesh.vertex_count());
    result.face_source.resize(mesh.face_count());
    std::iota(result.vertex_source.begin(), result.vertex_source.end(), 0);
    std::iota(result.face_source.begin(), result.face_source.end(), 0);
    return result;
  }
  EditableMesh edited(mesh);
  bool changed = true;
  for (int pass = 0; pass < kMaxPasses && changed && !waiting.empty(); ++pass) {
    changed = false;
    std::vector<int> left;
    for (const int f : waiting) {
      if (!edited.is_face(f) || !is_face_without_area(edited, f)) continue;
      changed |= resolve(edited, f);
      if (edited.is_face(f) && is_face_without_area(edited, f)) left.push_back(f);
    }
    waiting = std::move(left);
    if (!changed) changed = take_away_at_border(edited, waiting);
  }
  auto compacted = edited.compacted();
  result.mesh = std::move(compacted.mesh);
  result.vertex_source = std::move(compacted.vertex_slot);
  result.face_source = std::move(compacted.face_slot);
  return result;
}

}  // namespace hybrid_quad
