#include "hybrid_quad/improve/fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hybrid_quad/base/parallel.h"

namespace hybrid_quad {

namespace {

constexpr int kPerSide = 3;
constexpr std::array<double, kPerSide> kPlaces = {1.0 / 6, 0.5, 5.0 / 6};

std::array<double, 4> corner_weights(double a, double b) { return {(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b}; }

/// What a quad's samples ask its corners to move along the normal, and with which weight.
struct QuadOffset {
  std::array<double, 4> sum{0, 0, 0, 0}, weight{0, 0, 0, 0};
};

QuadOffset offset_of(const Workpiece& piece, const QuadFrame& frame, int q) {
  constexpr double kFarthest = 0.5;  // of an edge: further away is another part of the surface
  const auto& v = piece.mesh.quad(q);
  const auto& p = piece.mesh.positions;
  const double limit = kFarthest * std::sqrt(frame.area);
  constexpr double kAgrees = 0.1;
  SurfaceIndex::Filter filter;
  filter.region = piece.region_filter(piece.region[q]);
  filter.normal = frame.normal;
  filter.min_cosine = kAgrees;
  int face = -1;
  for (const int corner : v)
    if (piece.mesh.is_free(corner) && piece.face[corner] >= 0) face = piece.face[corner];
  QuadOffset offset;
  for (const double a : kPlaces)
    for (const double b : kPlaces) {
      const std::array<double, 4> w = corner_weights(a, b);
      const Vector3 at = w[0] * p[v[0]] + w[1] * p[v[1]] + w[2] * p[v[2]] + w[3] * p[v[3]];
      SurfacePoint near;
      if (face >= 0) near = piece.walk(at, face);
      if (near.face < 0 || piece.input.normal(near.face).dot(frame.normal) < kAgrees) near = piece.index.nearest(at, filter);
      if (near.face < 0) continue;
      face = near.face;
      const double d = (near.position - at).dot(frame.normal);
      if (!(std::abs(d) <= limit)) continue;
      for (int i = 0; i < 4; ++i) {
        offset.sum[i] += w[i] * d;
        offset.weight[i] += w[i];
      }
    }
  return offset;
}

bool has_any(const std::vector<char>* vertices, const EditMesh::Quad& quad) {
  return vertices == nullptr || std::any_of(quad.begin(), quad.end(), [&](int v) { return (*vertices)[v] != 0; });
}

/// \param only  #V: of the quads at these; null: of all
std::vector<QuadOffset> all_offsets(const Workpiece& piece, const Smoother& smoother, const RunContext& context,
                                    const std::vector<char>* only) {
  constexpr int kChunk = 256;
  const int count = piece.mesh.quad_count(), chunks = (count + kChunk - 1) / kChunk;
  std::vector<QuadOffset> offsets(count);
  context.checkpoint();
  parallel_for(chunks, context.threads, [&](int c) {
    for (int q = c * kChunk; q < std::min(count, (c + 1) * kChunk); ++q)
      if (piece.mesh.alive(q) && has_any(only, piece.mesh.quad(q))) offsets[q] = offset_of(piece, smoother.frame(q), q);
  });
  return offsets;
}

/// Puts vertices back until no quad is worse than it was or than it should be; a few rounds, then all of what is left.
void put_back_where_worse(Workpiece& piece, const Smoother& smoother, const std::vector<Vector3>& kept,
                          const std::vector<double>& quality) {
  constexpr double kGoodEnough = 0.5, kLoss = 0.02;
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    bool any = false;
    std::vector<char> back(piece.mesh.vertex_count(), 0);
    for (int q = 0; q < piece.mesh.quad_count(); ++q) {
      if (!piece.mesh.alive(q)) continue;
      const double now = smoother.signed_quality(q);
      if (now >= kGoodEnough || now >= quality[q] - kLoss) continue;
      for (const int v : piece.mesh.quad(q)) back[v] = 1;
    }
    for (int v = 0; v < piece.mesh.vertex_count(); ++v)
      if (back[v] && piece.mesh.positions[v] != kept[v]) {
        piece.mesh.positions[v] = kept[v];
        any = true;
      }
    if (!any) return;
  }
}

}  // namespace

void fit_to_input(Workpiece& piece, Smoother& smoother, const RunContext& context, const std::vector<char>* only) {
  constexpr double kLargestMove = 0.3;  // of an edge
  smoother.update_frames(false);
  const int n = piece.mesh.vertex_count();
  const std::vector<QuadOffset> offsets = all_offsets(piece, smoother, context, only);
  std::vector<double> sum(n, 0.0), weight(n, 0.0), quality(piece.mesh.quad_count(), 1.0);
  for (int q = 0; q < piece.mesh.quad_count(); ++q) {
    if (!piece.mesh.alive(q)) continue;
    quality[q] = smoother.signed_quality(q);
    for (int i = 0; i < 4; ++i) {
      sum[piece.mesh.quad(q)[i]] += offsets[q].sum[i];
      weight[piece.mesh.quad(q)[i]] += offsets[q].weight[i];
    }
  }
  const std::vector<Vector3> kept = piece.mesh.positions;
  for (int v = 0; v < n; ++v) {
    if (only && !(*only)[v]) continue;
    if (!piece.mesh.is_free(v) || piece.mesh.is_pinned(v) || piece.mesh.valence(v) == 0 || !(weight[v] > 0)) continue;
    double area = 0;
    for (const int q : piece.mesh.quads_at(v)) area += smoother.frame(q).area;
    const double limit = kLargestMove * std::sqrt(area / piece.mesh.valence(v)), d = sum[v] / weight[v];
    piece.mesh.positions[v] += std::max(-limit, std::min(limit, d)) * smoother.vertex_normal(v);
  }
  smoother.update_frames(false);
  put_back_where_worse(piece, smoother, kept, quality);
  smoother.update_frames(false);
}

}  // namespace hybrid_quad
