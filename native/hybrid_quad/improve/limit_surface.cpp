#include "hybrid_quad/improve/limit_surface.h"

#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/sdc/crease.h>

#include <cstdint>
#include <memory>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/base/interruptible.h"
#include "hybrid_quad/subdivision/catmull_clark_refiner.h"

namespace hybrid_quad {

namespace {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;
using Stencils = Far::LimitStencilTableReal<double>;
using StencilFactory = Far::LimitStencilTableFactoryReal<double>;

ControlMesh control_mesh(const QuadMesh& mesh) {
  ControlMesh control;
  control.vertex_count = static_cast<int>(mesh.positions.size());
  control.face_sizes.assign(mesh.quads.size(), 4);
  for (const auto& quad : mesh.quads) control.face_vertices.insert(control.face_vertices.end(), quad.begin(), quad.end());
  for (const QuadMesh::FeatureEdge& e : mesh.feature_edges)
    control.crease_vertices.insert(control.crease_vertices.end(), {e.a, e.b});
  for (int i = 0; i < control.vertex_count; ++i)
    if (mesh.kind[i] == VertexKind::kCorner) control.sharp_vertices.push_back(i);
  control.crease_sharpness.assign(mesh.feature_edges.size(), Sdc::Crease::SHARPNESS_INFINITE);
  control.vertex_sharpness.assign(control.sharp_vertices.size(), Sdc::Crease::SHARPNESS_INFINITE);
  return control;
}

/// Owns all that OpenSubdiv reads, since its work may outlive a cancelled run.
struct LimitTask {
  ControlMesh control;
  std::vector<double> u, v;
  StencilFactory::LocationArrayVec locations;
  std::unique_ptr<const Stencils> stencils;

  LimitTask(const QuadMesh& mesh, const std::vector<LimitPlace>& places) : control(control_mesh(mesh)) {
    for (const LimitPlace& place : places) {
      u.push_back(place.u);
      v.push_back(place.v);
    }
    for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
      while (end < places.size() && places[end].quad == places[begin].quad) ++end;
      StencilFactory::LocationArray array;
      array.ptexIdx = places[begin].quad;
      array.numLocations = static_cast<int>(end - begin);
      array.s = u.data() + begin;
      array.t = v.data() + begin;
      locations.push_back(array);
    }
  }

  void run() {
    constexpr int kIsolation = 3;  // a patch beside an irregular vertex is an eighth of a quad, and fits it there
    const std::unique_ptr<Far::TopologyRefiner> refiner = catmull_clark_refiner(control);
    if (!refiner) return;
    Far::TopologyRefiner::AdaptiveOptions adaptive(kIsolation);
    adaptive.useInfSharpPatch = true;
    refiner->RefineAdaptive(adaptive);
    StencilFactory::Options options;
    options.generate1stDerivatives = false;
    stencils.reset(StencilFactory::Create(*refiner, locations, nullptr, nullptr, options));
  }
};

}  // namespace

LimitPlace place_on_side(int quad, int side, double fraction) {
  switch (side) {
    case 0: return {quad, fraction, 0};
    case 1: return {quad, 1, fraction};
    case 2: return {quad, 1 - fraction, 1};
    default: return {quad, 0, 1 - fraction};
  }
}

SparseMatrix limit_weights(const QuadMesh& mesh, const std::vector<LimitPlace>& places, const RunContext& context) {
  const auto task = std::make_shared<LimitTask>(mesh, places);
  run_interruptibly(context, 0, [task] { task->run(); });
  const int rows = static_cast<int>(places.size());
  if (!task->stencils || task->stencils->GetNumStencils() != rows)
    throw InternalError("limit surface", "OpenSubdiv made no limit points");
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(task->stencils->GetWeights().size());
  for (int row = 0; row < rows; ++row) {
    const Far::LimitStencilReal<double> stencil = task->stencils->GetLimitStencil(row);
    for (int k = 0; k < stencil.GetSize(); ++k)
      entries.emplace_back(row, stencil.GetVertexIndices()[k], stencil.GetWeights()[k]);
  }
  SparseMatrix weights(rows, task->control.vertex_count);
  weights.setFromTriplets(entries.begin(), entries.end());
  return weights;
}

}  // namespace hybrid_quad
