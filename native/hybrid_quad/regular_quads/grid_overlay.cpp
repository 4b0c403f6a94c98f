#include "hybrid_quad/regular_quads/grid_overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "hybrid_quad/mesh/bucket_sort.h"

namespace hybrid_quad {

namespace {

using Wide = __int128;

/// A point on an edge as an exact fraction of it, num / den in (0, 1).
struct EdgePoint {
  std::int64_t num, den;
  int vertex;
};

template <class Integer>
std::int64_t floor_quotient(Integer a, Integer b) {
  const Integer q = a / b;
  return static_cast<std::int64_t>(a % b != 0 && ((a < 0) != (b < 0)) ? q - 1 : q);
}

bool is_narrow(Wide x) { return x == static_cast<std::int64_t>(x); }

/// Nearly all are short enough for the processor's own division, which takes a fraction of the time.
std::int64_t floor_div(Wide a, Wide b) {
  if (is_narrow(a) && is_narrow(b)) return floor_quotient(static_cast<std::int64_t>(a), static_cast<std::int64_t>(b));
  return floor_quotient(a, b);
}

/// Place of a coordinate among the integer lines: 2 k on line k, 2 k + 1 strictly between lines k and k + 1.
std::int64_t ordinal(Wide numerator, Wide denominator) {
  const Wide unit = denominator * kGridUnit;
  const std::int64_t k = floor_div(numerator, unit);
  return 2 * k + (Wide(k) * unit == numerator ? 0 : 1);
}

/// Corner of a polygon while it is being cut.
struct Corner {
  int vertex;
  std::array<std::int64_t, 2> place;  ///< ordinals in u and v
  Vector2 uv;
  int halfedge;  ///< surface half-edge that the side to the next corner lies on, -1 inside the face
};
using Polygon = std::vector<Corner>;

/// Where an edge crosses an integer line, as a fraction of it.
struct Crossing {
  std::int64_t num, den;
};

class OverlayBuilder {
 public:
  OverlayBuilder(const WorkingSurface& surface, const SpanningParameterization& param, const CurveCoordinates& curves)
      : surface_(surface), mesh_(surface.mesh), param_(param), curves_(curves) {}

  GridOverlay build(const RunContext& context) {
    find_cuttable_faces();
    add_surface_vertices();
    edge_points_.resize(mesh_.halfedge_count());
    for (int h = 0; h < mesh_.halfedge_count(); ++h)
      if (mesh_.opposite(h) < h) add_edge_points(h);
    out_.piece_begin.push_back(0);
    for (int f = 0; f < mesh_.face_count(); ++f) {
      if (f % 4096 == 0) context.checkpoint(0.7 * f / mesh_.face_count());
      cut_face(f);
    }
    pair_halfedges();
    share_isolines();
    return std::move(out_);
  }

 private:
  /// A face is cut where its chart can be trusted: regular, next to no remade curve, and of bounded extent.
  void find_cuttable_faces() {
    constexpr std::int64_t kLargest = 256 * kGridUnit;
    cuttable_.assign(mesh_.face_count(), 0);
    for (int f = 0; f < mesh_.face_count(); ++f) {
      bool ok = param_.is_regular[f] != 0;
      for (int i = 0; i < 3; ++i) {
        const GridVector& d = param_.halfedge_uv[3 * f + i];
        ok = ok && !curves_.is_altered[3 * f + i] && std::llabs(d[0]) < kLargest && std::llabs(d[1]) < kLargest;
      }
      cuttable_[f] = ok;
    }
  }

  void add_surface_vertices() {
    out_.vertices.resize(mesh_.vertex_count());
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      out_.vertices[v].position = mesh_.position(v);
      out_.vertices[v].surface_vertex = v;
    }
    for (int h = 0; h < mesh_.halfedge_count(); ++h) {
      const GridVector& uv = param_.corner_uv[h];
      if (uv[0] % kGridUnit == 0 && uv[1] % kGridUnit == 0)
        out_.vertices[mesh_.from(h)].grid_sign = ((uv[0] + uv[1]) / kGridUnit) & 1 ? -1 : 1;
    }
    // On curves the curve's own coordinate decides, which may have been made anew.
    for (std::size_t c = 0; c < curves_.curves.size(); ++c) {
      const auto& vertices = surface_.features.curves[c].vertices;
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        const std::int64_t s = curves_.curves[c].position[i];
        const bool node = s % kGridUnit == 0;
        out_.vertices[vertices[i]].grid_sign = node ? curve_sign(static_cast<int>(c), s / kGridUnit) : 0;
      }
    }
  }

  std::int8_t curve_sign(int c, std::int64_t k) const { return (k + curves_.curves[c].parity) & 1 ? -1 : 1; }

  Vector3 point_on(int h, double t) const { return mesh_.position(mesh_.from(h)) * (1 - t) + mesh_.position(mesh_.to(h)) * t; }

  int add_vertex(const Vector3& p, std::int8_t sign) {
    out_.vertices.push_back({p, -1, sign});
    return static_cast<int>(out_.vertices.size()) - 1;
  }

  /// Points where the edge of h crosses integer lines, kept on h in its direction (its opposite reads them backwards).
  void add_edge_points(int h) {
    std::vector<EdgePoint>& points = edge_points_[h];
    const int c = surface_.features.halfedge_curve[h];
    if (c >= 0) {
      add_curve_points(h, c, points);
      return;
    }
    const int o = mesh_.opposite(h);
    const bool own = cuttable_[h / 3] != 0;
    if (!own && (o < 0 || !cuttable_[o / 3])) return;
    const int side = own ? h : o;
    const GridVector& start = param_.corner_uv[side];
    const GridVector& d = param_.halfedge_uv[side];
    std::vector<Crossing>& crossings = crossings_;
    crossings.clear();
    for (int axis = 0; axis < 2; ++axis) {
      if (d[axis] == 0) continue;
      const std::int64_t a = start[axis], b = a + d[axis];
      const std::int64_t low = std::min(a, b), high = std::max(a, b);
      for (std::int64_t k = floor_div(low, kGridUnit) + 1; k * kGridUnit < high; ++k)
        crossings.push_back({std::llabs(k * kGridUnit - a), std::llabs(d[axis])});
    }
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& x, const Crossing& y) { return Wide(x.num) * y.den < Wide(y.num) * x.den; });
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      const Crossing& x = crossings[i];
      if (i > 0 && Wide(x.num) * crossings[i - 1].den == Wide(crossings[i - 1].num) * x.den) continue;
      // A grid point lies on a line of each family; an edge along a line of one meets it at the lines of the other.
      const std::int64_t u = ordinal(Wide(start[0]) * x.den + Wide(d[0]) * x.num, x.den);
      const std::int64_t v = ordinal(Wide(start[1]) * x.den + Wide(d[1]) * x.num, x.den);
      std::int8_t sign = 0;
      if (u % 2 == 0 && v % 2 == 0) sign = (u + v) / 2 % 2 != 0 ? -1 : 1;
      const double t = static_cast<double>(x.num) / static_cast<double>(x.den);
      const int vertex = add_vertex(point_on(side, t), sign);
      points.push_back(own ? EdgePoint{x.num, x.den, vertex} : EdgePoint{x.den - x.num, x.den, vertex});
    }
    if (!own) std::reverse(points.begin(), points.end());
  }

  void add_curve_points(int h, int c, std::vector<EdgePoint>& points) {
    const int i = curves_.halfedge_index[h];
    const auto& curve = curves_.curves[c];
    const std::int64_t a = curve.position[i], b = curve.position[i + 1];
    for (std::int64_t k = floor_div(a, kGridUnit) + 1; k * kGridUnit < b; ++k)
      points.push_back({k * kGridUnit - a, b - a, 0});
    const bool along = mesh_.from(h) == surface_.features.curves[c].vertices[i];
    for (EdgePoint& p : points) {
      const std::int64_t k = (a + p.num) / kGridUnit;
      if (!along) p.num = p.den - p.num;
      p.vertex = add_vertex(point_on(h, static_cast<double>(p.num) / static_cast<double>(p.den)), curve_sign(c, k));
    }
    if (!along) std::reverse(points.begin(), points.end());
  }

  /// The face's border with all cut points, counterclockwise.
  Polygon border_of(int f) const {
    Polygon polygon;
    for (int i = 0; i < 3; ++i) {
      const int h = 3 * f + i, o = mesh_.opposite(h);
      const GridVector& a = param_.corner_uv[h];
      const GridVector& d = param_.halfedge_uv[h];
      const auto add = [&](std::int64_t num, std::int64_t den, int vertex) {
        const double t = static_cast<double>(num) / static_cast<double>(den);
        Corner corner{vertex, {0, 0}, {}, h};
        for (int axis = 0; axis < 2; ++axis) {
          corner.place[axis] = ordinal(Wide(a[axis]) * den + Wide(d[axis]) * num, den);
          corner.uv[axis] = (static_cast<double>(a[axis]) + t * static_cast<double>(d[axis])) / kGridUnit;
        }
        polygon.push_back(corner);
      };
      add(0, 1, mesh_.from(h));
      if (o < h)
        for (const EdgePoint& p : edge_points_[h]) add(p.num, p.den, p.vertex);
      else
        for (auto p = edge_points_[o].rbegin(); p != edge_points_[o].rend(); ++p) add(p->den - p->num, p->den, p->vertex);
    }
    return polygon;
  }

  void cut_face(int f) {
    Polygon polygon = border_of(f);
    if (!cuttable_[f]) {
      emit(polygon, f, false);
      return;
    }
    std::vector<Polygon> strips = split(std::move(polygon), 0);
    // Grid points on the chords between strips, made once for the two strips that share them.
    chord_points_.clear();
    for (Polygon& strip : strips) insert_chord_points(strip, f);
    for (Polygon& strip : strips)
      for (const Polygon& piece : split(std::move(strip), 1)) emit(piece, f, true);
  }

  /// Cuts a convex polygon along the lines place[axis] = 2 k that pass through its inside.
  static std::vector<Polygon> split(Polygon rest, int axis) {
    std::vector<Polygon> pieces;
    const auto by_place = [axis](const Corner& x, const Corner& y) { return x.place[axis] < y.place[axis]; };
    const auto [low, high] = std::minmax_element(rest.begin(), rest.end(), by_place);
    const std::int64_t begin = floor_div(low->place[axis], 2) + 1, end = high->place[axis];
    for (std::int64_t k = begin; 2 * k < end; ++k) {
      int first = -1, second = -1;
      const int n = static_cast<int>(rest.size());
      for (int i = 0; i < n; ++i) {
        if (rest[i].place[axis] != 2 * k) continue;
        if (first < 0)
          first = i;
        else
          second = i;
      }
      if (second < 0) throw InternalError("regular quads", "an integer line enters a face without leaving it");
      // The two parts share the chord first-second; which one lies below the line is told by any corner of it.
      Polygon inner(rest.begin() + first, rest.begin() + second + 1), outer;
      outer.insert(outer.end(), rest.begin() + second, rest.end());
      outer.insert(outer.end(), rest.begin(), rest.begin() + first + 1);
      inner.back().halfedge = -1;
      outer.back().halfedge = -1;
      const bool inner_is_below = inner[1].place[axis] < 2 * k;
      pieces.push_back(inner_is_below ? std::move(inner) : std::move(outer));
      rest = inner_is_below ? std::move(outer) : std::move(inner);
    }
    pieces.push_back(std::move(rest));
    return pieces;
  }

  void insert_chord_points(Polygon& strip, int f) {
    Polygon out;
    const int n = static_cast<int>(strip.size());
    for (int i = 0; i < n; ++i) {
      const Corner& a = strip[i];
      const Corner& b = strip[(i + 1) % n];
      out.push_back(a);
      if (a.halfedge >= 0) continue;
      const std::int64_t u = a.place[0] / 2;
      const bool up = a.place[1] < b.place[1];
      const std::int64_t low = floor_div(std::min(a.place[1], b.place[1]), 2) + 1;
      const std::int64_t high = std::max(a.place[1], b.place[1]);
      std::vector<std::int64_t> lines;
      for (std::int64_t v = low; 2 * v < high; ++v) lines.push_back(v);
      if (!up) std::reverse(lines.begin(), lines.end());
      for (const std::int64_t v : lines)
        out.push_back({chord_vertex(f, u, v), {2 * u, 2 * v}, Vector2(static_cast<double>(u), static_cast<double>(v)), -1});
    }
    strip = std::move(out);
  }

  int chord_vertex(int f, std::int64_t u, std::int64_t v) {
    for (const auto& [cu, cv, vertex] : chord_points_)
      if (cu == u && cv == v) return vertex;
    const GridVector& a = param_.corner_uv[3 * f];
    const GridVector& ab = param_.halfedge_uv[3 * f];
    const GridVector& ca = param_.halfedge_uv[3 * f + 2];
    const double x = static_cast<double>(u * kGridUnit - a[0]), y = static_cast<double>(v * kGridUnit - a[1]);
    const double bx = static_cast<double>(ab[0]), by = static_cast<double>(ab[1]);
    const double cx = -static_cast<double>(ca[0]), cy = -static_cast<double>(ca[1]);
    const double det = bx * cy - by * cx;
    const double s = (x * cy - y * cx) / det, t = (bx * y - by * x) / det;
    const auto& face = mesh_.face(f);
    const Vector3 p = mesh_.position(face[0]) * (1 - s - t) + mesh_.position(face[1]) * s + mesh_.position(face[2]) * t;
    const int vertex = add_vertex(p, (u + v) & 1 ? -1 : 1);
    chord_points_.emplace_back(u, v, vertex);
    return vertex;
  }

  void emit(const Polygon& polygon, int f, bool regular) {
    const int piece = out_.piece_count();
    const int n = static_cast<int>(polygon.size());
    for (int i = 0; i < n; ++i) {
      const Corner& a = polygon[i];
      const Corner& b = polygon[(i + 1) % n];
      const int c = a.halfedge < 0 ? -1 : surface_.features.halfedge_curve[a.halfedge];
      bool isoline = c >= 0;
      if (regular)
        for (int axis = 0; axis < 2; ++axis) isoline |= a.place[axis] == b.place[axis] && a.place[axis] % 2 == 0;
      out_.origin.push_back(a.vertex);
      out_.piece_of.push_back(piece);
      out_.on_isoline.push_back(isoline);
      out_.curve.push_back(c);
      out_.uv.push_back(a.uv);
      out_.surface_halfedge.push_back(a.halfedge);
    }
    out_.piece_begin.push_back(static_cast<int>(out_.origin.size()));
    out_.piece_face.push_back(f);
    out_.piece_regular.push_back(regular);
  }

  /// Two segments with the same ends are the same segment: straight pieces of a simplicial surface.
  void pair_halfedges() {
    struct Entry {
      int low, high, halfedge;
    };
    const int n = static_cast<int>(out_.origin.size());
    std::vector<Entry> entries(n);
    for (int k = 0; k < n; ++k) {
      const int a = out_.origin[k], b = out_.target(k);
      entries[k] = {std::min(a, b), std::max(a, b), k};
    }
    bucket_sort(entries, [](const Entry& x) { return x.low; }, [](const Entry& x, const Entry& y) {
      return std::tie(x.high, x.halfedge) < std::tie(y.high, y.halfedge);
    });
    out_.opposite.assign(n, -1);
    for (int i = 0; i < n;) {
      int j = i + 1;
      while (j < n && entries[j].low == entries[i].low && entries[j].high == entries[i].high) ++j;
      if (j - i > 2) throw InternalError("regular quads", "pieces of the grid overlay do not fit together");
      if (j - i == 2) {
        const int x = entries[i].halfedge, y = entries[i + 1].halfedge;
        if (out_.origin[x] == out_.origin[y]) throw InternalError("regular quads", "pieces of the grid overlay overlap");
        out_.opposite[x] = y;
        out_.opposite[y] = x;
      } else if (out_.surface_halfedge[entries[i].halfedge] < 0 || mesh_.opposite(out_.surface_halfedge[entries[i].halfedge]) >= 0) {
        throw InternalError("regular quads", "the grid overlay has a gap");
      }
      i = j;
    }
  }

  /// A face that was not cut learns from its neighbour which of its sides are integer lines.
  void share_isolines() {
    for (std::size_t k = 0; k < out_.opposite.size(); ++k) {
      const int o = out_.opposite[k];
      if (o >= 0 && out_.on_isoline[k] && !out_.piece_regular[out_.piece_of[o]]) out_.on_isoline[o] = 1;
    }
  }

  const WorkingSurface& surface_;
  const TriangleMesh& mesh_;
  const SpanningParameterization& param_;
  const CurveCoordinates& curves_;
  GridOverlay out_;
  std::vector<char> cuttable_;
  std::vector<std::vector<EdgePoint>> edge_points_;
  std::vector<Crossing> crossings_;  ///< of one edge
  std::vector<std::tuple<std::int64_t, std::int64_t, int>> chord_points_;
};

}  // namespace

GridOverlay build_grid_overlay(const WorkingSurface& surface, const SpanningParameterization& param,
                               const CurveCoordinates& curves, const RunContext& context) {
  return OverlayBuilder(surface, param, curves).build(context);
}

}  // namespace hybrid_quad
