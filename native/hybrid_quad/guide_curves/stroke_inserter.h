#pragma once

#include <array>
#include <map>
#include <vector>

#include "hybrid_quad/guide_curves/guide_curves.h"
#include "hybrid_quad/mesh/editable_mesh.h"

namespace hybrid_quad {

/// Splits edges of a mesh so that lines on it become chains of edges. The line goes from vertex to vertex: within the
/// triangles about a vertex straight to where it leaves them.
class StrokeInserter {
 public:
  /// \param index  of `mesh`
  StrokeInserter(const TriangleMesh& mesh, const SurfaceIndex& index, const std::vector<std::array<int, 2>>& marked_edges);

  /// Halves triangles about the samples until their edges are no longer than `longest`.
  void refine(const std::vector<SurfacePoint>& samples, double longest);

  /// \return false if the line jumps from one part of the surface to another: what was inserted up to there stays, without
  ///         an owner
  bool insert(const StrokeTrace::Run& run, int guide);

  EmbeddedStrokes take();

 private:
  struct Walk {
    int vertex;     ///< the last one of the chain
    Vector3 place;  ///< how far the line has been followed
    int face;       ///< about `vertex`, holds `place`
  };
  struct Target {
    SurfacePoint point;
    int vertex = -1;  ///< the one there, or none yet
  };
  using Edge = std::array<int, 2>;

  int split(int h, const Vector3& p);
  int insert_point(const SurfacePoint& p);
  bool connect(Walk& walk, const Target& target, int depth);
  bool enter(Walk& walk, const Target& target, const std::vector<int>& faces);
  int shared_edge(int face, const std::vector<int>& others) const;
  void cross(Walk& walk, int h, const Vector3& towards);
  void step_to(Walk& walk, int v);
  std::vector<int> faces_at(const Target& target) const;
  std::vector<int> faces_about(int v) const;
  int locate(const SurfacePoint& p) const;
  int longest_side(int f) const;
  bool has_corner(int f, int v) const;
  double depth_in(int f, const Vector3& p, int* shallowest = nullptr) const;

  const SurfaceIndex& index_;
  EditableMesh mesh_;                           // regions: faces of the given mesh
  std::map<int, std::vector<int>> parts_;       // of the faces that were split
  std::vector<int> vertex_face_;                // of the new vertices
  std::map<Edge, std::vector<int>> owners_;     // guides of chains; -1 - i: marked edge i
  std::vector<Edge> chain_;                     // of the walk under way
  int steps_left_ = 0;
};

}  // namespace hybrid_quad
