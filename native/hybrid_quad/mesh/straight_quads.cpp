#include "hybrid_quad/mesh/straight_quads.h"

#include <array>
#include <limits>

#include "hybrid_quad/mesh/polychords.h"

namespace hybrid_quad {

namespace {

/// Quads around the origin of dart d; none is too few on the border.
int quads_at(const QuadComplex& c, int d) {
  int count = 0, at = d;
  do {
    ++count;
    at = c.opposite[QuadComplex::previous(at)];
    if (at < 0) return std::numeric_limits<int>::max();
  } while (at != d);
  return count;
}

/// The free side of a quad with three straight feature sides, or -1.
int free_side(const QuadComplex& c, int q) {
  int side = -1;
  for (int d = 4 * q; d < 4 * q + 4; ++d) {
    if (c.curve[d] >= 0) continue;
    if (side >= 0) return -1;
    side = d;
  }
  if (side < 0 || c.opposite[side] < 0 || c.opposite[side] / 4 == q) return -1;
  // The vertices between the three feature sides are those that the free side does not touch.
  for (const int d : {QuadComplex::next(QuadComplex::next(side)), QuadComplex::previous(side)})
    if (c.kind[c.from(d)] != VertexKind::kCurve) return -1;
  // The ends of the free side lose a quad each.
  for (const int d : {side, QuadComplex::next(side)})
    if (quads_at(c, d) < 4) return -1;
  return side;
}

class QuadOpener {
 public:
  QuadOpener(QuadComplex& complex, int anchor) : c_(complex), anchor_(anchor) {}

  /// Quad a b c d with free side d-a and its neighbour a d e f become (a b x f), (b c y x), (c d e y), (x y e f).
  void open(int side) {
    const int ab = QuadComplex::next(side), bc = QuadComplex::next(ab), cd = QuadComplex::next(bc);
    const int ad = c_.opposite[side], de = QuadComplex::next(ad), ef = QuadComplex::next(de), fa = QuadComplex::next(ef);
    const int a = c_.from(ab), b = c_.from(bc), c = c_.from(cd), d = c_.from(de), e = c_.from(ef), f = c_.from(fa);
    const auto between = [&](int p, int q, int r, double t) {
      return Vector3(0.5 * (c_.positions[p] + (1 - t) * c_.positions[q] + t * c_.positions[r]));
    };
    const int x = add_vertex(between(b, f, e, 1.0 / 3)), y = add_vertex(between(c, f, e, 2.0 / 3));
    const int first = side / 4, last = ad / 4, second = c_.quad_count(), third = second + 1;
    const std::array<Side, 6> outer = {side_of(ab), side_of(bc), side_of(cd), side_of(de), side_of(ef), side_of(fa)};
    for (const int quad : {second, third}) {
      c_.opposite.resize(4 * quad + 4, -1);
      c_.vertex.resize(4 * quad + 4, -1);
      c_.curve.resize(4 * quad + 4, -1);
    }
    set_corners(first, {a, b, x, f});
    set_corners(second, {b, c, y, x});
    set_corners(third, {c, d, e, y});
    set_corners(last, {x, y, e, f});
    const std::array<int, 6> place = {4 * first, 4 * second, 4 * third, 4 * third + 1, 4 * last + 2, 4 * first + 3};
    const std::array<int, 6> old = {ab, bc, cd, de, ef, fa};
    for (int i = 0; i < 6; ++i) {
      int across = outer[i].opposite;
      for (int j = 0; j < 6; ++j)  // the hexagon may be glued to itself
        if (across == old[j]) across = place[j];
      set_side(place[i], across, outer[i].curve);
    }
    glue(4 * first + 1, 4 * second + 3);
    glue(4 * second + 1, 4 * third + 3);
    glue(4 * first + 2, 4 * last + 3);
    glue(4 * second + 2, 4 * last);
    glue(4 * third + 2, 4 * last + 1);
  }

 private:
  struct Side {
    int opposite, curve;
  };
  Side side_of(int d) const { return {c_.opposite[d], c_.curve[d]}; }

  int add_vertex(const Vector3& p) {
    c_.positions.push_back(p);
    c_.kind.push_back(VertexKind::kFree);
    c_.anchor.push_back(anchor_);
    c_.near_face.push_back(-1);
    return static_cast<int>(c_.positions.size()) - 1;
  }
  void set_corners(int quad, const std::array<int, 4>& v) {
    for (int i = 0; i < 4; ++i) c_.vertex[4 * quad + i] = v[i];
  }
  void set_side(int d, int across, int curve) {
    c_.opposite[d] = across;
    c_.curve[d] = curve;
    if (across >= 0) c_.opposite[across] = d;
  }
  void glue(int d, int e) {
    set_side(d, e, -1);
    c_.curve[e] = -1;
  }

  QuadComplex& c_;
  int anchor_;
};

}  // namespace

int open_straight_quads(QuadComplex& complex) {
  std::vector<int> region = quad_regions(complex);
  int opened = 0;
  for (int q = 0; q < complex.quad_count(); ++q) {
    const int side = free_side(complex, q);
    if (side < 0) continue;
    QuadOpener(complex, region[q]).open(side);
    region.resize(complex.quad_count(), region[q]);
    ++opened;
  }
  return opened;
}

}  // namespace hybrid_quad
