#include "hybrid_quad/regular_quads/grid_overlay.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>
#include <utility>

#include "hybrid_quad/base/parallel.h"

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

/// Points of edges that are handled one after the other; each has a vertex, whose number in the part is `vertex`.
struct EdgePart {
  std::vector<EdgePoint> points;
  std::vector<GridOverlay::Vertex> vertices;
  std::vector<Crossing> crossings;  ///< of one edge

  void add(std::int64_t num, std::int64_t den, const Vector3& p, std::int8_t sign) {
    points.push_back({num, den, static_cast<int>(vertices.size())});
    vertices.push_back({p, -1, sign});
  }
};

/// A grid point inside a face, on a chord between strips.
struct ChordPoint {
  std::int64_t u, v;
  int vertex;
};

/// A half-edge, listed with the lower end of its segment.
struct Segment {
  int high, halfedge;
};

/// What becomes of faces that are cut one after the other.
struct FacePart {
  struct Side {
    int origin, halfedge, curve;
    bool on_isoline;
    Vector2 uv;
  };
  struct Piece {
    int face, end;  ///< end: of its sides
    bool regular;
  };
  std::vector<GridOverlay::Vertex> vertices;  ///< inside of faces; their numbers are counted on from the points on edges
  std::vector<Side> sides;
  std::vector<Piece> pieces;

  // Of one face; they keep their memory.
  Polygon border, with_points;
  std::array<Polygon, 2> inner, outer;  ///< by axis
  std::vector<ChordPoint> chord_points;
};

/// Calls work(i, part) for every i of [0, count), in order within a part; the parts, in order too, are made side by side.
template <class Part, class Work>
std::vector<Part> make_parts(int count, const RunContext& context, const Work& work) {
  constexpr int kChunk = 512;
  std::vector<Part> parts((count + kChunk - 1) / kChunk);
  const auto make = [&](int begin, int end) {
    for (int i = begin; i < end; ++i) work(i, parts[begin / kChunk]);
  };
  parallel_chunks(count, context, make, kChunk);
  return parts;
}

class OverlayBuilder {
 public:
  OverlayBuilder(const WorkingSurface& surface, const SpanningParameterization& param, const CurveCoordinates& curves)
      : surface_(surface), mesh_(surface.mesh), param_(param), curves_(curves) {}

  GridOverlay build(const RunContext& context) {
    find_cuttable_faces();
    add_surface_vertices();
    add_edge_points(context);
    context.checkpoint(0.2);
    cut_faces(context);
    context.checkpoint(0.7);
    pair_halfedges(context);
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

  /// Points where edges cross integer lines, kept on that half-edge of each that comes last, in its direction; its opposite
  /// reads them backwards.
  void add_edge_points(const RunContext& context) {
    const int n = mesh_.halfedge_count();
    points_begin_.assign(n + 1, 0);
    const auto parts = make_parts<EdgePart>(n, context, [&](int h, EdgePart& part) {
      const std::size_t before = part.points.size();
      if (mesh_.opposite(h) < h) add_points_of(h, part);
      points_begin_[h + 1] = static_cast<int>(part.points.size() - before);
    });
    for (int h = 0; h < n; ++h) points_begin_[h + 1] += points_begin_[h];
    edge_points_.reserve(points_begin_[n]);
    out_.vertices.reserve(out_.vertices.size() + points_begin_[n]);
    for (const EdgePart& part : parts) {
      const int before = static_cast<int>(out_.vertices.size());
      for (const EdgePoint& p : part.points) edge_points_.push_back({p.num, p.den, p.vertex + before});
      out_.vertices.insert(out_.vertices.end(), part.vertices.begin(), part.vertices.end());
    }
  }

  void add_points_of(int h, EdgePart& part) const {
    const int c = surface_.features.halfedge_curve[h];
    if (c >= 0) {
      add_curve_points(h, c, part);
      return;
    }
    const int o = mesh_.opposite(h);
    const bool own = cuttable_[h / 3] != 0;
    if (!own && (o < 0 || !cuttable_[o / 3])) return;
    const int side = own ? h : o;
    const GridVector& start = param_.corner_uv[side];
    const GridVector& d = param_.halfedge_uv[side];
    std::vector<Crossing>& crossings = part.crossings;
    crossings.clear();
    const auto before = static_cast<std::ptrdiff_t>(part.points.size());
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
      part.add(own ? x.num : x.den - x.num, x.den, point_on(side, t), sign);
    }
    if (!own) std::reverse(part.points.begin() + before, part.points.end());
  }

  void add_curve_points(int h, int c, EdgePart& part) const {
    const int i = curves_.halfedge_index[h];
    const auto& curve = curves_.curves[c];
    const std::int64_t a = curve.position[i], b = curve.position[i + 1];
    const bool along = mesh_.from(h) == surface_.features.curves[c].vertices[i];
    const auto before = static_cast<std::ptrdiff_t>(part.points.size());
    for (std::int64_t k = floor_div(a, kGridUnit) + 1; k * kGridUnit < b; ++k) {
      const std::int64_t num = along ? k * kGridUnit - a : b - k * kGridUnit;
      part.add(num, b - a, point_on(h, static_cast<double>(num) / static_cast<double>(b - a)), curve_sign(c, k));
    }
    if (!along) std::reverse(part.points.begin() + before, part.points.end());
  }

  /// \param polygon  becomes the face's border with all cut points, counterclockwise
  void find_border(int f, Polygon& polygon) const {
    polygon.clear();
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
      const auto begin = edge_points_.begin();
      if (o < h)
        std::for_each(begin + points_begin_[h], begin + points_begin_[h + 1],
                      [&](const EdgePoint& p) { add(p.num, p.den, p.vertex); });
      else
        for (int k = points_begin_[o + 1]; k-- > points_begin_[o];) {
          const EdgePoint& p = edge_points_[k];
          add(p.den - p.num, p.den, p.vertex);
        }
    }
  }

  void cut_faces(const RunContext& context) {
    const int edge_vertices = static_cast<int>(out_.vertices.size());
    const auto parts = make_parts<FacePart>(mesh_.face_count(), context, [&](int f, FacePart& part) { cut_face(f, part); });
    const int count = static_cast<int>(parts.size());
    std::vector<int> vertices(count + 1, edge_vertices), sides(count + 1, 0), pieces(count + 1, 0);  // where each part's go
    for (int p = 0; p < count; ++p) {
      vertices[p + 1] = vertices[p] + static_cast<int>(parts[p].vertices.size());
      sides[p + 1] = sides[p] + static_cast<int>(parts[p].sides.size());
      pieces[p + 1] = pieces[p] + static_cast<int>(parts[p].pieces.size());
    }
    out_.vertices.resize(vertices[count]);
    resize_pieces(pieces[count], sides[count]);
    parallel_for(count, context.threads, [&](int p) {
      std::copy(parts[p].vertices.begin(), parts[p].vertices.end(), out_.vertices.begin() + vertices[p]);
      put_pieces(parts[p], pieces[p], sides[p]);
      for (int k = sides[p]; k < sides[p + 1]; ++k)
        if (out_.origin[k] >= edge_vertices) out_.origin[k] += vertices[p] - edge_vertices;
    });
  }

  void resize_pieces(int pieces, int sides) {
    out_.piece_begin.assign(pieces + 1, 0);
    out_.piece_face.resize(pieces);
    out_.piece_regular.resize(pieces);
    out_.origin.resize(sides);
    out_.piece_of.resize(sides);
    out_.on_isoline.resize(sides);
    out_.curve.resize(sides);
    out_.uv.resize(sides);
    out_.surface_halfedge.resize(sides);
  }

  void put_pieces(const FacePart& part, int piece, int side) {
    int k = 0;
    for (const FacePart::Piece& p : part.pieces) {
      out_.piece_begin[piece + 1] = side + p.end;
      out_.piece_face[piece] = p.face;
      out_.piece_regular[piece] = p.regular;
      for (; k < p.end; ++k) {
        const FacePart::Side& s = part.sides[k];
        out_.origin[side + k] = s.origin;
        out_.piece_of[side + k] = piece;
        out_.on_isoline[side + k] = s.on_isoline;
        out_.curve[side + k] = s.curve;
        out_.uv[side + k] = s.uv;
        out_.surface_halfedge[side + k] = s.halfedge;
      }
      ++piece;
    }
  }

  void cut_face(int f, FacePart& part) const {
    find_border(f, part.border);
    if (!cuttable_[f]) {
      emit(part.border, f, false, part);
      return;
    }
    // Grid points on the chords between strips, made once for the two strips that share them.
    part.chord_points.clear();
    split(part.border, 0, part, [&](Polygon& strip) {
      insert_chord_points(strip, f, part);
      split(strip, 1, part, [&](const Polygon& piece) { emit(piece, f, true, part); });
    });
  }

  /// Cuts a convex polygon along the lines place[axis] = 2 k that pass through its inside. Uses the pieces in ascending order.
  template <class Use>
  static void split(Polygon& rest, int axis, FacePart& part, const Use& use) {
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
      Polygon &inner = part.inner[axis], &outer = part.outer[axis];
      inner.assign(rest.begin() + first, rest.begin() + second + 1);
      outer.assign(rest.begin() + second, rest.end());
      outer.insert(outer.end(), rest.begin(), rest.begin() + first + 1);
      inner.back().halfedge = -1;
      outer.back().halfedge = -1;
      const bool inner_is_below = inner[1].place[axis] < 2 * k;
      rest.swap(inner_is_below ? outer : inner);
      use(inner_is_below ? inner : outer);
    }
    use(rest);
  }

  void insert_chord_points(Polygon& strip, int f, FacePart& part) const {
    if (std::all_of(strip.begin(), strip.end(), [](const Corner& c) { return c.halfedge >= 0; })) return;
    Polygon& out = part.with_points;
    out.clear();
    const int n = static_cast<int>(strip.size());
    for (int i = 0; i < n; ++i) {
      const Corner& a = strip[i];
      const Corner& b = strip[(i + 1) % n];
      out.push_back(a);
      if (a.halfedge >= 0) continue;
      const std::int64_t u = a.place[0] / 2;
      const bool up = a.place[1] < b.place[1];
      const std::int64_t low = floor_div(std::min(a.place[1], b.place[1]), 2) + 1;
      const std::int64_t last = floor_div(std::max(a.place[1], b.place[1]) + 1, 2) - 1;
      for (std::int64_t k = low; k <= last; ++k) {
        const std::int64_t v = up ? k : low + last - k;
        out.push_back({chord_vertex(f, u, v, part), {2 * u, 2 * v}, Vector2(static_cast<double>(u), static_cast<double>(v)), -1});
      }
    }
    strip.swap(out);
  }

  int chord_vertex(int f, std::int64_t u, std::int64_t v, FacePart& part) const {
    for (const ChordPoint& p : part.chord_points)
      if (p.u == u && p.v == v) return p.vertex;
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
    const int vertex = static_cast<int>(out_.vertices.size() + part.vertices.size());
    part.vertices.push_back({p, -1, static_cast<std::int8_t>((u + v) & 1 ? -1 : 1)});
    part.chord_points.push_back({u, v, vertex});
    return vertex;
  }

  void emit(const Polygon& polygon, int f, bool regular, FacePart& part) const {
    const int n = static_cast<int>(polygon.size());
    for (int i = 0; i < n; ++i) {
      const Corner& a = polygon[i];
      const Corner& b = polygon[i + 1 < n ? i + 1 : 0];
      const int c = a.halfedge < 0 ? -1 : surface_.features.halfedge_curve[a.halfedge];
      bool isoline = c >= 0;
      if (regular)
        for (int axis = 0; axis < 2; ++axis) isoline |= a.place[axis] == b.place[axis] && a.place[axis] % 2 == 0;
      part.sides.push_back({a.vertex, a.halfedge, c, isoline, a.uv});
    }
    part.pieces.push_back({f, static_cast<int>(part.sides.size()), regular});
  }

  /// Two segments with the same ends are the same segment: straight pieces of a simplicial surface.
  void pair_halfedges(const RunContext& context) {
    const int n = static_cast<int>(out_.origin.size()), vertices = static_cast<int>(out_.vertices.size());
    std::vector<std::array<int, 2>> ends(n);  // the lower first
    const auto find_ends = [&](int begin, int end) {
      for (int k = begin; k < end; ++k) {
        const int a = out_.origin[k], b = out_.target(k);
        ends[k] = {std::min(a, b), std::max(a, b)};
      }
    };
    parallel_chunks(n, context, find_ends, 4096);
    std::vector<int> list_end(vertices + 1, 0);  // of each lower end's segments, once they are listed
    for (const auto& e : ends) ++list_end[e[0] + 1];
    for (int v = 0; v < vertices; ++v) list_end[v + 1] += list_end[v];
    std::vector<Segment> segments(n);
    for (int k = 0; k < n; ++k) segments[list_end[ends[k][0]]++] = {ends[k][1], k};
    out_.opposite.assign(n, -1);
    const auto pair = [&](int begin, int end) {
      for (int v = begin; v < end; ++v)
        pair_segments(segments.data() + (v > 0 ? list_end[v - 1] : 0), segments.data() + list_end[v]);
    };
    parallel_chunks(vertices, context, pair, 1024);
  }

  /// \param begin, end  those with one lower end
  void pair_segments(Segment* begin, Segment* end) {
    std::sort(begin, end,
              [](const Segment& x, const Segment& y) { return std::tie(x.high, x.halfedge) < std::tie(y.high, y.halfedge); });
    while (begin < end) {
      Segment* const next = std::find_if(begin, end, [begin](const Segment& s) { return s.high != begin->high; });
      if (next - begin > 2) throw InternalError("regular quads", "pieces of the grid overlay do not fit together");
      const int x = begin[0].halfedge;
      if (next - begin == 2) {
        const int y = begin[1].halfedge;
        if (out_.origin[x] == out_.origin[y]) throw InternalError("regular quads", "pieces of the grid overlay overlap");
        out_.opposite[x] = y;
        out_.opposite[y] = x;
      } else if (out_.surface_halfedge[x] < 0 || mesh_.opposite(out_.surface_halfedge[x]) >= 0) {
        throw InternalError("regular quads", "the grid overlay has a gap");
      }
      begin = next;
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
  std::vector<int> points_begin_;  ///< #half-edges + 1: first of its points
  std::vector<EdgePoint> edge_points_;
};

}  // namespace

GridOverlay build_grid_overlay(const WorkingSurface& surface, const SpanningParameterization& param,
                               const CurveCoordinates& curves, const RunContext& context) {
  return OverlayBuilder(surface, param, curves).build(context);
}

}  // namespace hybrid_quad
