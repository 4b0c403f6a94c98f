#include "hybrid_quad/mesh/quad_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include "hybrid_quad/mesh/bucket_sort.h"

namespace hybrid_quad {

namespace {

struct Side {
  int low, high;  ///< its vertices
  int quad;
  bool forward;  ///< runs from low to high
  bool operator<(const Side& o) const {
    return std::tie(low, high, quad, forward) < std::tie(o.low, o.high, o.quad, o.forward);
  }
  bool same_edge(const Side& o) const { return low == o.low && high == o.high; }
};

std::string edge_name(const Side& s) {
  return "edge " + std::to_string(s.low) + "-" + std::to_string(s.high);
}

bool readable(const QuadMesh& mesh, std::vector<std::string>& found) {
  const int count = static_cast<int>(mesh.positions.size());
  if (mesh.kind.size() != mesh.positions.size() || mesh.anchor.size() != mesh.positions.size() ||
      mesh.near_face.size() != mesh.positions.size())
    found.push_back("vertex arrays differ in length");
  for (std::size_t q = 0; q < mesh.quads.size(); ++q) {
    std::array<int, 4> v = mesh.quads[q];
    std::sort(v.begin(), v.end());
    if (v[0] < 0 || v[3] >= count)
      found.push_back("quad " + std::to_string(q) + " names a vertex that does not exist");
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[3])
      found.push_back("quad " + std::to_string(q) + " repeats a vertex");
  }
  for (int v = 0; v < count; ++v)
    if (!mesh.positions[v].allFinite()) found.push_back("vertex " + std::to_string(v) + " is not finite");
  return found.empty();
}

/// One or two quads an edge, opposite in direction; no two quads with two common edges. Marks border
/// vertices.
void check_edges(const std::vector<Side>& sides, std::vector<char>& on_border,
                 std::vector<std::string>& found) {
  std::vector<std::pair<int, int>> neighbours;  // pairs of quads with a common edge, once for each edge
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t j = i + 1;
    while (j < sides.size() && sides[j].same_edge(sides[i])) ++j;
    if (j - i > 2)
      found.push_back(edge_name(sides[i]) + " has more than two faces");
    else if (j - i == 1)
      on_border[sides[i].low] = on_border[sides[i].high] = 1;
    else if (sides[i].forward == sides[i + 1].forward)
      found.push_back(edge_name(sides[i]) + " has two faces in the same direction");
    else
      neighbours.emplace_back(sides[i].quad, sides[i + 1].quad);
    i = j;
  }
  bucket_sort(neighbours, [](const std::pair<int, int>& pair) { return pair.first; }, std::less<>());
  for (std::size_t i = 1; i < neighbours.size(); ++i)
    if (neighbours[i] == neighbours[i - 1])
      found.push_back("quads " + std::to_string(neighbours[i].first) + " and " +
                      std::to_string(neighbours[i].second) + " have two common edges");
}

/// The corners of every vertex, each as the edge (before, after) it turns between, must chain up to one fan.
void check_fans(const QuadMesh& mesh, const std::vector<char>& on_border, std::vector<std::string>& found) {
  struct Corner {
    int vertex, before, after;
  };
  std::vector<Corner> corners;
  corners.reserve(4 * mesh.quads.size());
  for (const auto& q : mesh.quads)
    for (int i = 0; i < 4; ++i) corners.push_back({q[i], q[(i + 1) & 3], q[(i + 3) & 3]});
  bucket_sort(corners, [](const Corner& c) { return c.vertex; }, [](const Corner& a, const Corner& b) {
    return std::tie(a.vertex, a.before, a.after) < std::tie(b.vertex, b.before, b.after);
  });
  std::vector<int> first(mesh.positions.size() + 1, 0);
  for (const Corner& c : corners) ++first[c.vertex + 1];
  for (std::size_t v = 0; v + 1 < first.size(); ++v) first[v + 1] += first[v];
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const int begin = first[v], end = first[v + 1], valence = end - begin;
    const auto name = [v] { return "vertex " + std::to_string(v); };
    if (valence == 0) {
      found.push_back(name() + " belongs to no quad");
      continue;
    }
    if (!on_border[v] && valence < 3) found.push_back("interior " + name() + " has " + std::to_string(valence) + " faces");
    const auto corner_from = [&](int before) {
      const auto at = std::lower_bound(corners.begin() + begin, corners.begin() + end, before,
                                       [](const Corner& c, int w) { return c.before < w; });
      return at != corners.begin() + end && at->before == before ? static_cast<int>(at - corners.begin())
                                                                 : -1;
    };
    int start = begin;
    for (int c = begin; on_border[v] && c < end; ++c) {  // a border fan starts where nothing ends
      const auto ends_here = [&](const Corner& other) { return other.after == corners[c].before; };
      if (std::none_of(corners.begin() + begin, corners.begin() + end, ends_here)) {
        start = c;
        break;
      }
    }
    int length = 0;
    for (int c = start; c >= 0 && length <= valence;) {
      ++length;
      c = corner_from(corners[c].after);
      if (c == start) break;
    }
    if (length != valence) found.push_back(name() + " has more than one fan");
  }
}

}  // namespace

double mean_edge_length(const QuadMesh& mesh) {
  double sum = 0;
  for (const auto& quad : mesh.quads)
    for (int i = 0; i < 4; ++i) sum += (mesh.positions[quad[(i + 1) & 3]] - mesh.positions[quad[i]]).norm();
  return mesh.quads.empty() ? 0 : sum / (4.0 * static_cast<double>(mesh.quads.size()));
}

Vector3 middle_of(const QuadMesh& mesh, int q) {
  Vector3 sum = Vector3::Zero();
  for (const int v : mesh.quads[q]) sum += mesh.positions[v];
  return 0.25 * sum;
}

std::vector<std::string> violations_of(const QuadMesh& mesh) {
  std::vector<std::string> found;
  if (!readable(mesh, found)) return found;
  std::vector<Side> sides;
  sides.reserve(4 * mesh.quads.size());
  for (std::size_t q = 0; q < mesh.quads.size(); ++q)
    for (int i = 0; i < 4; ++i) {
      const int a = mesh.quads[q][i], b = mesh.quads[q][(i + 1) & 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(q), a < b});
    }
  bucket_sort(sides, [](const Side& side) { return side.low; }, std::less<>());
  std::vector<char> on_border(mesh.positions.size(), 0);
  check_edges(sides, on_border, found);
  check_fans(mesh, on_border, found);
  for (const auto& e : mesh.feature_edges) {
    const Side wanted{std::min(e.a, e.b), std::max(e.a, e.b), -1, false};
    const auto at = std::lower_bound(sides.begin(), sides.end(), wanted);
    if (at == sides.end() || !at->same_edge(wanted))
      found.push_back("feature edge " + std::to_string(e.a) + "-" + std::to_string(e.b) + " is no edge");
  }
  return found;
}

std::vector<int> quads_without_area(const QuadMesh& mesh) {
  constexpr double kLeastArea = 1e-12;  // of a square of the mean edge length
  double size = 0;
  for (const Vector3& p : mesh.positions) size = std::max(size, p.cwiseAbs().maxCoeff());
  // To about unit size, by a power of two, so that squares of any size are in range and no digit is lost.
  const double unit = size > 0 ? std::ldexp(1.0, -std::ilogb(size)) : 1.0;
  const auto side = [&](int a, int b) { return Vector3(unit * mesh.positions[b] - unit * mesh.positions[a]); };
  double sum = 0;
  for (const auto& v : mesh.quads)
    for (int i = 0; i < 4; ++i) sum += side(v[i], v[(i + 1) & 3]).norm();
  const double edge = sum / (4.0 * static_cast<double>(mesh.quads.size()));
  std::vector<int> flat;
  for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q) {
    const auto& v = mesh.quads[q];
    if (!(0.5 * side(v[0], v[2]).cross(side(v[1], v[3])).norm() > kLeastArea * edge * edge)) flat.push_back(q);
  }
  return flat;
}

std::vector<std::string> violations_of_result(const QuadMesh& mesh) {
  if (mesh.quads.empty()) return {"no quads"};
  std::vector<std::string> found = violations_of(mesh);
  if (!found.empty()) return found;
  const std::vector<int> flat = quads_without_area(mesh);
  if (!flat.empty()) found.push_back(std::to_string(flat.size()) + " quads without area, the first is " + std::to_string(flat.front()));
  return found;
}

}  // namespace hybrid_quad
