#include "hybrid_quad/improve/improve.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

namespace {

constexpr double kLeastArea = 1e-10;  // over the squared mean edge length
constexpr double kNewArea = 1e-9;     // the same: at least
constexpr double kStep = 1e-4;        // over the mean edge length: so that single precision keeps it, where there is room
constexpr double kRoom = 0.02;        // of the other diagonal
constexpr double kLong = 4.5e-5;      // over the mean edge length: two such diagonals make the new area
constexpr std::array<double, 4> kReaches = {1, 0.2, 5, 25};

class FlatQuadOpener {
 public:
  FlatQuadOpener(QuadMesh& mesh, double edge, const SurfaceIndex* surface, const Agreement& agreement)
      : mesh_(mesh), edge_(edge), surface_(surface), agreement_(agreement), quads_at_(mesh.positions.size()) {
    for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q)
      for (const int v : mesh.quads[q]) quads_at_[v].push_back(q);
  }

  /// In rounds, as a vertex that moves for one quad may flatten another or turn it over.
  int run() {
    constexpr int kRounds = 8;
    int opened = 0;
    std::vector<char> is_beside(mesh_.quads.size(), 0);
    for (int round = 0; round < kRounds; ++round) {
      const int before = opened;
      for (int q = 0; q < static_cast<int>(mesh_.quads.size()); ++q) {
        const bool is_turned = round > 0 && is_beside[q] && surface_ != nullptr && flawed_among({q}) > 0;
        if (!is_turned && area_vector(q).norm() > kLeastArea * edge_ * edge_) continue;
        open(q);
        ++opened;
        for (const int beside : around(q)) is_beside[beside] = 1;
      }
      if (opened == before) break;
    }
    return opened;
  }

 private:
  /// One way to open a quad.
  struct Way {
    Vector3 normal;           // the quad points to that side afterwards
    double reach = 1;         // times the usual step
    bool other_ends = false;  // the less free end of each diagonal moves
  };

  Vector3 diagonal(int q, int i) const { return mesh_.positions[mesh_.quads[q][i + 2]] - mesh_.positions[mesh_.quads[q][i]]; }
  Vector3 area_vector(int q) const { return 0.5 * diagonal(q, 0).cross(diagonal(q, 1)); }

  /// Where the quads around it point, any direction where they don't.
  Vector3 normal_around(int q) const {
    Vector3 sum = Vector3::Zero();
    for (const int v : mesh_.quads[q])
      for (const int other : quads_at_[v]) sum += area_vector(other);
    return sum.norm() > kLeastArea * edge_ * edge_ ? sum.normalized() : Vector3::UnitZ();
  }

  /// Of the surface nearest to the quad.
  Vector3 normal_below(int q) const {
    Vector3 centre = Vector3::Zero();
    for (const int v : mesh_.quads[q]) centre += 0.25 * mesh_.positions[v];
    return surface_->mesh().normal(surface_->nearest(centre).face);
  }

  /// The quads that share a vertex with it, it included.
  std::vector<int> around(int q) const {
    std::vector<int> quads;
    for (const int v : mesh_.quads[q]) quads.insert(quads.end(), quads_at_[v].begin(), quads_at_[v].end());
    std::sort(quads.begin(), quads.end());
    quads.erase(std::unique(quads.begin(), quads.end()), quads.end());
    return quads;
  }

  int flawed_among(const std::vector<int>& quads) const {
    return static_cast<int>(std::count_if(quads.begin(), quads.end(), [&](int q) {
      const auto& v = mesh_.quads[q];
      const auto& p = mesh_.positions;
      return is_flawed({p[v[0]], p[v[1]], p[v[2]], p[v[3]]}, kLeastArea * edge_ * edge_, *surface_, agreement_);
    }));
  }

  /// In the way that leaves the fewest flawed quads around it, the first of equals.
  void open(int q) {
    const Way usual{normal_around(q)};
    if (surface_ == nullptr) {
      open_in(usual, q);
      return;
    }
    const std::vector<int> quads = around(q);
    std::array<Vector3, 4> positions;
    std::array<int, 4> anchors;
    const auto& corners = mesh_.quads[q];
    for (int i = 0; i < 4; ++i) {
      positions[i] = mesh_.positions[corners[i]];
      anchors[i] = mesh_.anchor[corners[i]];
    }
    const auto undo = [&] {
      for (int i = 0; i < 4; ++i) {
        mesh_.positions[corners[i]] = positions[i];
        mesh_.anchor[corners[i]] = anchors[i];
      }
    };
    Way best = usual;
    int fewest = std::numeric_limits<int>::max();
    for (const Vector3& normal : {usual.normal, normal_below(q)})
      for (const double reach : kReaches)
        for (const bool other_ends : {false, true}) {
          const Way way{normal, reach, other_ends};
          open_in(way, q);
          const int flawed = flawed_among(quads);
          if (flawed == 0) return;
          if (flawed < fewest) {
            fewest = flawed;
            best = way;
          }
          undo();
        }
    open_in(best, q);
  }

  /// Lengthens a diagonal at one end. A corner that has to move is no input vertex any more.
  void lengthen(const Way& way, int q, int i, const Vector3& step) {
    const int a = mesh_.quads[q][i], b = mesh_.quads[q][i + 2];
    const bool at_first = (mesh_.kind[a] < mesh_.kind[b]) != way.other_ends;
    const int v = at_first ? a : b;
    mesh_.positions[v] += at_first ? Vector3(-step) : step;
    if (mesh_.kind[v] == VertexKind::kCorner) mesh_.anchor[v] = -1;
  }

  void open_in(const Way& way, int q) {
    const Vector3& n = way.normal;
    const double longest = way.reach * kStep * edge_;
    // Around small quads such a step is long, and would turn others over.
    const auto step_beside = [&](const Vector3& d) {
      const double length = d.norm();
      return std::min(longest, way.reach * std::max(kRoom * length, 2 * kNewArea * edge_ * edge_ / length));
    };
    Vector3 d0 = diagonal(q, 0);
    const Vector3 d1 = diagonal(q, 1);
    const auto across = [&](const Vector3& d) { return Vector3(d - n * n.dot(d)).norm() > kLong * edge_; };
    if (!across(d0)) {
      const Vector3 along = across(d1) ? Vector3(d1.cross(n)) : n.unitOrthogonal();
      lengthen(way, q, 0, (across(d1) ? step_beside(d1) : longest) * along.normalized());
      if (across(d1)) return;
      d0 = longest * along.normalized();
    }
    lengthen(way, q, 1, step_beside(d0) * n.cross(d0).normalized());
  }

  QuadMesh& mesh_;
  const double edge_;
  const SurfaceIndex* surface_;
  const Agreement agreement_;
  std::vector<std::vector<int>> quads_at_;
};

}  // namespace

int open_flat_quads(QuadMesh& mesh, double edge, const SurfaceIndex* surface, const Agreement& agreement) {
  return FlatQuadOpener(mesh, edge, surface, agreement).run();
}

}  // namespace hybrid_quad
