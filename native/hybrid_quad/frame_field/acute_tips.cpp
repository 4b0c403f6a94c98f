#include "hybrid_quad/frame_field/acute_tips.h"

#include <algorithm>
#include <cmath>

namespace hybrid_quad {

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kNarrowest = 24 * kDegree, kWidest = 50 * kDegree;  ///< of the tips that are opened
constexpr double kOpened = 58 * kDegree, kMost = 33 * kDegree;       ///< to what angle, and by how much at most
constexpr double kLeastSide = 6;  ///< quad edges: shorter ones are no place for rows to end

class TipOpener {
 public:
  TipOpener(const WorkingSurface& surface, const FaceAngles& angles)
      : surface_(surface), mesh_(surface.mesh), angles_(angles), turns_(mesh_.halfedge_count(), 0), tip_(mesh_.face_count(), -1) {}

  std::vector<double> run() {
    for (int h = 0; h < mesh_.halfedge_count(); ++h)
      if (is_side(h)) open(sector_at(h));
    return std::move(turns_);
  }

 private:
  /// Faces around a vertex from one side counterclockwise to the next.
  struct Sector {
    int first = -1, last = -1;  ///< half-edges of the sides, in the sector's first and last face
    std::vector<int> faces;
    double angle = 0;
    Vector3 normal = Vector3::Zero();
  };

  bool is_side(int h) const { return surface_.features.is_feature(h) || mesh_.is_boundary(h); }

  Sector sector_at(int first) const {
    Sector sector;
    sector.first = first;
    for (int h = first;;) {
      sector.angle += angles_.corner(h);
      sector.normal += mesh_.normal(h / 3);
      sector.faces.push_back(h / 3);
      sector.last = TriangleMesh::previous(h);
      if (is_side(sector.last)) return sector;
      h = mesh_.rotate_ccw(h);
    }
  }

  /// Of the side that begins at vertex v with an edge, up to where it ends, forks or bends.
  double straight_length(int v, int edge) const {
    constexpr double kStraight = 0.95;  // cosine
    const Vector3 along = (mesh_.position(other_end(edge, v)) - mesh_.position(v)).normalized();
    double length = 0;
    for (int at = v, start = v; edge >= 0;) {
      const int next = other_end(edge, at);
      const Vector3 step = mesh_.position(next) - mesh_.position(at);
      if (step.dot(along) < kStraight * step.norm()) break;
      length += step.norm();
      if (next == start || surface_.features.is_corner[next]) break;
      edge = onward(next, at);
      at = next;
    }
    return length;
  }

  int other_end(int edge, int v) const { return mesh_.from(edge) == v ? mesh_.to(edge) : mesh_.from(edge); }

  /// The side at v that does not lead back; -1 if there is none.
  int onward(int v, int back) const {
    const int first = mesh_.outgoing(v);
    for (int h = first; h >= 0;) {
      if (is_side(h) && mesh_.to(h) != back) return h;
      const int in = TriangleMesh::previous(h);
      if (mesh_.is_boundary(in) && mesh_.from(in) != back) return in;
      h = mesh_.rotate_ccw(h);
      if (h == first) break;
    }
    return -1;
  }

  Vector3 middle(int f) const {
    return (mesh_.position(mesh_.from(3 * f)) + mesh_.position(mesh_.from(3 * f + 1)) + mesh_.position(mesh_.from(3 * f + 2))) / 3;
  }

  void open(const Sector& sector) {
    if (sector.angle < kNarrowest || sector.angle > kWidest) return;
    const int v = mesh_.from(sector.first);
    const double least = kLeastSide * surface_.target_length[sector.faces[0]];
    const double reach = std::min(straight_length(v, sector.first), straight_length(v, sector.last));
    if (reach < least) return;
    const double opening = std::min(kMost, kOpened - sector.angle) / sector.angle;
    const Vector3 origin = mesh_.position(v), normal = sector.normal.normalized();
    const Vector3 side = mesh_.edge_vector(sector.first);
    const Vector3 x = (side - side.dot(normal) * normal).normalized(), y = normal.cross(x);
    std::vector<int> faces = sector.faces;
    for (const int f : faces) tip_[f] = sector.first;
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const Vector3 here = middle(faces[i]) - origin;
      for (int h = 3 * faces[i]; h < 3 * faces[i] + 3; ++h) {
        if (is_side(h)) continue;
        const int o = mesh_.opposite(h);
        const Vector3 there = middle(o / 3) - origin;
        const double distance = 0.5 * (here.norm() + there.norm());
        if (distance > reach) continue;
        if (tip_[o / 3] != sector.first) {
          tip_[o / 3] = sector.first;
          faces.push_back(o / 3);
        }
        if (o < h) continue;
        const double around = std::atan2(there.dot(y), there.dot(x)) - std::atan2(here.dot(y), here.dot(x));
        const double turn = -opening * around * (1 - distance / reach);
        turns_[h] += turn;
        turns_[o] -= turn;
      }
    }
  }

  const WorkingSurface& surface_;
  const TriangleMesh& mesh_;
  const FaceAngles& angles_;
  std::vector<double> turns_;
  std::vector<int> tip_;  ///< of each face: the sector that it was reached from last
};

}  // namespace

std::vector<double> turns_that_open_tips(const WorkingSurface& surface, const FaceAngles& angles) {
  return TipOpener(surface, angles).run();
}

}  // namespace hybrid_quad
