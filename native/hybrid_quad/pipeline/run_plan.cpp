#include "hybrid_quad/pipeline/run_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hybrid_quad/pipeline/asked_after_repair.h"
#include "hybrid_quad/pipeline/snapshots.h"
#include "hybrid_quad/pipeline/stage_cache.h"
#include "hybrid_quad/sizing/asked_lengths.h"

namespace hybrid_quad {

namespace {

/// Connected components in the order of their first faces.
std::vector<Component> split_components(const TriangleMesh& mesh) {
  std::vector<int> id(mesh.face_count(), -1);
  std::vector<Component> out;
  std::vector<int> local(mesh.vertex_count(), -1), local_face(mesh.face_count(), -1), members;
  for (int seed = 0; seed < mesh.face_count(); ++seed) {
    if (id[seed] >= 0) continue;
    const int component = static_cast<int>(out.size());
    members.assign(1, seed);
    id[seed] = component;
    for (std::size_t i = 0; i < members.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const int o = mesh.opposite(3 * members[i] + k);
        if (o < 0 || id[o / 3] >= 0) continue;
        id[o / 3] = component;
        members.push_back(o / 3);
      }
    std::sort(members.begin(), members.end());
    std::vector<Vector3> positions;
    std::vector<std::array<int, 3>> faces;
    std::vector<int> vertex, opposite;
    for (std::size_t i = 0; i < members.size(); ++i) local_face[members[i]] = static_cast<int>(i);
    for (const int f : members) {
      std::array<int, 3> face = mesh.face(f);
      for (int& v : face) {
        if (local[v] < 0) {
          local[v] = static_cast<int>(vertex.size());
          vertex.push_back(v);
          positions.push_back(mesh.position(v));
        }
        v = local[v];
      }
      faces.push_back(face);
      for (int k = 0; k < 3; ++k) {
        const int o = mesh.opposite(3 * f + k);
        opposite.push_back(o < 0 ? -1 : 3 * local_face[o / 3] + o % 3);
      }
    }
    for (const int v : vertex) local[v] = -1;
    out.push_back({TriangleMesh(std::move(positions), std::move(faces), std::move(opposite)), std::move(vertex), members});
  }
  return out;
}

/// Marked edges of the whole mesh in a component.
MarkedEdges marked_in(const Component& component, const RemeshDomain& domain) {
  MarkedEdges out;
  for (int h = 0; h < component.mesh.halfedge_count(); ++h) {
    const int of_whole = 3 * component.face[h / 3] + h % 3;
    if (component.mesh.opposite(h) >= h || !domain.is_marked[of_whole]) continue;
    out.ends.push_back({component.mesh.from(h), component.mesh.to(h)});
    out.guides.push_back(domain.guides[of_whole]);
  }
  return out;
}

/// The usual edge length where the caller says how long edges are to be, or how far from the surface; 0 where it is the
/// number of quads that counts. \param chords  receives chord_lengths_on() each component
double given_length(const std::vector<Component>& components, const std::vector<MarkedEdges>& marked,
                    const RemeshOptions& options, double extent, std::vector<std::vector<double>>& chords,
                    const RunContext& context) {
  double quads = 0, area = 0;
  for (std::size_t i = 0; i < components.size(); ++i) {
    chords.push_back(chord_lengths_on(components[i].mesh, marked[i].ends, options, extent, context));
    if (chords.back().empty()) continue;
    quads += quads_for_lengths(components[i].mesh, chords.back());
    area += components[i].mesh.total_area();
  }
  return quads > 0 ? std::sqrt(area / quads) : options.edge_length;
}

/// Whether two meshes have the same faces in space, one by one, joined alike.
bool are_same_faces(const TriangleMesh& one, const TriangleMesh& other) {
  if (one.face_count() != other.face_count() || one.opposites() != other.opposites()) return false;
  for (int f = 0; f < one.face_count(); ++f)
    for (int k = 0; k < 3; ++k)
      if (one.position(one.face(f)[k]) != other.position(other.face(f)[k])) return false;
  return true;
}

/// How long the edges of each component are to be.
struct Sizes {
  std::vector<Wishes> wishes;  ///< without directions, which no length depends on
  std::vector<ComponentPlan> plans;
  double wanted = 0;  ///< quads, of the whole
};

/// \param marked, chains  of each component  \param extent  of the whole surface
Sizes sizes_on(const std::vector<Component>& components, const std::vector<MarkedEdges>& marked,
               const std::vector<std::vector<CountedChain>>& chains, const RemeshDomain& domain, double extent, int images,
               const RunContext& context) {
  const RemeshOptions& options = domain.options;
  const double area = domain.mesh.total_area();
  Sizes out;
  std::vector<std::vector<double>> chords;
  const double given = given_length(components, marked, options, extent, chords, context);
  const double even_length = given > 0 ? given : std::sqrt(images * area / std::max(1, options.quads));
  double weighted_area = 0;  // at density 1
  for (std::size_t i = 0; i < components.size(); ++i) {
    const Component& c = components[i];
    out.wishes.push_back(wishes_on(c.mesh, c.vertex, c.face, domain.values, marked[i].ends, options, even_length, chords[i], context));
    weighted_area += area_by_density(c.mesh, out.wishes.back().density);
  }
  const double length = given > 0 ? given : std::sqrt(images * weighted_area / std::max(1, options.quads));
  out.wanted = images * weighted_area / (length * length);
  for (std::size_t i = 0; i < components.size(); ++i)
    out.plans.push_back(plan_component(components[i].mesh, length, marked[i], chains[i], out.wishes[i], options, context));
  if (options.is_by_count()) {
    balance_plans(out.plans, out.wanted / images, context);
    make_room_for_count(out.plans, out.wanted / images, options.symmetry.planes, context);
  }
  for (std::size_t i = 0; i < out.plans.size(); ++i) out.plans[i].part = static_cast<int>(i);
  return out;
}

/// The input's surface in coordinates in which its size and place make no difference, and what is asked of it there.
void move_inward(const UnitFrame& frame, BuiltMesh& built, RemeshOptions& options, RunContext& context) {
  std::vector<Vector3> positions = built.mesh.positions();
  for (Vector3& p : positions) p = frame.inward(p);
  built.mesh = std::move(built.mesh).with_positions(std::move(positions));
  options.edge_length /= frame.scale;
  options.chord_error /= frame.scale;
  for (GuideStroke& stroke : options.strokes)
    for (Vector3& p : stroke.points) p = frame.inward(p);
  if (context.on_snapshot)
    context.on_snapshot = [frame, receive = context.on_snapshot](const Snapshot& s) { receive(in_scene(s, frame)); };
}

}  // namespace

RunPlan plan_run(const PolygonSoup& soup, const RemeshOptions& scene_options, const RunContext& scene_context,
                 RemeshReport& report, StageClock& clock) {
  RemeshOptions options = scene_options;
  RunContext context = scene_context;
  BuiltMesh as_given = clock.measure("mesh", [&] {
    const RunContext mesh_context = context.in_stage("mesh", 0, 0.02);
    mesh_context.checkpoint();
    check_wishes(soup, options);
    check_curve_counts(soup, options.curve_counts);
    return recalled(context.cache, {StageCache::Level::kMesh, "mesh"}, [&] { return build_mesh(soup, mesh_context); });
  });
  options = clock.measure("mesh", [&] { return asked_after_repair(soup, as_given, options, report.warnings); });
  report.defects = as_given.defects;
  report.input_vertices = static_cast<int>(soup.positions.size());
  report.input_faces = static_cast<int>(soup.face_sizes.size());
  if (context.on_snapshot) context.on_snapshot(snapshot_of(as_given.mesh));

  if (options.symmetry.planes != 0 || options.symmetry.detect)
    report.symmetry = clock.measure("symmetry", [&] {
      return settle_symmetry(options.symmetry, as_given.mesh, context.in_stage("symmetry", 0.02, 0.02));
    });
  const UnitFrame frame = unit_frame_of(as_given.mesh.positions(), report.symmetry.planes != 0);
  move_inward(frame, as_given, options, context);
  GuidedInput input = clock.measure("mesh", [&] {
    return with_guides(std::move(as_given), report.input_vertices, options, context.in_stage("mesh", 0.02, 0.02));
  });
  const BuiltMesh& built = input.built;
  report.warnings.insert(report.warnings.end(), input.warnings.begin(), input.warnings.end());
  const int images = image_count(report.symmetry.planes);
  RemeshDomain domain = domain_of(built, input.options, input.edge_guides, report.symmetry.planes);
  report.defects.insert(report.defects.end(), domain.defects.begin(), domain.defects.end());
  HardGuides guides{input.guides.sets, positive_traces(input.guides.traces, report.symmetry.planes)};
  std::vector<Component> components = split_components(domain.mesh);
  report.components = static_cast<int>(images == 1 ? components.size() : split_components(built.mesh).size());
  const double area = domain.mesh.total_area();
  std::vector<MarkedEdges> marked;
  std::vector<std::vector<CountedChain>> chains;
  CurveCountLedger counts(options.curve_counts, soup, frame.scale, images);
  Sizes sizes = clock.measure("features and sizes", [&] {
    const RunContext plan_context = context.in_stage("features and sizes", 0.02, 0.04);
    for (const Component& c : components) {
      marked.push_back(marked_in(c, domain));
      chains.push_back(counts.chains_on(c.mesh, c.face, domain.counted_curve));
    }
    Sizes found = recalled(context.cache, {StageCache::Level::kPlan, "features and sizes"}, [&] {
      return sizes_on(components, marked, chains, domain, built.mesh.extent(), images, plan_context);
    });
    for (std::size_t i = 0; i < components.size(); ++i) {
      const Component& c = components[i];
      add_directions(c.mesh, c.vertex, c.face, domain.values, domain.options, found.wishes[i]);
      if (!found.wishes[i].guides.empty() && !found.wishes[i].index)
        found.wishes[i].index =
            recalled(context.cache, {StageCache::Level::kPlan, "index of component", static_cast<int>(i)},
                     [&] { return std::make_shared<const SurfaceIndex>(c.mesh, std::vector<int>{}, plan_context); });
    }
    return found;
  });
  return {std::move(options), std::move(context), frame, std::move(input), std::move(domain), std::move(guides), images,
          std::move(components), std::move(marked), std::move(sizes.wishes), std::move(sizes.plans), std::move(counts), area,
          sizes.wanted};
}

std::shared_ptr<const SurfaceIndex> index_of_whole(const RunPlan& run) {
  return recalled(run.context.cache, {StageCache::Level::kPlan, "index of whole"}, [&] {
    const TriangleMesh& whole = surface_of(run);
    if (run.plans.size() == 1 && are_same_faces(run.plans[0].mesh, whole))
      return std::make_shared<const SurfaceIndex>(run.plans[0].index->without_regions());
    return std::make_shared<const SurfaceIndex>(whole, std::vector<int>{},
                                                run.context.in_stage("features and sizes", 0.04, 0.04));
  });
}

std::vector<double> shares_of_area(const RunPlan& run) {
  std::vector<double> shares;
  for (const Component& component : run.components) shares.push_back(component.mesh.total_area() / run.area);
  return shares;
}

}  // namespace hybrid_quad
