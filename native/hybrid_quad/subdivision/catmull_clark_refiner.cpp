#include "hybrid_quad/subdivision/catmull_clark_refiner.h"

#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

namespace hybrid_quad {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

std::unique_ptr<Far::TopologyRefiner> catmull_clark_refiner(const ControlMesh& mesh) {
  Far::TopologyDescriptor topology;
  topology.numVertices = mesh.vertex_count;
  topology.numFaces = static_cast<int>(mesh.face_sizes.size());
  topology.numVertsPerFace = mesh.face_sizes.data();
  topology.vertIndicesPerFace = mesh.face_vertices.data();
  topology.numCreases = static_cast<int>(mesh.crease_sharpness.size());
  topology.creaseVertexIndexPairs = mesh.crease_vertices.data();
  topology.creaseWeights = mesh.crease_sharpness.data();
  topology.numCorners = static_cast<int>(mesh.vertex_sharpness.size());
  topology.cornerVertexIndices = mesh.sharp_vertices.data();
  topology.cornerWeights = mesh.vertex_sharpness.data();
  Sdc::Options scheme;
  scheme.SetVtxBoundaryInterpolation(mesh.keep_corners ? Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER
                                                       : Sdc::Options::VTX_BOUNDARY_EDGE_ONLY);
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  return std::unique_ptr<Far::TopologyRefiner>(
      Factory::Create(topology, Factory::Options(Sdc::SCHEME_CATMARK, scheme)));
}

}  // namespace hybrid_quad
