#include "hybrid_quad/improve/crowding.h"

#include <array>
#include <vector>

#include "hybrid_quad/improve/quad_moves.h"

namespace hybrid_quad {

namespace {

double mean_square_side(const EditMesh& mesh, int q) {
  double sum = 0;
  for (int i = 0; i < 4; ++i)
    sum += (mesh.positions[mesh.quad(q)[(i + 1) & 3]] - mesh.positions[mesh.quad(q)[i]]).squaredNorm();
  return sum / 4;
}

Vector3 mean_of_neighbours(const EditMesh& mesh, int v) {
  Vector3 sum = Vector3::Zero();
  for (const int q : mesh.quads_at(v)) {
    const int i = mesh.corner_of(q, v);
    sum += mesh.positions[mesh.quad(q)[(i + 1) & 3]] + mesh.positions[mesh.quad(q)[(i + 3) & 3]];
  }
  return sum / (2.0 * mesh.valence(v));
}

/// Mean squared sides of the quads a few rings around every quad.
std::vector<double> size_around(const EditMesh& mesh, const std::vector<double>& own) {
  constexpr int kRings = 4;
  std::vector<double> around = own, at_vertex(mesh.vertex_count(), 0.0);
  for (int ring = 0; ring < kRings; ++ring) {
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      double sum = 0;
      for (const int q : mesh.quads_at(v)) sum += around[q];
      if (mesh.valence(v) > 0) at_vertex[v] = sum / mesh.valence(v);
    }
    for (int q = 0; q < mesh.quad_count(); ++q) {
      const auto& v = mesh.quad(q);
      around[q] = 0.25 * (at_vertex[v[0]] + at_vertex[v[1]] + at_vertex[v[2]] + at_vertex[v[3]]);
    }
  }
  return around;
}

/// Free vertices of quads that are far smaller than those around, and of the quads beside them.
std::vector<int> crowded_vertices(const Workpiece& piece) {
  constexpr double kSmall = 0.08;  // of the squared side around
  std::vector<double> own(piece.mesh.quad_count());
  for (int q = 0; q < piece.mesh.quad_count(); ++q) own[q] = mean_square_side(piece.mesh, q);
  const std::vector<double> around = size_around(piece.mesh, own);
  std::vector<char> crowded(piece.mesh.vertex_count(), 0);
  for (int q = 0; q < piece.mesh.quad_count(); ++q)
    if (piece.mesh.alive(q) && own[q] < kSmall * around[q])
      for (const int v : piece.mesh.quad(q)) crowded[v] = 1;
  std::vector<int> vertices;
  for (int v = 0; v < piece.mesh.vertex_count(); ++v) {
    bool beside = false;
    for (const int q : piece.mesh.quads_at(v))
      for (const int w : piece.mesh.quad(q)) beside |= crowded[w] != 0;
    if (beside && piece.mesh.is_free(v) && !piece.mesh.is_pinned(v) && piece.face[v] >= 0) vertices.push_back(v);
  }
  return vertices;
}

/// Shrinks q to the diagonal whose valences suffer less, if they suffer by at most `most_cost`.
bool collapse_cheaper_diagonal(Workpiece& piece, int q, double most_cost) {
  Move best{Move::kCollapse, -1, 0};
  double best_cost = most_cost;
  for (const int corner : {0, 1}) {
    const Move move{Move::kCollapse, q, corner};
    Changed changed;
    if (!may_move(piece.mesh, move, &changed)) continue;
    const double cost = cost_of_move(piece.mesh, move, changed);
    if (cost <= best_cost) {
      best_cost = cost;
      best = move;
    }
  }
  if (best.quad < 0) return false;
  make_move(piece.mesh, best);
  return true;
}

/// Undoes a pillow: a quad whose corners all have three quads goes with its ring of four, which one quad replaces.
bool remove_pillow(EditMesh& mesh, int q) {
  const EditMesh::Quad inner = mesh.quad(q);
  EditMesh::Quad outer;
  std::array<int, 4> ring;
  for (int i = 0; i < 4; ++i) {
    const int v = inner[i];
    if (!mesh.is_free(v) || mesh.is_pinned(v) || mesh.on_boundary(v) || !mesh.feature_links(v).empty() || mesh.valence(v) != 3) return false;
    ring[i] = mesh.across(q, i);
    if (ring[i] < 0) return false;
    // Across side i the ring's quad runs (.., inner[i + 1], inner[i], outer[i], outer[i + 1]).
    outer[i] = mesh.quad(ring[i])[(mesh.corner_of(ring[i], v) + 1) & 3];
  }
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) & 3;
    if (mesh.quad(ring[i])[(mesh.corner_of(ring[i], inner[i]) + 2) & 3] != outer[j]) return false;
    if (outer[i] == outer[j] || outer[i] == outer[(i + 2) & 3]) return false;
    if (mesh.valence(outer[i]) <= mesh.least_valence(outer[i])) return false;
  }
  for (const int side : ring) mesh.set_quad(side, mesh.quad(side), false);
  mesh.set_quad(q, outer, true);
  return true;
}

}  // namespace

void spread_crowded(Workpiece& piece, const RunContext& context) {
  constexpr int kSweeps = 40;
  const std::vector<int> vertices = crowded_vertices(piece);
  for (int sweep = 0; sweep < kSweeps && !vertices.empty(); ++sweep) {
    context.checkpoint();
    for (const int v : vertices) {
      const SurfacePoint point = piece.walk(mean_of_neighbours(piece.mesh, v), piece.face[v]);
      piece.face[v] = point.face;
      piece.mesh.positions[v] = point.position;
    }
  }
}


int remove_crowded(Workpiece& piece, const RunContext& context) {
  constexpr double kSmall = 0.1;  // of the squared target side
  constexpr double kMostCost = 4;
  constexpr int kPasses = 20;
  int removed = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    context.checkpoint();
    const int before = removed;
    for (int q = 0; q < piece.mesh.quad_count(); ++q)
      if (piece.mesh.alive(q) && mean_square_side(piece.mesh, q) < kSmall * piece.h * piece.h)
        removed += remove_pillow(piece.mesh, q) || collapse_cheaper_diagonal(piece, q, kMostCost);
    if (removed == before) break;
  }
  piece.mesh.forget_log();
  return removed;
}

}  // namespace hybrid_quad
