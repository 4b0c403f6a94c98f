#include "hybrid_quad/pipeline/split_triangles.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "hybrid_quad/mesh/topology.h"
#include "hybrid_quad/pipeline/curve_counts.h"
#include "hybrid_quad/pipeline/finishing.h"

namespace hybrid_quad {

namespace {

class TriangleSplitter {
 public:
  TriangleSplitter(const TriangleMesh& component, const ComponentPlan& plan)
      : component_(component), plan_(plan), middle_(component.halfedge_count(), -1) {}

  std::optional<QuadMesh> run() {
    for (int v = 0; v < component_.vertex_count(); ++v) add_corner(v);
    if (!add_middles() || !bind_to_curves()) return std::nullopt;
    for (int f = 0; f < component_.face_count(); ++f) {
      const int h = 3 * f, centre = add_free((component_.position(component_.from(h)) + component_.position(component_.from(h + 1)) +
                                              component_.position(component_.from(h + 2))) / 3);
      for (int k = 0; k < 3; ++k)
        quads_.quads.push_back({component_.from(h + k), middle_[h + k], centre, middle_[h + (k + 2) % 3]});
    }
    const bool is_valid = violations_of(quads_).empty() && topology_of(quads_) == topology_of(component_);
    return is_valid ? std::optional(std::move(quads_)) : std::nullopt;
  }

 private:
  static std::pair<int, int> sorted_pair(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

  int add(const Vector3& position, VertexKind kind, int anchor, int near_face) {
    quads_.positions.push_back(position);
    quads_.kind.push_back(kind);
    quads_.anchor.push_back(anchor);
    quads_.near_face.push_back(near_face);
    return static_cast<int>(quads_.positions.size()) - 1;
  }

  int add_free(const Vector3& position) {
    const int face = plan_.index->nearest(position).face;
    return add(position, VertexKind::kFree, plan_.features.face_region[face], face);
  }

  void add_corner(int v) {
    const int face = plan_.mesh.outgoing(v) / 3;
    if (plan_.features.is_corner[v]) add(component_.position(v), VertexKind::kCorner, v, face);
    else add(component_.position(v), VertexKind::kFree, plan_.features.face_region[face], face);
  }

  bool add_middles() {
    for (int h = 0; h < component_.halfedge_count(); ++h) {
      const int o = component_.opposite(h);
      if (o >= 0 && o < h) {
        middle_[h] = middle_[o];
        continue;
      }
      middle_[h] = add_free(0.5 * (component_.position(component_.from(h)) + component_.position(component_.to(h))));
      if (!middle_of_.emplace(sorted_pair(component_.from(h), component_.to(h)), middle_[h]).second) return false;
    }
    return true;
  }

  void put_on(int v, int curve) {
    if (quads_.kind[v] == VertexKind::kCorner) return;
    quads_.kind[v] = VertexKind::kCurve;
    quads_.anchor[v] = curve;
  }

  /// The plan's curves run along halves of the component's edges.
  bool bind_to_curves() {
    for (std::size_t c = 0; c < plan_.features.curves.size(); ++c) {
      const int curve = static_cast<int>(c);
      const std::vector<int>& vertices = plan_.features.curves[c].vertices;
      const auto is_given = [&](int v) { return v < component_.vertex_count(); };
      std::vector<int> given;
      std::copy_if(vertices.begin(), vertices.end(), std::back_inserter(given), is_given);
      if (given.empty()) return false;
      if (!is_given(vertices.front())) {  // a loop may begin in the middle of an edge
        if (!plan_.features.curves[c].closed) return false;
        given.push_back(given.front());
      } else if (!is_given(vertices.back())) {
        return false;
      }
      for (std::size_t i = 0; i + 1 < given.size(); ++i) {
        const auto middle = middle_of_.find(sorted_pair(given[i], given[i + 1]));
        if (middle == middle_of_.end()) return false;
        for (const int v : {given[i], middle->second, given[i + 1]}) put_on(v, curve);
        quads_.feature_edges.push_back({given[i], middle->second, curve});
        quads_.feature_edges.push_back({middle->second, given[i + 1], curve});
      }
    }
    return true;
  }

  const TriangleMesh& component_;
  const ComponentPlan& plan_;
  QuadMesh quads_;
  std::vector<int> middle_;                       ///< by half-edge
  std::map<std::pair<int, int>, int> middle_of_;  ///< by the ends of an edge
};

}  // namespace

std::optional<QuadMesh> split_triangles(const TriangleMesh& component, const ComponentPlan& plan) {
  return TriangleSplitter(component, plan).run();
}

void keep_triangles(const TriangleMesh& component, const ComponentPlan& plan, double wanted, const SurfaceIndex& whole, int threads,
                    ComponentResult& result) {
  constexpr double kFewEnough = 2;  // times as many as there are, or were to be
  if (3.0 * component.face_count() > kFewEnough * std::max(wanted, static_cast<double>(result.mesh.quads.size()))) return;
  std::optional<QuadMesh> quads = split_triangles(component, plan);
  if (!quads) return;
  const int flawed = static_cast<int>(flawed_quads(*quads, whole, least_agreement(whole), threads).size());
  if (flawed >= result.flawed_quads) return;
  result.mesh = *std::move(quads);
  // All of it is one patch filled without a field.
  result.patches = {1, 0, 1, 0};
  result.singular_area = result.combinatorial_area = result.area;
  result.missed_counts = missed_counts(plan.features, result.mesh);
  result.warnings.push_back("a part is made of its own triangles, each in three quads: too narrow or too folded for quads of the lengths asked for");
  result.features = plan.features;
  result.curve_planes = plan.curve_planes;
  result.features_given_way = plan.given_way;
  result.marks_given_way = plan.marks_given_way;
  result.rings.clear();
  result.chains.clear();
  result.flawed_quads = flawed;
  result.repairs.split_triangles += component.face_count();
}

}  // namespace hybrid_quad
