#include "hybrid_quad/improve/untangle.h"

#include <algorithm>
#include <array>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

namespace {

double own_quality(const EditMesh& mesh, int q) {
  const auto& v = mesh.quad(q);
  return scaled_jacobian(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]], mesh.positions[v[3]]);
}

std::vector<int> sorted_unique(std::vector<int> list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
  return list;
}

std::vector<int> vertices_of(const EditMesh& mesh, const std::vector<int>& quads) {
  std::vector<int> vertices;
  for (const int q : quads) vertices.insert(vertices.end(), mesh.quad(q).begin(), mesh.quad(q).end());
  return sorted_unique(std::move(vertices));
}

std::vector<int> quads_around(const EditMesh& mesh, const std::vector<int>& vertices) {
  std::vector<int> quads;
  for (const int v : vertices) quads.insert(quads.end(), mesh.quads_at(v).begin(), mesh.quads_at(v).end());
  return sorted_unique(std::move(quads));
}

/// Sum over quads of how far each is below a fair quality, by its own normal and by the input's.
double badness(const Workpiece& piece, const Smoother& smoother, const std::vector<int>& quads) {
  constexpr double kFair = 0.3;
  double sum = 0;
  for (const int q : quads)
    sum += std::max(0.0, kFair - std::min(own_quality(piece.mesh, q), smoother.signed_quality(q)));
  return sum;
}

bool looks_against_input(const Workpiece& piece, int q) {
  std::array<Vector3, 4> corners;
  Lookup lookup;
  for (int i = 0; i < 4; ++i) {
    const int v = piece.mesh.quad(q)[i];
    corners[i] = piece.mesh.positions[v];
    lookup.face = std::max(lookup.face, piece.face[v]);
  }
  return is_inverted(corners, piece.index, {}, &lookup);
}

struct PlaceReport {
  int relaxed = 0;  ///< vertices
  bool is_better = false;
};

/// Relaxes `rings` rings around q, if that makes them less bad.
PlaceReport untangle_place(Workpiece& piece, Smoother& smoother, int q, int rings) {
  constexpr double kRegularisation[] = {0.5, 0.2, 0.07, 0.02, 1e-3};
  constexpr int kSweeps = 4;
  std::vector<int> inside = vertices_of(piece.mesh, {q});
  for (int ring = 0; ring < rings; ++ring) inside = vertices_of(piece.mesh, quads_around(piece.mesh, inside));
  const std::vector<int> quads = quads_around(piece.mesh, inside);
  smoother.update_frames(quads, true);
  const double before = badness(piece, smoother, quads);
  std::vector<Vector3> positions;
  std::vector<int> faces;
  std::vector<double> arcs;
  for (const int v : inside) {
    positions.push_back(piece.mesh.positions[v]);
    faces.push_back(piece.face[v]);
    arcs.push_back(piece.arc[v]);
  }
  for (const int v : inside)
    if (piece.mesh.is_free(v) && !piece.mesh.is_pinned(v) && piece.face[v] >= 0) {
      const SurfacePoint point = piece.walk(piece.mesh.positions[v], piece.face[v]);
      piece.mesh.positions[v] = point.position;
      piece.face[v] = point.face;
    }
  for (const double eps : kRegularisation) smoother.relax(inside, kSweeps, eps);
  smoother.update_frames(quads, true);
  const int relaxed = static_cast<int>(inside.size());
  if (badness(piece, smoother, quads) < before) return {relaxed, true};
  for (std::size_t i = 0; i < inside.size(); ++i) {
    piece.mesh.positions[inside[i]] = positions[i];
    piece.face[inside[i]] = faces[i];
    piece.arc[inside[i]] = arcs[i];
  }
  smoother.update_frames(quads, true);
  return {relaxed, false};
}

}  // namespace

std::vector<int> tangled_quads(const Workpiece& piece, int threads) {
  constexpr int kChunk = 256;
  const int count = piece.mesh.quad_count();
  std::vector<char> is_tangled(count, 0);
  parallel_for((count + kChunk - 1) / kChunk, threads, [&](int c) {
    for (int q = c * kChunk; q < std::min(count, (c + 1) * kChunk); ++q)
      is_tangled[q] = piece.mesh.alive(q) && (own_quality(piece.mesh, q) <= 0 || looks_against_input(piece, q));
  });
  std::vector<int> tangled;
  for (int q = 0; q < count; ++q)
    if (is_tangled[q]) tangled.push_back(q);
  return tangled;
}

int untangle(Workpiece& piece, Smoother& smoother, const RunContext& context, FutileUntangling& futile) {
  constexpr int kEffort = 1, kLeastEffort = 600;
  // Vertices to relax in all places together: where the whole mesh is bad, no place can be mended alone.
  int effort = kLeastEffort + kEffort * piece.mesh.vertex_count();
  std::vector<int> tangled = tangled_quads(piece, context.threads);
  const int rounds = static_cast<int>(futile.size());
  for (int round = 0; round < rounds && !tangled.empty(); ++round) {
    for (const int q : tangled) {
      context.checkpoint(static_cast<double>(round) / rounds);
      if (effort <= 0 || futile[round].knows(piece, q)) continue;
      const PlaceReport place = untangle_place(piece, smoother, q, 1 + round);
      effort -= place.relaxed;
      if (!place.is_better) futile[round].remember(piece, q);
    }
    tangled = tangled_quads(piece, context.threads);
  }
  return static_cast<int>(tangled.size());
}

}  // namespace hybrid_quad
