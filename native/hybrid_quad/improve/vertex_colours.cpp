#include "hybrid_quad/improve/vertex_colours.h"

namespace hybrid_quad {

std::vector<std::vector<int>> vertices_by_colour(const EditMesh& mesh) {
  std::vector<std::vector<int>> groups;
  std::vector<int> colour(mesh.vertex_count(), -1), taken_by;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.valence(v) == 0) continue;
    for (const int q : mesh.quads_at(v))
      for (const int w : mesh.quad(q))
        if (colour[w] >= 0) taken_by[colour[w]] = v;
    int c = 0;
    while (c < static_cast<int>(taken_by.size()) && taken_by[c] == v) ++c;
    if (c == static_cast<int>(taken_by.size())) {
      taken_by.push_back(-1);
      groups.emplace_back();
    }
    colour[v] = c;
    groups[c].push_back(v);
  }
  return groups;
}

}  // namespace hybrid_quad
