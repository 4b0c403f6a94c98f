#pragma once

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <vector>

namespace hybrid_quad {

/// A control mesh as OpenSubdiv reads it.
struct ControlMesh {
  int vertex_count = 0;
  std::vector<int> face_sizes, face_vertices;
  std::vector<int> crease_vertices;  ///< two a crease
  std::vector<float> crease_sharpness;
  std::vector<int> sharp_vertices;
  std::vector<float> vertex_sharpness;
  bool keep_corners = false;  ///< boundary vertices of one face stay where they are
};

/// For Catmull and Clark's rules; null if OpenSubdiv refuses the mesh.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> catmull_clark_refiner(const ControlMesh& mesh);

}  // namespace hybrid_quad
