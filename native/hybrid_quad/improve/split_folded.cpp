#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "hybrid_quad/base/parallel.h"
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
        most_quads_(quads.quads.size() + std::max(kFewMore, quads.quads.size() / kMostMore)),
        failures_left_(kLeastFailures + static_cast<int>(quads.quads.size()) / kQuadsAFailure) {}

  int run() {
    int splits = 0;
    is_futile_.assign(quads_.quads.size(), 0);
    if (worst_folded() < 0) return 0;
    find_quads_at();
    for (int q = worst_folded(); q >= 0 && failures_left_ > 0; q = worst_folded()) {
      context_.checkpoint();
      if (boxes_opened_ > options_.most_boxes_opened) {
        is_ended_ = true;
        break;
      }
      is_futile_[q] = 1;
      const int split_sides = split(q);
      if (split_sides == 0) --failures_left_;
      splits += split_sides;
    }
    return splits;
  }
  bool is_ended() const { return is_ended_; }  ///< by ImproveOptions::most_boxes_opened

 private:
  struct Trial {
    QuadMesh mesh;
    std::vector<int> moving;  ///< vertices
    Shapes shapes;
    long long boxes_opened = 0;  ///< by the latest relaxation
  };

  static double shape_of(const QuadMesh& mesh, int q) {
    const auto& v = mesh.quads[q];
    const auto& p = mesh.positions;
    return scaled_jacobian(p[v[0]], p[v[1]], p[v[2]], p[v[3]]);
  }

  /// Of those that have not been tried in vain; -1: none.
  int worst_folded() const {
    int worst = -1;
    double least = kFolded;
    for (int q = 0; q < static_cast<int>(quads_.quads.size()); ++q) {
      const double shape = shape_of(quads_, q);
      if (is_futile_[q] || shape > least || (worst >= 0 && shape == least)) continue;
      least = shape;
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
  MeshPatch patch_around(int q) const { return cut_patch(quads_, quads_around(vertices_of(quads_, quads_around(vertices_of(quads_, {q}))))); }

  /// The vertices of the quads around one of a patch.
  static std::vector<int> ring_around(const QuadMesh& mesh, int q) {
    const auto& own = mesh.quads[q];
    std::vector<int> around;
    for (int other = 0; other < static_cast<int>(mesh.quads.size()); ++other)
      if (std::any_of(own.begin(), own.end(), [&](int v) { return std::count(mesh.quads[other].begin(), mesh.quads[other].end(), v) > 0; }))
        around.push_back(other);
    return vertices_of(mesh, around);
  }

  static std::vector<int> vertices_of(const QuadMesh& mesh, const std::vector<int>& quads) {
    std::vector<int> vertices;
    for (const int q : quads) vertices.insert(vertices.end(), mesh.quads[q].begin(), mesh.quads[q].end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  /// Splits a side of quad q; if that does not do, one of a quad that it leaves folded as well. \returns sides split
  int split(int q) {
    constexpr int kMostSplits = 2;
    MeshPatch patch = patch_around(q);
    const int own = static_cast<int>(std::lower_bound(patch.quads.begin(), patch.quads.end(), q) - patch.quads.begin());
    std::optional<Trial> trial = Trial{patch.mesh, ring_around(patch.mesh, own), shapes_of_patch(patch.mesh)};
    const Shapes before = trial->shapes;
    const std::size_t most = most_quads_ + patch.quads.size() - std::min(quads_.quads.size(), most_quads_);
    for (int splits = 1; splits <= kMostSplits; ++splits) {
      const int folded = splits == 1 ? own : worst_inside(*trial);
      if (folded < 0 || !(trial = best_split(*trial, folded, before, most))) return 0;
      if (!is_worth_it(trial->shapes, before)) continue;
      patch.mesh = std::move(trial->mesh);
      put_back(patch, quads_);
      is_futile_.resize(quads_.quads.size(), 0);
      for (const int changed : patch.quads) is_futile_[changed] = 0;
      find_quads_at();
      return splits;
    }
    return 0;
  }

  static bool is_worth_it(const Shapes& now, const Shapes& before) {
    constexpr double kMuch = 0.1;
    if (now.flaws > before.flaws || now.folded > before.folded || now.worst < before.worst) return false;
    return now.folded < before.folded || now.worst >= before.worst + kMuch;
  }

  /// The first of the likeliest that is worth it, else the best of them that has no more flaws. \param most  quads of the patch
  std::optional<Trial> best_split(const Trial& start, int q, const Shapes& before, std::size_t most) {
    constexpr std::size_t kThorough = 3;
    const auto badness = [](const Trial& trial) { return std::make_tuple(trial.shapes.flaws, trial.shapes.folded, trial.shapes.lack); };
    std::vector<Trial> trials = trials_at(q, start, most);
    std::stable_sort(trials.begin(), trials.end(), [&](const Trial& x, const Trial& y) { return badness(x) < badness(y); });
    if (trials.size() > kThorough) trials.resize(kThorough);
    std::optional<Trial> best;
    for (Trial& trial : trials) {
      relax(trial, DescentPlan{});
      boxes_opened_ += trial.boxes_opened;
      if (is_worth_it(trial.shapes, before)) return trial;
      if (trial.shapes.flaws <= before.flaws && (!best || badness(trial) < badness(*best))) best = std::move(trial);
    }
    return best;
  }

  /// The worst folded quad all of whose vertices move, so that all quads around it are on the patch; -1: none.
  static int worst_inside(const Trial& trial) {
    int worst = -1;
    double least = kFolded;
    for (int q = 0; q < static_cast<int>(trial.mesh.quads.size()); ++q) {
      const auto& v = trial.mesh.quads[q];
      const auto moves = [&](int vertex) { return std::find(trial.moving.begin(), trial.moving.end(), vertex) != trial.moving.end(); };
      if (!std::all_of(v.begin(), v.end(), moves)) continue;
      const double shape = shape_of(trial.mesh, q);
      if (shape > least || (worst >= 0 && shape == least)) continue;
      least = shape;
      worst = q;
    }
    return worst;
  }

  std::vector<Trial> trials_at(int q, const Trial& start, std::size_t most) {
    constexpr DescentPlan kHaste{{0.3, 0.15, 0.07, 0.03}, 4};
    const QuadMesh& mesh = start.mesh;
    const Workpiece piece = located(mesh);
    const SideSplitter splitter(mesh, index_, piece.region);
    std::vector<Trial> trials;
    for (int side = 0; side < 4; ++side) {
      const QuadMesh::FeatureEdge* edge = splitter.feature_edge(mesh.quads[q][side], mesh.quads[q][(side + 1) & 3]);
      if (!may_split(edge, features_)) continue;
      for (const SideSplit& split : sound_splits(q, side, splitter.across(q, side) < 0)) {
        std::vector<int> changed;
        Trial trial{splitter.split(split, path_of(mesh, piece, edge, split), &changed), start.moving, {}};
        if (trial.mesh.quads.size() > most) continue;
        for (int v = static_cast<int>(mesh.positions.size()); v < static_cast<int>(trial.mesh.positions.size()); ++v) trial.moving.push_back(v);
        trials.push_back(std::move(trial));
      }
    }
    parallel_for(static_cast<int>(trials.size()), context_.threads, [&](int i) { relax(trials[i], kHaste); });
    for (const Trial& trial : trials) boxes_opened_ += trial.boxes_opened;
    return trials;
  }

  Workpiece located(const QuadMesh& mesh) const {
    Workpiece piece(mesh, input_, features_, index_);
    piece.h = edge_;
    piece.locate_all();  // a patch: nothing to share
    return piece;
  }

  void relax(Trial& trial, const DescentPlan& plan) const {
    Workpiece piece = located(trial.mesh);
    const FlawMeasure measure(piece, whole_, options_.agreement, &options_.least_agreement);
    ShapeDescent(piece, measure, trial.moving).descend(plan);
    trial.mesh = piece.mesh.extract(piece.face);
    trial.shapes = shapes_of(piece.mesh, all_quads(trial.mesh), measure);
    trial.boxes_opened = measure.boxes_opened();
  }

  Shapes shapes_of_patch(const QuadMesh& mesh) const {
    const Workpiece piece = located(mesh);
    const FlawMeasure measure(piece, whole_, options_.agreement, &options_.least_agreement);
    return shapes_of(piece.mesh, all_quads(mesh), measure);
  }

  // Folded quads are valid: the number that was asked for matters more than many of them.
  static constexpr std::size_t kMostMore = 50, kFewMore = 8;  // a fiftieth of the quads, or a few
  static constexpr int kLeastFailures = 4, kQuadsAFailure = 1000;
  QuadMesh& quads_;
  const TriangleMesh& input_;
  const FeatureGraph& features_;
  const SurfaceIndex& index_;
  const SurfaceIndex& whole_;
  const ImproveOptions& options_;
  const RunContext& context_;
  double edge_;
  std::size_t most_quads_;
  long long boxes_opened_ = 0;
  bool is_ended_ = false;
  int failures_left_;  ///< each takes a tenth of a second or so, whatever the size of the mesh
  std::vector<std::vector<int>> quads_at_;
  std::vector<char> is_futile_;  ///< #Q
};

}  // namespace

int split_folded_quads(QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features, const SurfaceIndex& index,
                       const ImproveOptions& options, const RunContext& context, const SurfaceIndex* whole, int* ended_searches) {
  FoldedSplitter splitter(quads, input, features, index, whole ? *whole : index, options, context);
  const int splits = splitter.run();
  if (ended_searches) *ended_searches += splitter.is_ended();
  return splits;
}

}  // namespace hybrid_quad
