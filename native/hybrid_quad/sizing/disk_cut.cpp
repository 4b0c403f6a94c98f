#include "hybrid_quad/sizing/disk_cut.h"

#include <algorithm>

namespace hybrid_quad {

namespace {

class DiskCutter {
 public:
  DiskCutter(const TriangleMesh& mesh, const std::vector<std::uint8_t>& matching)
      : mesh_(mesh), matching_(matching), is_glued_(mesh.halfedge_count(), 0) {}

  DiskCut run() {
    const std::vector<int> first_faces = glue_along_tree();
    glue_loose_ends();
    DiskCut result;
    number_nodes(result);
    for (const int f : first_faces) result.piece_node.push_back(result.node[3 * f]);
    for (int h = 0; h < mesh_.halfedge_count(); ++h)
      if (h < mesh_.opposite(h) && !is_glued_[h]) result.cut.push_back(h);
    return result;
  }

 private:
  void glue(int h) { is_glued_[h] = is_glued_[mesh_.opposite(h)] = 1; }

  /// Faces by breadth-first search, which makes short cuts. \return where every piece begins
  std::vector<int> glue_along_tree() {
    std::vector<int> first_faces, order;
    std::vector<char> seen(mesh_.face_count(), 0);
    for (int seed = 0; seed < mesh_.face_count(); ++seed) {
      if (seen[seed]) continue;
      seen[seed] = 1;
      first_faces.push_back(seed);
      order.assign(1, seed);
      for (std::size_t k = 0; k < order.size(); ++k)
        for (int h = 3 * order[k]; h < 3 * order[k] + 3; ++h) {
          const int o = mesh_.opposite(h);
          if (o < 0 || seen[o / 3] || matching_[h] != 0) continue;
          seen[o / 3] = 1;
          glue(h);
          order.push_back(o / 3);
        }
    }
    return first_faces;
  }

  /// A cut that ends inside at no cone has nothing on its other side: around its end all matchings but its own are 0.
  void glue_loose_ends() {
    std::vector<int> cuts(mesh_.vertex_count(), 0), ends;
    for (int h = 0; h < mesh_.halfedge_count(); ++h)
      if (mesh_.opposite(h) >= 0 && !is_glued_[h]) ++cuts[mesh_.from(h)];
    const auto is_loose = [&](int v) { return cuts[v] == 1 && !mesh_.is_boundary_vertex(v); };
    for (int v = 0; v < mesh_.vertex_count(); ++v)
      if (is_loose(v)) ends.push_back(v);
    while (!ends.empty()) {
      const int v = ends.back();
      ends.pop_back();
      if (!is_loose(v)) continue;
      int h = mesh_.outgoing(v);
      while (is_glued_[h]) h = mesh_.rotate_ccw(h);
      if (matching_[h] != 0) continue;
      glue(h);
      --cuts[v];
      if (--cuts[mesh_.to(h)] == 1) ends.push_back(mesh_.to(h));
    }
  }

  /// The corner counterclockwise behind a cut or the border; any where there is neither.
  int first_corner(int v) const {
    const int start = mesh_.outgoing(v);
    if (mesh_.is_boundary_vertex(v)) return start;
    int h = start;
    do {
      if (!is_glued_[h]) return h;
      h = mesh_.rotate_ccw(h);
    } while (h != start);
    return start;
  }

  void number_nodes(DiskCut& result) const {
    result.node.assign(mesh_.halfedge_count(), -1);
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      if (mesh_.outgoing(v) < 0) continue;
      const int first = first_corner(v);
      result.node_vertex.push_back(v);
      int h = first;
      do {
        result.node[h] = static_cast<int>(result.node_vertex.size()) - 1;
        const bool is_last = !is_glued_[TriangleMesh::previous(h)];
        h = mesh_.rotate_ccw(h);
        if (is_last && h >= 0 && h != first) result.node_vertex.push_back(v);
      } while (h >= 0 && h != first);
    }
  }

  const TriangleMesh& mesh_;
  const std::vector<std::uint8_t>& matching_;
  std::vector<char> is_glued_;
};

}  // namespace

DiskCut cut_to_disks(const TriangleMesh& mesh, const std::vector<std::uint8_t>& matching) { return DiskCutter(mesh, matching).run(); }

}  // namespace hybrid_quad
