#include "hybrid_quad/features/small_facets.h"

#include <algorithm>
#include <limits>

namespace hybrid_quad {

namespace {

constexpr double kMostArea = 0.5;   ///< of a squared quad edge
constexpr double kMostReach = 1;    ///< from the centre, of a quad edge
constexpr double kAbout = 1;        ///< how far about the centre the surface is looked at, likewise
constexpr double kFlat = 0.7;       ///< length of the mean of unit normals below which a surface has no common direction
constexpr double kMostHeight = 0.3;   ///< from end to end across the surface about it, of a quad edge
constexpr std::size_t kMostFaces = 2000;  ///< of what is looked at; bounds the work where triangles are tiny

struct Patch {
  std::vector<int> faces;
  double area = 0;
  Vector3 normal = Vector3::Zero();  ///< sum over the area
};

class SmallFacets {
 public:
  SmallFacets(const TriangleMesh& mesh, const std::vector<Vector3>& normals, const std::vector<char>& barriers, double quad)
      : mesh_(mesh), normals_(normals), barriers_(barriers), quad_(quad), seen_(mesh.face_count(), 0) {}

  std::vector<char> find() {
    std::vector<char> in_region(mesh_.face_count(), 0), result(mesh_.face_count(), 0);
    for (int f = 0; f < mesh_.face_count(); ++f) {
      if (in_region[f]) continue;
      const Patch region = flood(f, [&](int h) { return !barriers_[h]; });
      for (const int g : region.faces) in_region[g] = 1;
      if (is_small(region))
        for (const int g : region.faces) result[g] = 1;
    }
    return result;
  }

 private:
  template <class Passes>
  Patch flood(int seed, const Passes& passes, std::size_t most = static_cast<std::size_t>(-1)) {
    ++round_;
    Patch patch;
    patch.faces.push_back(seed);
    seen_[seed] = round_;
    for (std::size_t next = 0; next < patch.faces.size() && next < most; ++next) {
      const int f = patch.faces[next];
      patch.area += mesh_.area(f);
      patch.normal += mesh_.area(f) * normals_[f];
      for (int h = 3 * f; h < 3 * f + 3; ++h) {
        if (mesh_.is_boundary(h) || !passes(h)) continue;
        const int g = mesh_.opposite(h) / 3;
        if (seen_[g] == round_) continue;
        seen_[g] = round_;
        patch.faces.push_back(g);
      }
    }
    return patch;
  }

  bool is_small(const Patch& region) {
    if (!(region.area < kMostArea * quad_ * quad_)) return false;
    Vector3 centre = Vector3::Zero();
    for (const int f : region.faces) centre += middle(f);
    centre /= static_cast<double>(region.faces.size());
    for (const int f : region.faces)
      for (const int v : mesh_.face(f))
        if ((mesh_.position(v) - centre).squaredNorm() > kMostReach * kMostReach * quad_ * quad_) return false;
    const auto is_near = [&](int h) {
      return (middle(mesh_.opposite(h) / 3) - centre).squaredNorm() < kAbout * kAbout * quad_ * quad_;
    };
    const Patch about = flood(region.faces[0], is_near, kMostFaces);
    const double length = about.normal.norm();
    if (!(length > kFlat * about.area)) return false;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const int f : region.faces)
      for (const int v : mesh_.face(f)) {
        const double height = mesh_.position(v).dot(about.normal) / length;
        low = std::min(low, height);
        high = std::max(high, height);
      }
    return high - low < kMostHeight * quad_;
  }

  Vector3 middle(int f) const {
    const auto& t = mesh_.face(f);
    return (mesh_.position(t[0]) + mesh_.position(t[1]) + mesh_.position(t[2])) / 3;
  }

  const TriangleMesh& mesh_;
  const std::vector<Vector3>& normals_;
  const std::vector<char>& barriers_;
  double quad_;
  std::vector<int> seen_;
  int round_ = 0;
};

}  // namespace

std::vector<char> small_facets(const TriangleMesh& mesh, const std::vector<Vector3>& normals, const std::vector<char>& barriers,
                               double quad) {
  return SmallFacets(mesh, normals, barriers, quad).find();
}

}  // namespace hybrid_quad
