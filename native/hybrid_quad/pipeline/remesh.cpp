#include "hybrid_quad/pipeline/remesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "hybrid_quad/base/helper_threads.h"
#include "hybrid_quad/mesh/unit_frame.h"
#include "hybrid_quad/pipeline/component.h"
#include "hybrid_quad/pipeline/fewest_quads.h"
#include "hybrid_quad/pipeline/finishing.h"
#include "hybrid_quad/pipeline/guided_input.h"
#include "hybrid_quad/pipeline/limit_fit.h"
#include "hybrid_quad/pipeline/remesh_components.h"
#include "hybrid_quad/pipeline/run_plan.h"
#include "hybrid_quad/pipeline/symmetric_domain.h"
#include "hybrid_quad/pipeline/validity.h"

namespace hybrid_quad {

namespace {

constexpr double kCountTolerance = 0.1;  // off by more, a warning says so
constexpr double kManyPoor =
    0.03;  // of the quads: so too; good results have a thousandth, some with features at acute angles a hundredth

/// \param m  the component's quads, mirror images included  \param images  how many of these there are
/// \param guided  gets those of the component
void append(RemeshResult& result, const QuadMesh& m, const ComponentResult& component, const std::vector<int>& input_vertex,
            int images, GuidedEdges& guided) {
  const int base = static_cast<int>(result.mesh.positions.size());
  result.mesh.positions.insert(result.mesh.positions.end(), m.positions.begin(), m.positions.end());
  result.mesh.kind.insert(result.mesh.kind.end(), m.kind.begin(), m.kind.end());
  result.mesh.near_face.resize(result.mesh.positions.size(), -1);
  for (std::size_t v = 0; v < m.anchor.size(); ++v)
    result.mesh.anchor.push_back(m.kind[v] == VertexKind::kCorner && m.anchor[v] >= 0 ? input_vertex[m.anchor[v]] : m.anchor[v]);
  for (auto q : m.quads) {
    for (int& v : q) v += base;
    result.mesh.quads.push_back(q);
  }
  for (auto e : m.feature_edges) result.mesh.feature_edges.push_back({e.a + base, e.b + base, e.curve});
  for (const GuideEdge& e : component.rings) guided.rings.push_back({e.a + base, e.b + base, e.guide});
  for (const GuideEdge& e : component.chains) guided.chains.push_back({e.a + base, e.b + base, e.guide});
  RemeshReport& r = result.report;
  r.working_faces += component.working_faces;
  r.field_singularities += images * component.field_singularities;
  r.feature_singularities += images * component.feature_singularities;
  r.field.relaxed_quarters += images * component.field_choice.relaxed.quarters;
  r.field.smoothest_quarters += images * component.field_choice.smoothest.quarters;
  ++(component.field_choice.kept == 0 ? r.field.relaxed_kept : r.field.smoothest_kept);
  r.dislocations += images * component.dislocations;
  r.dislocations_found += images * component.dislocations_found;
  for (int i = 0; i < images; ++i) r.repairs += component.repairs;
  r.flawed_quads += images * component.flawed_quads;
  r.extra_passes += component.passes - 1;
  r.patches.count += images * component.patches.count;
  r.patches.morse_smale += images * component.patches.morse_smale;
  r.patches.combinatorial += images * component.patches.combinatorial;
  r.warnings.insert(r.warnings.end(), component.warnings.begin(), component.warnings.end());
}

/// The component's quads with feature edges by the curves of the plan, which a ring may have joined; without edges on features that gave way
/// in the plan and are kept all the same (ComponentPlan::with_all).
QuadMesh on_curves_of(const ComponentPlan& plan, const ComponentResult& component) {
  QuadMesh mesh = component.mesh;
  std::vector<int> planned(component.features.curves.size(), -1);
  for (int h = plan.mesh.halfedge_count() - 1; h >= 0; --h)
    if (component.features.is_feature(h) && plan.features.is_feature(h)) {
      int& curve = planned[component.features.halfedge_curve[h]];
      curve = curve < 0 ? plan.features.halfedge_curve[h] : std::min(curve, plan.features.halfedge_curve[h]);
    }
  for (QuadMesh::FeatureEdge& e : mesh.feature_edges) e.curve = planned[e.curve];
  auto& edges = mesh.feature_edges;
  edges.erase(std::remove_if(edges.begin(), edges.end(), [](const QuadMesh::FeatureEdge& e) { return e.curve < 0; }), edges.end());
  return mesh;
}

/// Quads that lie alone between two features: two opposite edges of theirs are feature edges.
int lone_quads(const QuadMesh& mesh) {
  std::set<std::array<int, 2>> features;
  for (const QuadMesh::FeatureEdge& e : mesh.feature_edges) features.insert({std::min(e.a, e.b), std::max(e.a, e.b)});
  int count = 0;
  for (const auto& q : mesh.quads) {
    const auto is_feature = [&](int side) {
      const int a = q[side], b = q[(side + 1) & 3];
      return features.count({std::min(a, b), std::max(a, b)}) > 0;
    };
    count += (is_feature(0) && is_feature(2)) || (is_feature(1) && is_feature(3));
  }
  return count;
}

/// Vertices of the input that a component's vertices are; -1 for those that are none of it.
std::vector<int> input_vertices_of(const RunPlan& run, std::size_t component, int input_vertex_count) {
  std::vector<int> input_vertex;
  for (const int v : run.components[component].vertex) {
    const int in_soup = run.domain.input_vertex[v];
    input_vertex.push_back(in_soup < input_vertex_count ? in_soup : -1);
  }
  // What halving long edges added; corners in folds, now and then.
  input_vertex.resize(run.plans[component].mesh.vertex_count(), -1);
  return input_vertex;
}

/// Puts the quads of all components, each with its mirror images, into one mesh. Returns the edges at guides.
GuidedEdges join_components(RunPlan& run, std::vector<ComponentResult>& parts, const SurfaceIndex& whole, StageClock& clock,
                            RemeshResult& result) {
  RemeshReport& report = result.report;
  GuidedEdges guided;
  double singular_area = 0, combinatorial_area = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const ComponentPlan& plan = run.plans[i];
    const auto with_images = [&] { return whole_of(parts[i], run.components[i].mesh, run.marked[i].ends, run.domain.options); };
    run.counts.record(plan, on_curves_of(plan, parts[i]));
    QuadMesh quads = with_images();
    if (run.options.fit_limit_surface) {
      clock.measure("limit surface", [&] {
        const RunContext context = run.context.in_stage("limit surface", 0.97, 0.97);
        const LimitFitReport fit =
            fit_component(parts[i], quads, plan.mesh, run.domain.options.symmetry.planes, whole, context);
        add_fit(report.limit_fit, fit, run.components[i].mesh.total_area() / run.area, surface_of(run).diagonal());
      });
      quads = with_images();
    }
    append(result, quads, parts[i], input_vertices_of(run, i, report.input_vertices), run.images, guided);
    report.fewest_quads += run.images * fewest_quads(plan.mesh);
    report.features_given_way += run.images * parts[i].features_given_way;
    report.marks_given_way += run.images * parts[i].marks_given_way;
    report.sharp_angle_used = std::max(report.sharp_angle_used, plan.sharp_angle);
    singular_area += parts[i].singular_area;
    combinatorial_area += parts[i].combinatorial_area;
  }
  report.quads = static_cast<int>(result.mesh.quads.size());
  report.vertices = static_cast<int>(result.mesh.positions.size());
  report.singular_area_fraction = singular_area / run.area;
  report.patches.combinatorial_area_fraction = combinatorial_area / run.area;
  return guided;
}

void record_shapes(const ShapeQuality& shape, RemeshReport& r) {
  r.scaled_jacobian_mean = shape.scaled_jacobian_mean;
  r.scaled_jacobian_p1 = shape.scaled_jacobian_p1;
  r.scaled_jacobian_min = shape.scaled_jacobian_min;
  r.irregular_vertices = shape.irregular_vertices;
}

void measure_distances(RemeshResult& result, const std::vector<ComponentPlan>& plans, const std::vector<ComponentResult>& parts,
                       const SurfaceIndex& whole, const RunContext& context) {
  RemeshReport& r = result.report;
  r.are_distances_measured = true;
  const SurfaceDistance distance = surface_distance(result.mesh, whole, context);
  r.hausdorff_percent = distance.hausdorff();
  r.mean_distance_percent = distance.mean;
  const double diagonal = whole.mesh().diagonal();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double percent = feature_distance(parts[i].mesh, plans[i].mesh, parts[i].features, context);
    r.feature_hausdorff_percent = std::max(r.feature_hausdorff_percent, percent * plans[i].mesh.diagonal() / diagonal);
  }
}

std::string count_warning(const RemeshReport& report, const RunPlan& run) {
  const std::string numbers = (run.options.is_by_count() ? "asked for " : "edges as long as asked make ") + std::to_string(std::lround(run.wanted)) +
                              " quads, got " + std::to_string(report.quads);
  if (report.fewest_quads > run.wanted)
    return numbers + ": with so many parts, handles and holes there can't be fewer than " + std::to_string(report.fewest_quads);
  return numbers + ": features or small parts need another number";
}

/// Why some edges above the sharp angle are not kept; empty where none had to be sharper than asked.
std::string sharp_angle_warning(const RunPlan& run) {
  const double asked = run.options.sharp_angle;
  std::vector<double> raised;
  for (const ComponentPlan& plan : run.plans)
    if (plan.sharp_angle > asked) raised.push_back(plan.sharp_angle);
  if (raised.empty()) return {};
  const auto degrees = [](double angle) { return std::to_string(std::lround(angle)); };
  const auto [least, most] = std::minmax_element(raised.begin(), raised.end());
  const std::string angles = *least < *most ? degrees(*least) + " to " + degrees(*most) : degrees(*most);
  const std::string where = raised.size() < run.plans.size() ? " on " + std::to_string(raised.size()) + " of " + std::to_string(run.plans.size()) + " parts" : "";
  return "edges had to be sharper than " + angles + " degrees, not " + degrees(asked) + ", to be kept" + where +
         ": up to there they are no clearer than the roughness around them; marks keep them";
}

/// "1 quad", "2 quads"
std::string counted(int count, const std::string& thing) { return std::to_string(count) + " " + thing + (count == 1 ? "" : "s"); }

std::string flawed_warning(const RemeshReport& report, bool gave_up) {
  constexpr std::size_t kNamed = 5;
  const std::vector<int>& faces = report.flawed_faces;
  std::string text =
      counted(report.flawed_quads, "quad") +
      (report.flawed_quads == 1 ? " points against the surface or has no area" : " point against the surface or have no area");
  for (std::size_t i = 0; i < std::min(kNamed, faces.size()); ++i)
    text += (i > 0 ? ", " : faces.size() == 1 ? " (face " : " (faces ") + std::to_string(faces[i]);
  if (!faces.empty()) text += faces.size() > kNamed ? ", ...)" : ")";
  return gave_up ? text + "; more tries would have taken too long" : text;
}

/// Where the quads end short of something thinner than they are long; empty where they don't.
std::string lost_part_warning(const RunPlan& run, const QuadMesh& quads, const RunContext& context) {
  constexpr double kFar = 1.25;  // edges; what merely bends between them is off by less
  const FarthestPlace farthest = farthest_from_quads(surface_of(run), quads, context);
  if (farthest.edges <= kFar) return {};
  const Vector3 place = run.frame.outward(farthest.place);
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), "the surface is up to %.1f edge lengths off the quads, at (%.4g, %.4g, %.4g)", farthest.edges,
                place.x(), place.y(), place.z());
  return std::string(text.data()) + ": what is thinner there than the quads is cut short; more quads, or a higher density there, keep it";
}

/// What was asked and not met, and quads that want a look.
void add_warnings(const RunPlan& run, const std::vector<ComponentResult>& parts, const ShapeQuality& shape,
                  RemeshResult& result) {
  const RemeshReport& report = result.report;
  std::vector<std::string>& warnings = result.report.warnings;
  if (std::abs(report.quads / run.wanted - 1) > kCountTolerance) warnings.push_back(count_warning(report, run));
  if (report.features_given_way > 0)
    warnings.push_back(counted(report.features_given_way, "curve") +
                       " of edges by angle gave way to the number of quads, to others on top of them, or to valid "
                       "quads: more quads, or marks, keep them");
  if (report.marks_given_way > 0)
    warnings.push_back(counted(report.marks_given_way, "curve") +
                       " of marked edges or guides gave way to valid quads: more quads, or fewer marks beside each other, keep them");
  if (const std::string raised = sharp_angle_warning(run); !raised.empty()) warnings.push_back(raised);
  const int lone = run.options.narrow_quads > 1 ? lone_quads(result.mesh) : 0;
  if (lone > 0)
    warnings.push_back(counted(lone, "quad") + (lone == 1 ? " lies" : " lie") +
                       " alone between two features: too narrow there for two rows");
  if (shape.poor > kManyPoor * report.quads)
    warnings.push_back(
        std::to_string(shape.poor) + " of " + std::to_string(report.quads) +
        " quads are narrow, skew or folded (scaled Jacobian below 0.2): there is more detail, or there are more features, than "
        "so many quads can follow; more quads have better shapes");
  if (report.flawed_quads > 0) {
    const bool gave_up = std::any_of(parts.begin(), parts.end(), [](const ComponentResult& part) { return part.gave_up; });
    warnings.push_back(flawed_warning(report, gave_up));
  }
  for (std::string& warning : warnings_of(report.curve_counts)) warnings.push_back(std::move(warning));
  if (run.images > 1)
    for (std::string& warning : symmetry_warnings(run.domain, surface_of(run), result.mesh))
      warnings.push_back(std::move(warning));
}

/// Where the way back rounds, corners are put exactly where the input has them.
void move_outward(const UnitFrame& frame, const PolygonSoup& soup, QuadMesh& mesh) {
  const bool is_exact = frame.centre.isZero(0);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const bool is_input_vertex = mesh.kind[v] == VertexKind::kCorner && mesh.anchor[v] >= 0;
    mesh.positions[v] = is_input_vertex && !is_exact ? soup.positions[mesh.anchor[v]] : frame.outward(mesh.positions[v]);
  }
}

}  // namespace

RepairRecord& RepairRecord::operator+=(const RepairRecord& other) {
  broken_promises += other.broken_promises;
  released_quads += other.released_quads;
  removed_quads += other.removed_quads;
  added_rings += other.added_rings;
  split_polychords += other.split_polychords;
  fitted_rows += other.fitted_rows;
  fitted_quads += other.fitted_quads;
  opened_straight_quads += other.opened_straight_quads;
  mended_places += other.mended_places;
  poor_places += other.poor_places;
  split_sides += other.split_sides;
  refined_places += other.refined_places;
  reached_places += other.reached_places;
  followed_creases += other.followed_creases;
  raised_places += other.raised_places;
  ended_searches += other.ended_searches;
  opened_flat_quads += other.opened_flat_quads;
  split_triangles += other.split_triangles;
  released_tips += other.released_tips;
  restored_quads += other.restored_quads;
  return *this;
}

RemeshResult remesh(const PolygonSoup& soup, const RemeshOptions& scene_options, const RunContext& scene_context) {
  const HelperThreads helpers;
  RemeshResult result;
  RemeshReport& report = result.report;
  StageClock clock;
  RunPlan run = plan_run(soup, scene_options, scene_context, report, clock);
  const std::shared_ptr<const SurfaceIndex> whole = index_of_whole(run);
  std::vector<ComponentResult> parts = remesh_components(run, *whole, clock);
  const GuidedEdges guided = join_components(run, parts, *whole, clock, result);
  report.curve_counts = run.counts.records();
  if (report.flawed_quads > 0 && run.images == 1) {
    report.flawed_faces = flawed_quads(result.mesh, *whole, least_agreement(*whole), run.context.threads);
    report.flawed_quads = std::max(report.flawed_quads, static_cast<int>(report.flawed_faces.size()));
  }
  const ShapeQuality shape = clock.measure("quality", [&] { return shape_quality(result.mesh); });
  add_warnings(run, parts, shape, result);
  clock.measure("quality", [&] {
    report.guides = measure_guides(run.options.strokes, run.guides.traces, result.mesh, guided, report.warnings);
    for (GuideRecord& guide : report.guides) {
      guide.fit.length *= run.frame.scale;
      guide.fit.edge_length *= run.frame.scale;
    }
    record_shapes(shape, report);
    if (std::string lost = lost_part_warning(run, result.mesh, run.context.in_stage("quality", 0.97, 0.97)); !lost.empty())
      report.warnings.push_back(std::move(lost));
    report.edge_loops = edge_loops_of(result.mesh);
    if (run.options.measure_distances) measure_distances(result, run.plans, parts, *whole, run.context.in_stage("quality", 0.97, 1.0));
  });
  move_outward(run.frame, soup, result.mesh);
  require_sound(run.images > 1 ? "symmetry" : "result", violations_of_result(result.mesh));
  report.stages = clock.records;
  return result;
}

}  // namespace hybrid_quad
