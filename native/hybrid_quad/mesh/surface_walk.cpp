#include "hybrid_quad/mesh/surface_walk.h"

#include <algorithm>

namespace hybrid_quad {

namespace {

/// Where the nearest point of a triangle lies: inside, on side i (corners i, i + 1) or at corner i.
enum Place : int { kInside = -1, kSide0 = 0, kCorner0 = 3 };

/// Of a side or a triangle: a point that near to an end or a side lies there. A rotation must not move it off.
constexpr double kOnBorder = 1e-9;

Vector3 along(const Vector3& a, const Vector3& ab, double part, double whole) { return whole > 0 ? Vector3(a + ab * (part / whole)) : a; }

/// The place of a point of side i, that far from its begin. \param begin, end  its corners
int place_on_side(int side, int begin, int end, double part, double whole) {
  if (!(part > kOnBorder * whole)) return kCorner0 + begin;
  return part < (1 - kOnBorder) * whole ? kSide0 + side : kCorner0 + end;
}

/// The place of a point inside, of weights that sum up to `sum`.
int place_inside(const double (&weight)[3], double sum) {
  int place = kInside, count = 0, corner = 0;
  for (int i = 0; i < 3; ++i) {
    if (weight[i] > kOnBorder * sum) corner = i;
    else place = kSide0 + (i + 1) % 3, ++count;
  }
  return count < 2 ? place : kCorner0 + corner;
}

/// Voronoi regions of the triangle's corners and sides in turn (Ericson, Real-Time Collision Detection, 5.1.5).
Vector3 nearest_with_place(const Vector3& p, const Vector3& a, const Vector3& b, const Vector3& c, int* place) {
  const Vector3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) {
    *place = kCorner0;
    return a;
  }
  const Vector3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) {
    *place = kCorner0 + 1;
    return b;
  }
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    *place = place_on_side(0, 0, 1, d1, d1 - d3);
    return along(a, ab, d1, d1 - d3);
  }
  const Vector3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) {
    *place = kCorner0 + 2;
    return c;
  }
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    *place = place_on_side(2, 0, 2, d2, d2 - d6);
    return along(a, ac, d2, d2 - d6);
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    *place = place_on_side(1, 1, 2, d4 - d3, (d4 - d3) + (d5 - d6));
    return along(b, c - b, d4 - d3, (d4 - d3) + (d5 - d6));
  }
  const double sum = va + vb + vc;
  *place = kInside;
  if (!(sum > 0)) return nearest_on_triangle(p, a, b, c);
  *place = place_inside({va, vb, vc}, sum);
  return a + ab * (vb / sum) + ac * (vc / sum);
}

/// The first of the faces of a region that have a side or a corner of face f in common: of all that are as near, so that
/// rounding does not choose.
int first_face_at(const TriangleMesh& mesh, const std::vector<int>& region, int f, int place) {
  int first = f;
  const auto consider = [&](int h) {
    if (h >= 0 && (region.empty() || region[h / 3] == region[f])) first = std::min(first, h / 3);
  };
  if (place < kCorner0) {
    if (place != kInside) consider(mesh.opposite(3 * f + place));
    return first;
  }
  const int start = mesh.outgoing(mesh.from(3 * f + place - kCorner0));
  for (int h = start; h >= 0;) {
    consider(h);
    h = mesh.rotate_ccw(h);
    if (h == start) break;
  }
  return first;
}

}  // namespace

SurfacePoint walk_to_nearest(const TriangleMesh& mesh, const std::vector<int>& region, const Vector3& p, int start) {
  constexpr int kMostFan = 64, kMostSteps = 1000;
  int place = kInside;
  const auto project = [&](int f, int* where) {
    const auto& t = mesh.face(f);
    SurfacePoint point;
    point.face = f;
    point.position = nearest_with_place(p, mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2]), where);
    point.squared_distance = (point.position - p).squaredNorm();
    return point;
  };
  SurfacePoint best = project(start, &place);
  const auto try_face = [&](int h) {
    if (h < 0) return false;
    const int f = TriangleMesh::face_of(h);
    if (!region.empty() && region[f] != region[start]) return false;
    int where;
    const SurfacePoint point = project(f, &where);
    if (!(with_rounding(point.squared_distance, p) < best.squared_distance)) return false;
    best = point;
    place = where;
    return true;
  };
  // Every step is strictly nearer, so no face comes twice.
  bool moved = true;
  for (int taken = 0; moved && place != kInside && taken < kMostSteps; ++taken) {
    moved = false;
    const int f = best.face;
    if (place < kCorner0) {
      moved = try_face(mesh.opposite(3 * f + place));
      continue;
    }
    // At a corner both sides lead on; where neither does, the faces between them may.
    const int out = 3 * f + (place - kCorner0);
    moved = try_face(mesh.opposite(out)) || try_face(mesh.rotate_ccw(out));
    int h = moved ? -1 : mesh.rotate_ccw(out);
    for (int step = 0; step < kMostFan && h >= 0 && h != out && !moved; ++step) {
      moved = try_face(h);
      h = mesh.rotate_ccw(h);
    }
  }
  best.face = first_face_at(mesh, region, best.face, place);
  return best;
}

}  // namespace hybrid_quad
