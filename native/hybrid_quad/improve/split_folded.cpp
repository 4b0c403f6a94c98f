#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/mesh_patch.h"
#include "hybrid_quad/improve/shape_descent.h"
#include "hybrid_quad/improve/side_splitting.h"

namespace hybrid_quad {

namespace {

std::vector<int> all_quads(const QuadMesh& mesh) {
  std::vector<int> all(mesh.quads.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Splits a side of one folded quad after another, each on a patch of its own: what is around finds new places with every split
/// that is tried, first in haste, then the best few of them thoroughly.
class FoldedSplitter {
 public:
  FoldedSplitter(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                 const SurfaceIndex& whole, const ImproveOptions& options, const RunContext& context)
      : quads_(quads), input_(input), features_(features), index_(index), whole_(whole), options_(options), context_(context),
        edge_(options.target_length > 0 ? options.target_length : mean_edge_length(quads)),
        tries_left_(kLeastTries + static_cast<int>(quads.quads.size()) / kQuadsATry) {}

  /// \param most_quads  in all
  int run(std::size_t most_quads) {
    constexpr std::size_t kMostMore = 6;  // quads by one split
    int splits = 0;
    is_futile_.assign(quads_.quads.size(), 0);
    find_quads_at();
    for (int q = worst_folded(); q >= 0 && tries_left_ > 0 && quads_.quads.size() + kMostMore <= most_quads; q = worst_folded()) {
      context_.checkpoint();
      is_futile_[q] = 1;
      --tries_left_;
      splits += split(q);
    }
    return splits;
  }

 private:
  struct Trial {
    QuadMesh mesh;
    std::vector<int> moving;  ///< vertices
    Shapes shapes;
  };

  double shape(int q) const {
    const auto& v = quads_.quads[q];
    const auto& p = quads_.positions;
    return scaled_jacobian(p[v[0]], p[v[1]], p[v[2]], p[v[3]]);
  }

  /// Of those that have not been tried in vain; -1: none.
  int worst_folded() const {
    int worst = -1;
    double least = kFolded;
    for (int q = 0; q < static_cast<int>(quads_.quads.size()); ++q)
      if (!is_futile_[q] && shape(q) <= least) {
        if (worst >= 0 && shape(q) == least) continue;
        least = shape(q);
        worst = q;
      }
    return worst;
  }

  void find_quads_at() {
    quads_at_.assign(quads_.positions.size(), {});
    for (int q = 0; q < static_cast<int>(quads_.quads.size()); ++q)
      for (const int v : quads_.quads[q]) quads_at_[v].push_back(q);
  }

  std::vector<int> quads_around(const std::vector<int>& vertices) const {
    std::vector<int> around;
    for (const int v : vertices) around.insert(around.end(), quads_at_[v].begin(), quads_at_[v].end());
    std::sort(around.begin(), around.end());
    around.erase(std::unique(around.begin(), around.end()), around.end());
    return around;
  }

  /// The quad with a ring whose vertices may move, and the quads at these.
  MeshPatch patch_around(int q) const {
    std::vector<int> ring;
    for (const int other : quads_around({quads_.quads[q].begin(), quads_.quads[q].end()}))
      ring.insert(ring.end(), quads_.quads[other].begin(), quads_.quads[other].end());
    return cut_patch(quads_, quads_around(ring));
  }

  bool split(int q) {
    constexpr std::size_t kThorough = 3;
    MeshPatch patch = patch_around(q);
    const int own = static_cast<int>(std::lower_bound(patch.quads.begin(), patch.quads.end(), q) - patch.quads.begin());
    std::vector<Trial> trials = trials_at(own, patch.mesh);
    std::stable_sort(trials.begin(), trials.end(), [](const Trial& x, const Trial& y) {
      return std::make_tuple(x.shapes.flawed, x.shapes.folded, x.shapes.lack) < std::make_tuple(y.shapes.flawed, y.shapes.folded, y.shapes.lack);
    });
    if (trials.size() > kThorough) trials.resize(kThorough);
    const Shapes before = shapes_of_patch(patch.mesh);
    for (Trial& trial : trials) {
      relax(trial, DescentPlan{});
      if (trial.shapes.flawed > before.flawed || trial.shapes.folded >= before.folded || trial.shapes.worst < before.worst) continue;
      patch.mesh = std::move(trial.mesh);
      put_back(patch, quads_);
      is_futile_.resize(quads_.quads.size(), 0);
      for (const int changed : patch.quads) is_futile_[changed] = 0;
      find_quads_at();
      return true;
    }
    return false;
  }

  std::vector<Trial> trials_at(int q, const QuadMesh& mesh) {
    constexpr DescentPlan kHaste{{0.3, 0.15, 0.07, 0.03}, 4};
    Workpiece piece = located(mesh);
    const SideSplitter splitter(mesh, index_, piece.region);
    const std::vector<int> ring = with_ring(piece.mesh, {mesh.quads[q].begin(), mesh.quads[q].end()});
    std::vector<Trial> trials;
    for (int side = 0; side < 4; ++side) {
      const QuadMesh::FeatureEdge* edge = splitter.feature_edge(mesh.quads[q][side], mesh.quads[q][(side + 1) & 3]);
      if (!may_split(edge, features_)) continue;
      for (const SideSplit& split : sound_splits(q, side, splitter.across(q, side) < 0)) {
        std::vector<int> changed;
        Trial trial{splitter.split(split, path_of(mesh, piece, edge, split), &changed), ring, {}};
        for (int v = static_cast<int>(mesh.positions.size()); v < static_cast<int>(trial.mesh.positions.size()); ++v) trial.moving.push_back(v);
        relax(trial, kHaste);
        trials.push_back(std::move(trial));
      }
    }
    return trials;
  }

  Workpiece located(const QuadMesh& mesh) const {
    Workpiece piece(mesh, input_, features_, index_);
    piece.h = edge_;
    piece.locate_all();
    return piece;
  }

  void relax(Trial& trial, const DescentPlan& plan) const {
    Workpiece piece = located(trial.mesh);
    const FlawMeasure measure(piece, whole_, options_.agreement);
    ShapeDescent(piece, measure, trial.moving).descend(plan);
    trial.mesh = piece.mesh.extract(piece.face);
    trial.shapes = shapes_of(piece.mesh, all_quads(trial.mesh), measure);
  }

  Shapes shapes_of_patch(const QuadMesh& mesh) const {
    const Workpiece piece = located(mesh);
    const FlawMeasure measure(piece, whole_, options_.agreement);
    return shapes_of(piece.mesh, all_quads(mesh), measure);
  }

  static constexpr int kLeastTries = 8, kQuadsATry = 250;
  QuadMesh& quads_;
  const TriangleMesh& input_;
  const FeatureGraph& features_;
  const SurfaceIndex& index_;
  const SurfaceIndex& whole_;
  const ImproveOptions& options_;
  const RunContext& context_;
  double edge_;
  int tries_left_;
  std::vector<std::vector<int>> quads_at_;
  std::vector<char> is_futile_;  ///< #Q
};

}  // namespace

int split_folded_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                       const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole) {
  // Folded quads are valid: the number that was asked for matters more than many of them.
  constexpr std::size_t kMostMore = 50, kFewMore = 8;  // a fiftieth of the quads, or a few
  const std::size_t most_quads = quads.quads.size() + std::max(kFewMore, quads.quads.size() / kMostMore);
  return FoldedSplitter(quads, input, features, index, whole ? *whole : index, options, context).run(most_quads);
}

}  // namespace hybrid_quad
