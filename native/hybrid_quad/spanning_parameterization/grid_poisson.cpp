#include "hybrid_quad/spanning_parameterization/grid_poisson.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/grid_algebra/quarter_turn.h"
#include "hybrid_quad/numerics/sparse_factor.h"
#include "hybrid_quad/periodic_field/phase_graph.h"

namespace hybrid_quad {

namespace {

constexpr double kStiffer = 4;
constexpr double kStiffest = 1e4;
/// A face below this share of the frame's own area counts as folded.
constexpr double kThinShare = 0.03;

double cross(const Vector2& x, const Vector2& y) { return x[0] * y[1] - x[1] * y[0]; }

/// The normal equations for the values at some vertices, the others held.
class SlipProblem {
 public:
  /// \param moves  #V: whose values change
  SlipProblem(const TriangleMesh& mesh, const FrameField& frames, const GridMeasure& measure,
              const LiftedGrid& grid, const std::vector<char>& moves)
      : mesh_(mesh), frames_(frames), measure_(measure), unknown_(mesh.vertex_count(), {-1, -1}) {
    for (int v = 0; v < mesh.vertex_count(); ++v)
      for (int c = 0; c < 2; ++c)
        if (moves[v] && is_free(grid.constraint[v], c)) unknown_[v][c] = count_++;
  }

  /// Adds the best change to the values. \param stiffness  #F, multiplies a face's weight
  void solve(const std::vector<double>& stiffness, const RunContext& context, LiftedGrid& grid) {
    if (count_ == 0) return;
    assemble(stiffness, grid);
    context.checkpoint(0.6);
    SparseFactor factor(lower_, places(), context);
    if (!factor.factorize(lower_, 0, context)) return;
    context.checkpoint(0.7);
    const Eigen::VectorXd change = factor.solve(right_side_, context.threads);
    if (!change.allFinite()) return;
    for (int v = 0; v < mesh_.vertex_count(); ++v)
      for (int c = 0; c < 2; ++c)
        if (unknown_[v][c] >= 0) grid.value[v][c] += change[unknown_[v][c]];
  }

 private:
  static bool is_free(GridConstraint constraint, int coordinate) {
    return constraint == GridConstraint::kFree ||
           (constraint == GridConstraint::kIsolineV && coordinate == 0) ||
           (constraint == GridConstraint::kIsolineU && coordinate == 1);
  }

  bool is_moved(int v) const { return unknown_[v][0] >= 0 || unknown_[v][1] >= 0; }

  std::vector<Vector3> places() const {
    std::vector<Vector3> places(count_);
    for (int v = 0; v < mesh_.vertex_count(); ++v)
      for (const int i : unknown_[v])
        if (i >= 0) places[i] = mesh_.position(v);
    return places;
  }

  void assemble(const std::vector<double>& stiffness, const LiftedGrid& grid) {
    right_side_ = Eigen::VectorXd::Zero(count_);
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(count_);
    entries_.clear();
    for (int h = 0; h < mesh_.halfedge_count(); ++h) {
      const int o = mesh_.opposite(h);
      if (o > h || !(is_moved(mesh_.from(h)) || is_moved(mesh_.to(h)))) continue;
      double weight = edge_weight(mesh_, h) * stiffness[h / 3];
      Vector2 wanted = weight * measure_.along[h];
      if (o >= 0) {
        const double other = edge_weight(mesh_, o) * stiffness[o / 3];
        wanted -= other * turned(measure_.along[o], frames_.matching[o]);
        weight += other;
      }
      add_edge(h, weight, wanted - weight * grid.across_half_edge(mesh_, h), grid, diagonal);
    }
    const double tiny = 1e-10 * std::max(diagonal.mean(), 1e-300);
    for (int i = 0; i < count_; ++i) entries_.emplace_back(i, i, diagonal[i] + tiny);
    lower_.resize(count_, count_);
    lower_.setFromTriplets(entries_.begin(), entries_.end());
  }

  void add_edge(int h, double weight, const Vector2& pull, const LiftedGrid& grid,
                Eigen::VectorXd& diagonal) {
    const int p = mesh_.from(h), q = mesh_.to(h);
    for (int c = 0; c < 2; ++c) {
      const TurnedCoordinate at_p = turned_coordinate(c, grid.corner_turn[h]),
                             at_q = turned_coordinate(c, grid.corner_turn[TriangleMesh::next(h)]);
      const int i = unknown_[p][at_p.source], j = unknown_[q][at_q.source];
      if (i >= 0) {
        diagonal[i] += weight;
        right_side_[i] -= at_p.sign * pull[c];
      }
      if (j >= 0) {
        diagonal[j] += weight;
        right_side_[j] += at_q.sign * pull[c];
      }
      if (i < 0 || j < 0) continue;
      const double coupling = -weight * at_p.sign * at_q.sign;
      if (i == j)
        entries_.emplace_back(i, i, 2 * coupling);
      else
        entries_.emplace_back(std::max(i, j), std::min(i, j), coupling);
    }
  }

  const TriangleMesh& mesh_;
  const FrameField& frames_;
  const GridMeasure& measure_;
  std::vector<IntVector2> unknown_;  ///< #V: index of u and of v, or -1
  int count_ = 0;
  std::vector<Eigen::Triplet<double>> entries_;
  SparseMatrix lower_;
  Eigen::VectorXd right_side_;
};

/// Marks the neighbours of marked faces, ring after ring.
std::vector<char> grown(const TriangleMesh& mesh, std::vector<char> marked, int rings) {
  std::vector<int> border, next;
  for (int f = 0; f < mesh.face_count(); ++f)
    if (marked[f]) border.push_back(f);
  for (int ring = 0; ring < rings; ++ring, border.swap(next)) {
    next.clear();
    for (const int f : border)
      for (int h = 3 * f; h < 3 * f + 3; ++h) {
        const int g = mesh.opposite(h) / 3;
        if (mesh.opposite(h) < 0 || marked[g]) continue;
        marked[g] = 1;
        next.push_back(g);
      }
  }
  return marked;
}

/// Multiplies the weights of folded faces and of two rings of neighbours.
void stiffen(const TriangleMesh& mesh, const std::vector<char>& folded, std::vector<double>& stiffness) {
  const std::vector<char> marked = grown(mesh, folded, 2);
  for (int f = 0; f < mesh.face_count(); ++f)
    if (marked[f]) stiffness[f] = std::min(kStiffest, stiffness[f] * kStiffer);
}

/// Corners of the faces around folds as far as stiffer ones make a difference.
std::vector<char> vertices_around(const TriangleMesh& mesh, const std::vector<char>& folded) {
  constexpr int kRings = 12;
  const std::vector<char> marked = grown(mesh, folded, kRings);
  std::vector<char> near(mesh.vertex_count(), 0);
  for (int h = 0; h < mesh.halfedge_count(); ++h)
    if (marked[h / 3]) near[mesh.from(h)] = 1;
  return near;
}

/// Folds along features count more: both sides of a curve suffer.
int badness(const GridFolds& folds) { return folds.faces + 4 * folds.feature_edges; }

}  // namespace

GridFolds find_folds(const WorkingSurface& surface, const FrameField& frames, const GridMeasure& measure,
                     const LiftedGrid& grid) {
  const TriangleMesh& mesh = surface.mesh;
  GridFolds folds;
  folds.face.assign(mesh.face_count(), 0);
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (unit_count(grid.burgers(f)) != 0) continue;
    const double det = cross(grid.across_half_edge(mesh, 3 * f), grid.across_half_edge(mesh, 3 * f + 1));
    const double own = cross(frames.grid_vector(mesh, 3 * f), frames.grid_vector(mesh, 3 * f + 1));
    folds.face[f] = !(det > kThinShare * std::max(0.0, own));
    folds.faces += folds.face[f];
  }
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (measure.axis[h] < 0 || h < mesh.opposite(h)) continue;
    const double grown = along_sign(measure, h) * grid.across_half_edge(mesh, h)[measure.axis[h]];
    if (grown > kThinShare * measure.along[h].norm()) continue;
    ++folds.feature_edges;
    folds.face[h / 3] = 1;
    if (mesh.opposite(h) >= 0) folds.face[mesh.opposite(h) / 3] = 1;
  }
  return folds;
}

GridFolds spread_slip(const WorkingSurface& surface, const FrameField& frames, const GridMeasure& measure,
                      int stiffening_rounds, const RunContext& context, LiftedGrid& grid) {
  const TriangleMesh& mesh = surface.mesh;
  std::vector<double> stiffness(mesh.face_count(), 1.0);
  std::vector<char> moves(mesh.vertex_count(), 1);
  GridFolds best;
  std::vector<Vector2> best_value;
  for (int round = 0; round <= stiffening_rounds; ++round) {
    SlipProblem(mesh, frames, measure, grid, moves).solve(stiffness, context, grid);
    const GridFolds folds = find_folds(surface, frames, measure, grid);
    if (round == 0 || badness(folds) < badness(best)) {
      best = folds;
      best_value = grid.value;
    }
    if (badness(folds) == 0) break;
    stiffen(mesh, folds.face, stiffness);
    moves = vertices_around(mesh, folds.face);
  }
  grid.value = std::move(best_value);
  return best;
}

}  // namespace hybrid_quad
