#include "hybrid_quad/improve/requadrangulate.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "hybrid_quad/improve/convex_patch.h"
#include "hybrid_quad/improve/patch_pattern.h"
#include "hybrid_quad/improve/quad_moves.h"
#include "hybrid_quad/improve/trial.h"
#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

namespace {

constexpr std::size_t kMostPatterns = 4;

/// What patches are filled anew for.
struct Purpose {
  int most_quads = 64;
  int least_irregular = 2, more_irregular = -1;  ///< in a patch; afterwards at most as many more
  Trial::Measure measure = {};                   ///< empty: shape, and that the surface stays near
  double good_enough = 0.7, gain = 0, promising = 0.05;
};


/// The fewest irregular vertices inside any quads with that border.
int fewest_irregular(const ConvexPatch& patch, const std::vector<int>& lengths) {
  const std::size_t n = lengths.size();
  if (!patch.has_corners) return 4;
  if (n == 3 || n == 5) return 1;
  return n == 4 && lengths[0] == lengths[2] && lengths[1] == lengths[3] ? 0 : 2;
}

class Requadrangulator {
 public:
  Requadrangulator(Workpiece& piece, Smoother& smoother, Purpose purpose = {})
      : piece_(piece), smoother_(smoother), mesh_(piece.mesh), purpose_(std::move(purpose)),
        grower_(piece.mesh, purpose_.most_quads, purpose_.least_irregular) {}

  /// Tries larger and larger patches around v. \returns whether one was filled anew
  bool refill_around(int v) {
    for (bool room = grower_.start(v); room; room = grower_.grow()) {
      const std::optional<ConvexPatch> patch = grower_.patch();
      if (patch && refill(*patch)) return true;
    }
    return false;
  }

 private:
  bool refill(const ConvexPatch& patch) {
    constexpr double kFewest = 0.6, kMost = 1.6;
    std::vector<int> lengths;
    for (const auto& side : patch.sides) lengths.push_back(static_cast<int>(side.size()) - 1);
    if (fewest_irregular(patch, lengths) > patch.irregular + purpose_.more_irregular) return false;
    const double before = static_cast<double>(patch.quads.size());
    const std::vector<PatchPattern> patterns = patch.has_corners
                                                   ? patch_patterns(lengths, static_cast<int>(before), kMostPatterns)
                                                   : round_patterns(lengths.front(), kMostPatterns);
    for (const PatchPattern& pattern : patterns) {
      const double after = static_cast<double>(pattern.quads.size());
      if (after < kFewest * before || after > kMost * before || joins_neighbours(patch, pattern)) continue;
      if (try_pattern(patch, pattern)) return true;
    }
    return false;
  }

  static std::vector<int> border_of(const ConvexPatch& patch) {
    std::vector<int> border;
    for (const auto& side : patch.sides) border.insert(border.end(), side.begin(), side.end() - 1);
    return border;
  }

  /// Whether an edge of the pattern would join two vertices that an edge outside, or on the border, joins already.
  bool joins_neighbours(const ConvexPatch& patch, const PatchPattern& pattern) const {
    const std::vector<int> border = border_of(patch);
    const int n = static_cast<int>(border.size());
    const auto inner_edge = [&](int a, int b) {
      for (const int q : patch.quads) {
        const int i = mesh_.corner_of(q, a);
        for (const int side : {i, (i + 3) & 3})
          if (i >= 0 && mesh_.corner_of(q, b) == ((side == i ? i + 1 : i + 3) & 3)) return true;
      }
      return false;
    };
    for (const auto& quad : pattern.quads)
      for (int i = 0; i < 4; ++i) {
        const int a = quad[i], b = quad[(i + 1) & 3];
        if (a >= n || b >= n || (a + 1) % n == b) continue;
        if (mesh_.has_edge(border[a], border[b]) && !inner_edge(border[a], border[b])) return true;
      }
    return false;
  }

  bool try_pattern(const ConvexPatch& patch, const PatchPattern& pattern) {
    std::vector<int> vertices = border_of(patch);
    const std::vector<Vector3> positions = spread(pattern, vertices);
    if (worst_of(pattern, positions) < purpose_.promising) return false;
    vertices.insert(vertices.end(), patch.inside.begin(), patch.inside.end());
    Trial trial(piece_, smoother_, std::move(vertices), purpose_.measure ? purpose_.measure : worst_if_near(patch));
    replace(patch, pattern, positions);
    return trial.keep(purpose_.good_enough, purpose_.gain);
  }

  /// The quality of the worst quad, or the worst there is if the places of the patch's vertices, which are on the surface, are far
  /// from all quads.
  Trial::Measure worst_if_near(const ConvexPatch& patch) const {
    std::vector<Vector3> places;
    for (const int v : patch.inside) places.push_back(mesh_.positions[v]);
    return [this, places](const std::vector<int>& quads) {
      constexpr double kFar = 0.1;  // edges
      double worst = 1;
      for (const int q : quads) worst = std::min(worst, smoother_.signed_quality(q));
      for (const Vector3& p : places)
        if (squared_distance(p, quads) > kFar * kFar * piece_.h * piece_.h) return -1.0;
      return worst;
    };
  }

  double squared_distance(const Vector3& p, const std::vector<int>& quads) const {
    double least = std::numeric_limits<double>::infinity();
    const auto& x = mesh_.positions;
    for (const int q : quads) {
      const EditMesh::Quad& v = mesh_.quad(q);
      for (const int far : {1, 2})
        least = std::min(least, (nearest_on_triangle(p, x[v[0]], x[v[far]], x[v[far + 1]]) - p).squaredNorm());
    }
    return least;
  }

  /// Positions of the pattern's vertices, evenly spread between those of the border.
  std::vector<Vector3> spread(const PatchPattern& pattern, const std::vector<int>& border) const {
    constexpr int kSweeps = 60;
    const int n = static_cast<int>(border.size());
    std::vector<Vector3> positions(pattern.vertex_count, Vector3::Zero());
    for (int i = 0; i < n; ++i) positions[i] = mesh_.positions[border[i]];
    const Vector3 middle = std::accumulate(positions.begin(), positions.begin() + n, Vector3(Vector3::Zero())) / n;
    std::fill(positions.begin() + n, positions.end(), middle);
    std::vector<std::vector<int>> neighbours(pattern.vertex_count);
    for (const auto& quad : pattern.quads)
      for (int i = 0; i < 4; ++i) neighbours[quad[i]].push_back(quad[(i + 1) & 3]);
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (int v = n; v < pattern.vertex_count; ++v) {
        Vector3 sum = Vector3::Zero();
        for (const int w : neighbours[v]) sum += positions[w];
        positions[v] = sum / static_cast<double>(neighbours[v].size());
      }
    return positions;
  }

  static double worst_of(const PatchPattern& pattern, const std::vector<Vector3>& p) {
    double worst = 1;
    for (const auto& q : pattern.quads) worst = std::min(worst, scaled_jacobian(p[q[0]], p[q[1]], p[q[2]], p[q[3]]));
    return worst;
  }

  void replace(const ConvexPatch& patch, const PatchPattern& pattern, const std::vector<Vector3>& positions) {
    const int region = piece_.region[patch.quads.front()];
    const std::vector<int> border = border_of(patch);
    std::vector<int> vertex = border;
    for (int v = static_cast<int>(border.size()); v < pattern.vertex_count; ++v) {
      const int near = nearest_of(patch.inside, positions[v]);
      const Vector3 normal = near < 0 ? smoother_.frame(patch.quads.front()).normal : smoother_.vertex_normal(near);
      vertex.push_back(piece_.add_vertex(positions[v], near < 0 ? region : mesh_.anchor(near), normal, near < 0 ? -1 : piece_.face[near]));
    }
    for (const int q : patch.quads) mesh_.set_quad(q, mesh_.quad(q), false);
    for (std::size_t i = 0; i < pattern.quads.size(); ++i) {
      EditMesh::Quad corners;
      for (int k = 0; k < 4; ++k) corners[k] = vertex[pattern.quads[i][k]];
      if (i < patch.quads.size())
        mesh_.set_quad(patch.quads[i], corners, true);
      else
        piece_.add_quad(corners, region);
    }
  }

  /// -1 of none.
  int nearest_of(const std::vector<int>& vertices, const Vector3& p) const {
    int nearest = -1;
    for (const int v : vertices)
      if (nearest < 0 || (mesh_.positions[v] - p).squaredNorm() < (mesh_.positions[nearest] - p).squaredNorm()) nearest = v;
    return nearest;
  }

  Workpiece& piece_;
  Smoother& smoother_;
  EditMesh& mesh_;
  Purpose purpose_;
  PatchGrower grower_;
};

}  // namespace

int requadrangulate_patches(Workpiece& piece, Smoother& smoother, const RunContext& context) {
  Requadrangulator patches(piece, smoother);
  int filled = 0;
  for (int v = 0; v < piece.mesh.vertex_count(); ++v) {
    if (valence_cost(piece.mesh, v) < 0.5) continue;
    context.checkpoint();
    filled += patches.refill_around(v);
  }
  return filled;
}

bool requadrangulate_around(Workpiece& piece, Smoother& smoother, int v, const Trial::Measure& measure, double gain) {
  constexpr int kMostQuads = 30;
  const double always = std::numeric_limits<double>::infinity();
  return Requadrangulator(piece, smoother, {kMostQuads, 0, 2, measure, always, gain, -1}).refill_around(v);
}

}  // namespace hybrid_quad
