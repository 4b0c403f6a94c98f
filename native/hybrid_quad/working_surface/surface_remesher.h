#pragma once

#include <vector>

#include "hybrid_quad/mesh/editable_mesh.h"
#include "hybrid_quad/mesh/surface_index.h"
#include "hybrid_quad/working_surface/working_surface.h"

namespace hybrid_quad {

/// Isotropic remeshing by local operations (Botsch & Kobbelt 2004) that knows feature curves: their vertices stay on
/// them, corners stay where they are.
class SurfaceRemesher {
 public:
  SurfaceRemesher(const SurfaceIndex& index, const FeatureGraph& features, const std::vector<double>& target_length,
                  const WorkingSurfaceOptions& options, const RunContext& context);

  void run();

  const EditableMesh& mesh() const { return mesh_; }
  double target_length(int v) const { return vertex_[v].target; }
  int near_face(int v) const { return vertex_[v].hint; }
  int input_vertex(int v) const { return vertex_[v].input; }

 private:
  struct VertexData {
    double target = 1;    ///< h
    double error = 0;     ///< bound of how far what was collapsed here lies from the surface
    int input = -1;       ///< input vertex, as long as it was not moved
    int hint = -1;        ///< an input face near by
    bool on_feature = false;
    bool is_corner = false;
  };

  double edge_target(int h) const { return 0.5 * (vertex_[mesh_.from(h)].target + vertex_[mesh_.to(h)].target); }
  bool is_feature(int h) const { return mesh_.curve(h) >= 0; }
  bool stands_for_edge(int h) const { return mesh_.is_face(h / 3) && (mesh_.opposite(h) < 0 || h < mesh_.opposite(h)); }
  bool joins_features(int h) const {
    return !is_feature(h) && vertex_[mesh_.from(h)].on_feature && vertex_[mesh_.to(h)].on_feature;
  }
  /// Whether a face at the edge is other than when flip_edges() last looked at it.
  bool has_changed(int h) const {
    const int o = mesh_.opposite(h);
    return changed_at_[h / 3] > flipped_at_ || (o >= 0 && changed_at_[o / 3] > flipped_at_);
  }
  void set_changed_around(int v) {
    mesh_.visit_outgoing(v, [this](int h) { changed_at_[h / 3] = time_; });
  }
  void checkpoint() { if ((++work_ & 0x3fff) == 0) context_.checkpoint(progress_); }

  // Passes over the mesh.
  void collapse_short_edges(double longest);
  void split_long_edges(double longest);
  void split_feature_edges();
  void split_edges_between_features();
  void flip_edges();
  void relax();
  void open_faces_without_area();
  void renumber();
  std::vector<std::vector<int>> free_vertices_by_colour() const;

  // One operation.
  int split(int h, double at);
  bool try_collapse(int h);
  bool may_leave_curve_vertex(int h) const;
  bool keeps_feature_distance(int h) const;
  bool stretches_edge(int h) const;
  bool keeps_shape(int h, double& error) const;
  bool wants_flip(int h) const;
  bool flip_keeps_shape(int h) const;
  bool has_changed_around(int v) const;
  void relax_vertex(int v);
  bool try_open(int f);
  bool move_keeps_shape(int v, const Vector3& p) const;
  bool move_keeps_surface(int v, const SurfacePoint& q) const;
  double walked_distance2(int v, const Vector3& p) const;
  SurfacePoint project(int v, const Vector3& normal, const Vector3& p) const;

  const RunContext& context_;
  WorkingSurfaceOptions options_;
  const std::vector<int>& input_region_;
  const SurfaceIndex& index_;
  EditableMesh mesh_;
  std::vector<VertexData> vertex_;
  // Where nothing has changed since edges and vertices were last looked at, they are as they should be.
  int time_ = 1, flipped_at_ = 0;
  std::vector<int> changed_at_;  ///< by face
  std::vector<int> relaxed_at_;  ///< by vertex
  std::vector<int> curve_edges_, curve_originals_;  ///< edges of each curve; input vertices left inside it
  std::vector<char> curve_is_loop_;
  bool final_phase_ = false;  ///< no operation may join two feature vertices any more
  unsigned work_ = 0;
  double progress_ = 0;
};

}  // namespace hybrid_quad
