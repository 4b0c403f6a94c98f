#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "hybrid_quad/features/features.h"
#include "hybrid_quad/mesh/quad_mesh.h"

namespace hybrid_quad {

/// A quad mesh whose faces can be replaced and put back: incidence lists and an undo log. Feature edges and the
/// vertices on them stay for good, so everything about them is known from the start.
class EditMesh {
 public:
  using Quad = std::array<int, 4>;

  /// A feature edge seen from one of its ends.
  struct FeatureLink {
    int vertex;       ///< the other end
    int curve;
    bool forward;     ///< the curve runs from here to `vertex`
    int ideal = 2;    ///< wanted number of quads in the sector that begins here, counterclockwise
    double angle = 0; ///< of the input surface in that sector (radians)
  };

  EditMesh(const QuadMesh& mesh, const TriangleMesh& input, const FeatureGraph& features);

  /// The mesh as it stands, without dead quads and unused vertices.
  /// \param near_face  #V or empty (not known)
  QuadMesh extract(const std::vector<int>& near_face = {}) const;

  std::vector<Vector3> positions;

  int vertex_count() const { return static_cast<int>(positions.size()); }
  int quad_count() const { return static_cast<int>(quads_.size()); }  ///< dead ones too
  int live_quads() const { return static_cast<int>(std::count(alive_.begin(), alive_.end(), 1)); }
  bool alive(int q) const { return alive_[q] != 0; }
  const Quad& quad(int q) const { return quads_[q]; }
  const std::vector<int>& quads_at(int v) const { return incident_[v]; }  ///< ascending, whatever was done and undone
  int valence(int v) const { return static_cast<int>(incident_[v].size()); }
  VertexKind kind(int v) const { return kind_[v]; }
  bool is_free(int v) const { return kind_[v] == VertexKind::kFree; }
  int anchor(int v) const { return anchor_[v]; }
  bool on_boundary(int v) const { return boundary_[v] != 0; }
  const std::vector<FeatureLink>& feature_links(int v) const { return links_[v]; }
  bool is_feature(int a, int b) const;

  int corner_of(int q, int v) const;      ///< index of v in q, -1 if it is not there
  int across(int q, int side) const;      ///< the quad beyond side `side` of q, -1 on the boundary
  bool has_edge(int a, int b) const;
  /// Fewest quads a vertex may be left with.
  int least_valence(int v) const;

  /// Keeps q as it is: no move touches it, and its vertices stay where they are.
  void lock(int q);
  bool is_locked(int q) const { return locked_[q] != 0; }
  bool is_pinned(int v) const { return pinned_[v] != 0; }

  /// Replaces the corners of q, or removes it; remembered for undo.
  void set_quad(int q, const Quad& corners, bool is_alive);
  int add_vertex(const Vector3& position, int region);
  int add_quad(const Quad& corners);
  std::size_t mark() const { return log_.size(); }
  void undo_to(std::size_t mark);
  void forget_log() { log_.clear(); }

 private:
  struct Change {
    int quad;
    Quad corners;
    char alive;
  };
  void replace(int q, const Quad& corners, bool is_alive);
  void find_boundary();
  void link_features(const std::vector<QuadMesh::FeatureEdge>& edges);
  void find_ideals(const TriangleMesh& input, const FeatureGraph& features);

  std::vector<Quad> quads_;
  std::vector<char> alive_, locked_;
  std::vector<char> pinned_;  // #V: some quad there is locked
  std::vector<std::vector<int>> incident_;
  std::vector<VertexKind> kind_;
  std::vector<int> anchor_;
  std::vector<char> boundary_;
  std::vector<std::vector<FeatureLink>> links_;
  std::vector<QuadMesh::FeatureEdge> feature_edges_;
  std::vector<Change> log_;
};

}  // namespace hybrid_quad
