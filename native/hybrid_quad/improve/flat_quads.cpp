#include "hybrid_quad/improve/improve.h"

#include <algorithm>
#include <array>
#include <vector>

namespace hybrid_quad {

namespace {

constexpr double kLeastArea = 1e-10;  // over the squared mean edge length
constexpr double kNewArea = 1e-9;     // the same: at least
constexpr double kStep = 1e-4;        // over the mean edge length: so that single precision keeps it, where there is room
constexpr double kRoom = 0.02;        // of the other diagonal
constexpr double kLong = 4.5e-5;  // over the mean edge length: two such diagonals make the new area

class FlatQuadOpener {
 public:
  FlatQuadOpener(QuadMesh& mesh, double edge) : mesh_(mesh), edge_(edge), quads_at_(mesh.positions.size()) {
    for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q)
      for (const int v : mesh.quads[q]) quads_at_[v].push_back(q);
  }

  /// In rounds, as a vertex that moves for one quad may flatten another.
  int run() {
    constexpr int kRounds = 8;
    int opened = 0;
    for (int round = 0; round < kRounds; ++round) {
      const int before = opened;
      for (int q = 0; q < static_cast<int>(mesh_.quads.size()); ++q) {
        if (area_vector(q).norm() > kLeastArea * edge_ * edge_) continue;
        open(q);
        ++opened;
      }
      if (opened == before) break;
    }
    return opened;
  }

 private:
  Vector3 diagonal(int q, int i) const { return mesh_.positions[mesh_.quads[q][i + 2]] - mesh_.positions[mesh_.quads[q][i]]; }
  Vector3 area_vector(int q) const { return 0.5 * diagonal(q, 0).cross(diagonal(q, 1)); }

  /// Where the quads around it point, any direction where they don't.
  Vector3 normal_around(int q) const {
    Vector3 sum = Vector3::Zero();
    for (const int v : mesh_.quads[q])
      for (const int other : quads_at_[v]) sum += area_vector(other);
    return sum.norm() > kLeastArea * edge_ * edge_ ? sum.normalized() : Vector3::UnitZ();
  }

  /// Lengthens a diagonal at the end that is freer to move. A corner that has to is no input vertex any more.
  void lengthen(int q, int i, const Vector3& step) {
    const int a = mesh_.quads[q][i], b = mesh_.quads[q][i + 2];
    const bool at_first = mesh_.kind[a] < mesh_.kind[b];
    const int v = at_first ? a : b;
    mesh_.positions[v] += at_first ? Vector3(-step) : step;
    if (mesh_.kind[v] == VertexKind::kCorner) mesh_.anchor[v] = -1;
  }

  void open(int q) {
    const Vector3 n = normal_around(q);
    const double longest = kStep * edge_;
    // Around small quads such a step is long, and would turn others over.
    const auto step_beside = [&](const Vector3& d) {
      const double length = d.norm();
      return std::min(longest, std::max(kRoom * length, 2 * kNewArea * edge_ * edge_ / length));
    };
    Vector3 d0 = diagonal(q, 0);
    const Vector3 d1 = diagonal(q, 1);
    const auto across = [&](const Vector3& d) { return Vector3(d - n * n.dot(d)).norm() > kLong * edge_; };
    if (!across(d0)) {
      const Vector3 along = across(d1) ? Vector3(d1.cross(n)) : n.unitOrthogonal();
      lengthen(q, 0, (across(d1) ? step_beside(d1) : longest) * along.normalized());
      if (across(d1)) return;
      d0 = longest * along.normalized();
    }
    lengthen(q, 1, step_beside(d0) * n.cross(d0).normalized());
  }

  QuadMesh& mesh_;
  const double edge_;
  std::vector<std::vector<int>> quads_at_;
};

}  // namespace

int open_flat_quads(QuadMesh& mesh, double edge) { return FlatQuadOpener(mesh, edge).run(); }

}  // namespace hybrid_quad
