#include "hybrid_quad/pipeline/fewest_quads.h"

#include "hybrid_quad/mesh/topology.h"

namespace hybrid_quad {

namespace {

constexpr int kLeastEdgesOfLoop = 4;  // of a border
constexpr double kSphere = 16, kHandle = 32, kHole = 8;  // quads

/// Whether numbers of vertices and edges of a connected mesh allow so many quads with so many edges on the boundary.
bool may_exist(int quads, int border, int euler) {
  constexpr long long kLeastAtVertex = 3, kLeastVertices = 4;  // quads at one inside; of a quad
  const long long edges = 2LL * quads + border / 2, vertices = euler + edges - quads;
  if (vertices < kLeastVertices || edges > vertices * (vertices - 1) / 2) return false;
  return border > 0 || 4LL * quads >= kLeastAtVertex * vertices;
}

}  // namespace

int fewest_quads(int euler_characteristic, int loops) {
  const int least_border = kLeastEdgesOfLoop * loops;
  for (int quads = 1;; ++quads) {
    // Every border is even: so are the sides of the quads and twice the edges inside.
    const int most_border = loops > 0 ? 4 * quads : 0;
    for (int border = least_border; border <= most_border; border += 2)
      if (may_exist(quads, border, euler_characteristic)) return quads;
  }
}

int fewest_quads(const TriangleMesh& component) {
  return fewest_quads(component.euler_characteristic(), border_loops_of(component));
}

double quads_for_topology(const TriangleMesh& mesh) {
  const int loops = border_loops_of(mesh);
  const double handles = (2.0 - mesh.euler_characteristic() - loops) / 2;
  return (loops > 0 ? 0 : kSphere) + kHandle * handles + kHole * loops;
}

double least_to_plan(const TriangleMesh& mesh) {
  constexpr double kEnough = 0.5;
  const double called_for = quads_for_topology(mesh);
  return called_for <= kSphere ? kEnough * called_for : called_for;
}

}  // namespace hybrid_quad
