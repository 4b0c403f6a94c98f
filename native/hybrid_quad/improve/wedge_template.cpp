#include "hybrid_quad/improve/wedge_template.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>
#include <vector>

#include "hybrid_quad/improve/quad_moves.h"
#include "hybrid_quad/improve/trial.h"

namespace hybrid_quad {

namespace {

/// One way to place the template, as seen from the straight vertex v; mirrored where `mirrored`.
struct Place {
  int quad, other;
  int a, v, b, c, x, y;  ///< a, v, b on the feature; b c is the side shared with `other`
  bool mirrored;
};

/// Whether both sides of quad q at v are features.
bool is_straight_at(const EditMesh& mesh, int v, int q) {
  if (!mesh.alive(q)) return false;
  const auto& corners = mesh.quad(q);
  const auto at = std::find(corners.begin(), corners.end(), v);
  if (at == corners.end()) return false;
  const auto i = at - corners.begin();
  return mesh.is_feature(v, corners[(i + 1) & 3]) && mesh.is_feature(v, corners[(i + 3) & 3]);
}

bool place_on(const EditMesh& mesh, int v, int q, bool mirrored, Place* place) {
  const auto& corners = mesh.quad(q);
  const int i = mesh.corner_of(q, v);
  const int next = corners[(i + 1) & 3], far = corners[(i + 2) & 3], last = corners[(i + 3) & 3];
  const int b = mirrored ? last : next;
  if (mesh.is_feature(b, far)) return false;
  const int side = mirrored ? (i + 2) & 3 : (i + 1) & 3;
  const int other = mesh.across(q, side);
  if (other < 0 || mesh.is_locked(q) || mesh.is_locked(other)) return false;
  const auto& o = mesh.quad(other);
  const int k = mesh.corner_of(other, far);
  // Unmirrored the neighbour reads (c, b, x, y); mirrored, (c, y, x, b).
  const int y = mirrored ? o[(k + 1) & 3] : o[(k + 3) & 3];
  *place = {q, other, mirrored ? next : last, v, b, far, o[(k + 2) & 3], y, mirrored};
  return place->x != place->a && place->y != place->a && place->y != v && place->x != v;
}

double price(const EditMesh& mesh, int y) {
  if (!mesh.is_free(y)) return 1.5 + valence_cost(mesh, y);
  const int n = mesh.valence(y);
  return n < 4 ? -1 : n == 4 ? 1 : 3 + n;
}

void apply(Workpiece& piece, const Smoother& smoother, const Place& t) {
  const auto& p = piece.mesh.positions;
  const int region = piece.region[t.quad];
  const Vector3 normal = smoother.frame(t.quad).normal, beside = smoother.frame(t.other).normal;
  const Vector3 inner = 0.5 * p[t.v] + 0.25 * p[t.c] + 0.125 * p[t.b] + 0.125 * p[t.a];
  const Vector3 outer = 0.4 * p[t.b] + 0.25 * p[t.y] + 0.2 * p[t.x] + 0.15 * p[t.c];
  const int m = piece.add_vertex(inner, region, normal), n = piece.add_vertex(outer, region, beside);
  const auto oriented = [&](EditMesh::Quad q) { return t.mirrored ? EditMesh::Quad{q[3], q[2], q[1], q[0]} : q; };
  piece.mesh.set_quad(t.quad, oriented({t.a, t.v, m, t.c}), true);
  piece.mesh.set_quad(t.other, oriented({t.v, t.b, n, m}), true);
  piece.add_quad(oriented({m, n, t.y, t.c}), region);
  piece.add_quad(oriented({t.b, t.x, t.y, n}), region);
}

/// Puts a ring of four quads inside q: for quads with features all around, where the template has no neighbour to use.
void pillow(Workpiece& piece, const Smoother& smoother, int q) {
  const EditMesh::Quad corners = piece.mesh.quad(q);
  const int region = piece.region[q];
  const Vector3 normal = smoother.frame(q).normal;
  Vector3 centre = Vector3::Zero();
  for (const int v : corners) centre += 0.25 * piece.mesh.positions[v];
  EditMesh::Quad inner;
  for (int i = 0; i < 4; ++i)
    inner[i] = piece.add_vertex(0.5 * (piece.mesh.positions[corners[i]] + centre), region, normal);
  piece.mesh.set_quad(q, inner, true);
  for (int i = 0; i < 4; ++i) {
    const int j = (i + 1) & 3;
    piece.add_quad({corners[i], corners[j], inner[j], inner[i]}, region);
  }
}

/// Minus how bad some quads are together: straight corners first. The worst alone would not do: others around may be as bad.
double straightness(const Smoother& smoother, const std::vector<int>& quads) {
  constexpr double kStraight = 1e-3;
  constexpr double kGoodEnough = 0.1;  // a wedge's tip may be acute: any positive quality beats a straight corner
  double bad = 0;
  for (const int q : quads) {
    const double quality = smoother.signed_quality(q);
    bad += (quality < kStraight) + std::max(0.0, kGoodEnough - quality);
  }
  return -bad;
}

bool try_places(Workpiece& piece, Smoother& smoother, int v, int q) {
  constexpr double kGain = 1e-3, kWhatever = std::numeric_limits<double>::infinity();
  const Trial::Measure measure = [&smoother](const std::vector<int>& quads) { return straightness(smoother, quads); };
  std::array<Place, 2> places;
  int count = 0;
  for (const bool mirrored : {false, true})
    if (place_on(piece.mesh, v, q, mirrored, &places[count])) ++count;
  if (count == 2 && price(piece.mesh, places[1].y) < price(piece.mesh, places[0].y)) std::swap(places[0], places[1]);
  for (int i = 0; i < count; ++i) {
    const Place place = places[i];
    Trial trial(piece, smoother, {place.a, place.v, place.b, place.c, place.x, place.y}, measure);
    apply(piece, smoother, place);
    if (trial.keep(kWhatever, kGain)) return true;
  }
  constexpr double kFolded = 0.05;
  if (smoother.signed_quality(q) > kFolded || piece.mesh.is_locked(q)) return false;
  const EditMesh::Quad corners = piece.mesh.quad(q);
  Trial trial(piece, smoother, {corners.begin(), corners.end()}, measure);
  pillow(piece, smoother, q);
  return trial.keep(kWhatever, kGain);
}

}  // namespace

int open_straight_corners(Workpiece& piece, Smoother& smoother, const RunContext& context) {
  int opened = 0;
  const int n = piece.mesh.vertex_count();
  for (int v = 0; v < n; ++v) {
    if ((v & 1023) == 0) context.checkpoint();
    if (piece.mesh.is_free(v) || !has_straight_corner(piece.mesh, v)) continue;
    const std::vector<int> quads(piece.mesh.quads_at(v).begin(), piece.mesh.quads_at(v).end());
    for (const int q : quads) opened += is_straight_at(piece.mesh, v, q) && try_places(piece, smoother, v, q);
  }
  return opened;
}

}  // namespace hybrid_quad
