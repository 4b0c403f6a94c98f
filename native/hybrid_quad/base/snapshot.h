#pragma once

#include <map>
#include <string>
#include <vector>

#include "hybrid_quad/base/types.h"

namespace hybrid_quad {

/// What a stage saw, in a form that files, viewers and tests all read: a polygon mesh with named arrays.
struct Snapshot {
  std::string stage;
  std::vector<Vector3> points;
  std::vector<int> face_sizes;     ///< corners of each face
  std::vector<int> face_vertices;  ///< the faces' vertices, one face after the other
  std::map<std::string, std::vector<double>> vertex_values;  ///< each #points long
  std::map<std::string, std::vector<double>> face_values;    ///< each #faces long
  std::map<std::string, std::vector<double>> face_vectors;   ///< each 3 * #faces long
  std::vector<std::array<int, 2>> lines;                     ///< edges worth drawing (features, say)
};

}  // namespace hybrid_quad
