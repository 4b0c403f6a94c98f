#include "hybrid_quad/improve/place_search.h"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

namespace hybrid_quad {

namespace {

/// How bad some quads are: the number of flawed ones counts before all shapes together.
struct Badness {
  int flawed = 0;
  double shapes = 0;  ///< what scaled Jacobians lack to FlawMeasure::kFair, summed

  bool is_less_than(const Badness& other, double least) const {
    return flawed != other.flawed ? flawed < other.flawed : shapes < other.shapes - least;
  }
};

class PlaceSearch {
 public:
  PlaceSearch(Workpiece& piece, const FlawMeasure& measure, int q) : piece_(piece), measure_(measure) {
    const EditMesh::Quad& corners = piece.mesh.quad(q);
    core_ = movable({corners.begin(), corners.end()});
    around_ = movable(with_ring({corners.begin(), corners.end()}));
    quads_ = quads_at(around_);
  }

  bool run() {
    constexpr double kBetter = 0.05;
    const Badness before = badness(quads_);
    const std::vector<VertexPlace> old = places(around_);
    for (const std::vector<int>* vertices : {&core_, &around_}) {
      search(*vertices);
      if (badness(quads_).is_less_than(before, kBetter)) return true;
    }
    for (std::size_t i = 0; i < around_.size(); ++i) piece_.put(around_[i], old[i]);
    return false;
  }

  const std::vector<int>& quads() const { return quads_; }

 private:
  void search(const std::vector<int>& vertices) {
    constexpr int kSweeps = 4;
    bool moved = true;
    for (int sweep = 0; sweep < kSweeps && moved; ++sweep) {
      moved = false;
      for (const int v : vertices) moved |= move(v, sweep == 0);
    }
  }

  std::vector<int> movable(const std::vector<int>& vertices) const {
    std::vector<int> out;
    for (const int v : vertices)
      if (piece_.may_move(v)) out.push_back(v);
    return out;
  }

  /// What lies around a hub, where hundreds of quads may meet, hardly helps a quad on one side of it.
  std::vector<int> with_ring(const std::vector<int>& vertices) const {
    constexpr int kHub = 16;  // quads
    std::set<int> ring(vertices.begin(), vertices.end());
    for (const int v : vertices) {
      if (piece_.mesh.valence(v) > kHub) continue;
      for (const int q : piece_.mesh.quads_at(v)) ring.insert(piece_.mesh.quad(q).begin(), piece_.mesh.quad(q).end());
    }
    return {ring.begin(), ring.end()};
  }

  std::vector<int> quads_at(const std::vector<int>& vertices) const {
    std::set<int> quads;
    for (const int v : vertices) quads.insert(piece_.mesh.quads_at(v).begin(), piece_.mesh.quads_at(v).end());
    return {quads.begin(), quads.end()};
  }

  Badness badness(const std::vector<int>& quads) const {
    Badness sum;
    for (const int q : quads) {
      sum.flawed += measure_.is_flawed(q);
      sum.shapes += measure_.lacks_shape(q);
    }
    return sum;
  }

  /// Whether the quads are now less bad than `bound`, which then is what they are. Shapes are looked at first: they cost
  /// little, and often decide.
  bool becomes_less(Badness& bound, double least, const std::vector<int>& quads) const {
    Badness now;
    for (const int q : quads) now.shapes += measure_.lacks_shape(q);
    if (bound.flawed == 0 && !now.is_less_than(bound, least)) return false;
    for (const int q : quads) {
      now.flawed += measure_.is_flawed(q);
      if (now.flawed > bound.flawed) return false;
    }
    if (!now.is_less_than(bound, least)) return false;
    bound = now;
    return true;
  }

  std::vector<VertexPlace> places(const std::vector<int>& vertices) const {
    std::vector<VertexPlace> out;
    for (const int v : vertices) out.push_back(piece_.place_of(v));
    return out;
  }

  /// To the best of the places near it. \returns whether that is another one
  bool move(int v, bool far) {
    constexpr double kBetter = 1e-3;
    const std::vector<int> quads(piece_.mesh.quads_at(v).begin(), piece_.mesh.quads_at(v).end());
    Badness least = badness(quads);
    if (least.flawed == 0 && least.shapes == 0) return false;
    VertexPlace best = piece_.place_of(v);
    bool found = false;
    for (const VertexPlace& place : places_near(v, far)) {
      piece_.put(v, place);
      if (!becomes_less(least, kBetter, quads)) continue;
      best = place;
      found = true;
    }
    piece_.put(v, best);
    return found;
  }

  std::vector<VertexPlace> places_near(int v, bool far) const {
    if (!piece_.mesh.is_free(v)) return places_on_curve(v);
    std::vector<VertexPlace> places = places_ahead(v);
    if (far) add_places_around(v, places);
    return places;
  }

  std::vector<VertexPlace> places_on_curve(int v) const {
    const CurveGeometry& curve = piece_.curves[piece_.mesh.anchor(v)];
    std::vector<VertexPlace> places;
    for (const int direction : {1, -1})
      for (const double part : {0.7, 0.4, 0.2, 0.1}) {
        const double arc = curve.normalized(piece_.arc[v] + direction * part * piece_.gap(v, direction));
        places.push_back({curve.at(arc), piece_.face[v], arc});
      }
    return places;
  }

  std::vector<int> neighbours_of(int v) const {
    std::set<int> neighbours;
    for (const int q : piece_.mesh.quads_at(v)) neighbours.insert(piece_.mesh.quad(q).begin(), piece_.mesh.quad(q).end());
    neighbours.erase(v);
    return {neighbours.begin(), neighbours.end()};
  }

  /// On the surface towards and away from what v shares quads with.
  std::vector<VertexPlace> places_ahead(int v) const {
    const Vector3 here = piece_.mesh.positions[v];
    std::vector<VertexPlace> places;
    for (const int w : neighbours_of(v))
      for (const double part : {0.6, 0.3, 0.1, -0.1, -0.3}) {
        const SurfacePoint target = piece_.walk(here + part * (piece_.mesh.positions[w] - here), piece_.face[v]);
        if (target.face >= 0) places.push_back({target.position, target.face, piece_.arc[v]});
      }
    return places;
  }

  /// Points of the faces that can be reached without leaving the ball around v's neighbours or their region.
  void add_places_around(int v, std::vector<VertexPlace>& places) const {
    constexpr std::size_t kMost = 96;
    constexpr std::array<std::array<double, 3>, 4> kInside{
        {{1.0 / 3, 1.0 / 3, 1.0 / 3}, {2.0 / 3, 1.0 / 6, 1.0 / 6}, {1.0 / 6, 2.0 / 3, 1.0 / 6}, {1.0 / 6, 1.0 / 6, 2.0 / 3}}};
    const std::vector<int> faces = faces_around(v);
    const std::size_t each = faces.size() * kInside.size() <= kMost ? kInside.size() : 1;
    const std::size_t step = 1 + faces.size() * each / kMost;
    for (std::size_t i = 0; i < faces.size(); i += step)
      for (std::size_t k = 0; k < each; ++k) {
        Vector3 p = Vector3::Zero();
        for (int c = 0; c < 3; ++c) p += kInside[k][c] * piece_.input.position(piece_.input.face(faces[i])[c]);
        places.push_back({p, faces[i], piece_.arc[v]});
      }
  }

  std::vector<int> faces_around(int v) const {
    constexpr std::size_t kMost = 400;
    const std::vector<int> neighbours = neighbours_of(v);
    Vector3 middle = Vector3::Zero();
    for (const int w : neighbours) middle += piece_.mesh.positions[w] / static_cast<double>(neighbours.size());
    double radius = 0;
    for (const int w : neighbours) radius = std::max(radius, (piece_.mesh.positions[w] - middle).norm());
    std::vector<int> faces{piece_.face[v]};
    for (const int w : neighbours)
      if (piece_.face[w] >= 0) faces.push_back(piece_.face[w]);
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    std::set<int> seen(faces.begin(), faces.end());
    for (std::size_t i = 0; i < faces.size() && faces.size() < kMost; ++i)
      for (int k = 0; k < 3; ++k) {
        const int across = piece_.input.opposite(3 * faces[i] + k);
        if (across < 0) continue;
        const int f = TriangleMesh::face_of(across);
        if (piece_.features.face_region[f] != piece_.features.face_region[faces[i]] || seen.count(f) > 0) continue;
        const auto& corners = piece_.input.face(f);
        const Vector3 nearest = nearest_on_triangle(middle, piece_.input.position(corners[0]), piece_.input.position(corners[1]),
                                                    piece_.input.position(corners[2]));
        if ((nearest - middle).norm() > radius) continue;
        seen.insert(f);
        faces.push_back(f);
      }
    return faces;
  }

  Workpiece& piece_;
  const FlawMeasure& measure_;
  std::vector<int> core_, around_, quads_;
};

}  // namespace

bool search_places(Workpiece& piece, Smoother& smoother, const FlawMeasure& measure, int q) {
  PlaceSearch search(piece, measure, q);
  const bool found = search.run();
  smoother.update_frames(search.quads(), true);
  return found;
}

}  // namespace hybrid_quad
