#include "hybrid_quad/pipeline/preview.h"

#include <cmath>
#include <memory>
#include <utility>

#include "hybrid_quad/base/helper_threads.h"
#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/pipeline/common_progress.h"
#include "hybrid_quad/pipeline/component.h"
#include "hybrid_quad/pipeline/count_budget.h"
#include "hybrid_quad/pipeline/even_spread.h"
#include "hybrid_quad/pipeline/run_plan.h"

namespace hybrid_quad {

namespace {

/// The mirror images that make up the whole, as factors of the coordinates.
std::vector<Vector3> images_of(PlaneSet planes) {
  std::vector<Vector3> images{Vector3::Ones()};
  for (int axis = 0; axis < 3; ++axis) {
    if (!has_plane(planes, axis)) continue;
    const std::size_t count = images.size();
    for (std::size_t i = 0; i < count; ++i) {
      images.push_back(images[i]);
      images.back()[axis] *= -1;
    }
  }
  return images;
}

/// Puts what stages saw in the frame into the caller's coordinates, once for each mirror image.
class Collector {
 public:
  Collector(const UnitFrame& frame, const PlaneSet planes, Preview& out) : frame_(frame), images_(images_of(planes)), out_(out) {}

  void add(const WorkingSurface& surface, const FrameField& frames) const {
    for (const Vector3& image : images_) {
      add_frames(surface.mesh, frames, image);
      for (int v = 0; v < surface.mesh.vertex_count(); ++v) {
        if (frames.cone_index[v] == 0) continue;
        out_.singular_points.push_back(outward(surface.mesh.position(v), image));
        out_.singular_quarters.push_back(frames.cone_index[v]);
      }
      for (const FeatureCurve& curve : surface.features.curves)
        for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i)
          out_.feature_lines.push_back({outward(surface.mesh.position(curve.vertices[i]), image),
                                        outward(surface.mesh.position(curve.vertices[i + 1]), image)});
    }
  }

  /// \param quads  mirror images included
  void add(const QuadMesh& quads) const {
    const int base = static_cast<int>(out_.quads.positions.size());
    for (const Vector3& p : quads.positions) out_.quads.positions.push_back(frame_.outward(p));
    out_.quads.kind.insert(out_.quads.kind.end(), quads.kind.begin(), quads.kind.end());
    out_.quads.anchor.insert(out_.quads.anchor.end(), quads.anchor.begin(), quads.anchor.end());
    out_.quads.near_face.insert(out_.quads.near_face.end(), quads.positions.size(), -1);
    for (std::array<int, 4> quad : quads.quads) {
      for (int& v : quad) v += base;
      out_.quads.quads.push_back(quad);
    }
    for (const QuadMesh::FeatureEdge& e : quads.feature_edges)
      out_.quads.feature_edges.push_back({e.a + base, e.b + base, e.curve});
  }

 private:
  Vector3 outward(const Vector3& p, const Vector3& image) const { return frame_.outward(p.cwiseProduct(image)); }

  /// The columns of the frame whose rows the field holds: du . u = 1, dv . u = 0 and so on, in the face's plane.
  void add_frames(const TriangleMesh& mesh, const FrameField& frames, const Vector3& image) const {
    for (int f = 0; f < mesh.face_count(); ++f) {
      const std::array<int, 3> corners = mesh.face(f);
      const Vector3 &a = mesh.position(corners[0]), &b = mesh.position(corners[1]), &c = mesh.position(corners[2]);
      const Vector3 cross = frames.du[f].cross(frames.dv[f]);
      const double area = cross.norm();
      const Vector3 normal = cross / area;
      out_.points.push_back(outward((a + b + c) / 3, image));
      out_.normals.push_back(normal.cwiseProduct(image));
      out_.u.push_back(frame_.scale / area * frames.dv[f].cross(normal).cwiseProduct(image));
      out_.v.push_back(frame_.scale / area * normal.cross(frames.du[f]).cwiseProduct(image));
    }
  }

  const UnitFrame frame_;
  const std::vector<Vector3> images_;
  Preview& out_;
};

std::vector<int> spread_by_quads(const Preview& found) {
  constexpr double kOfEdge = 0.85;  // so that there are about as many as quads
  std::vector<double> distance;
  for (std::size_t i = 0; i < found.u.size(); ++i)
    distance.push_back(kOfEdge * std::sqrt(found.u[i].norm() * found.v[i].norm()));
  return evenly_spread(found.points, found.normals, distance);
}

}  // namespace

Preview preview(const PolygonSoup& soup, const RemeshOptions& options, bool with_quads, const RunContext& context) {
  const HelperThreads helpers;
  Preview out;
  RemeshReport report;
  StageClock clock;
  RunPlan run = plan_run(soup, options, context, report, clock);
  const PlaneSet planes = run.domain.options.symmetry.planes;
  const std::shared_ptr<const SurfaceIndex> whole = with_quads ? index_of_whole(run) : nullptr;
  const Collector collector(run.frame, planes, out);
  const CountBudget budget(run.plans, run.options.is_by_count() ? run.wanted / run.images : 0);
  if (run.options.is_by_count())
    for (ComponentPlan& plan : run.plans) scale_plan(plan, budget.factor());
  std::vector<ComponentPreview> found(run.plans.size());
  std::vector<StageClock> clocks(run.plans.size());
  CommonProgress progress(run.context, shares_of_area(run), 0.04, 1);
  side_by_side(static_cast<int>(found.size()), run.context, [&](int i, const RunContext& each) {
    found[i] = preview_component(run.plans[i], run.plans[i].quads, whole.get(), run.wishes[i], run.guides, run.domain.options,
                                 clocks[i], progress.context_of(i, each));
  });
  for (std::size_t i = 0; i < found.size(); ++i) {
    const ComponentPreview& component = found[i];
    clock.add(clocks[i]);
    collector.add(component.surface, component.frames);
    if (with_quads) collector.add(whole_of(component.quads, run.components[i].mesh, run.marked[i].ends, run.domain.options));
    out.warnings.insert(out.warnings.end(), component.quads.warnings.begin(), component.quads.warnings.end());
  }
  out.spread = spread_by_quads(out);
  out.wanted = run.wanted;
  out.defects = std::move(report.defects);
  out.warnings.insert(out.warnings.begin(), report.warnings.begin(), report.warnings.end());
  out.stages = std::move(clock.records);
  return out;
}

}  // namespace hybrid_quad
