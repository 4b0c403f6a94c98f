#include "bind_remesh.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <string>

#include "callback_bridge.h"
#include "defect_list.h"
#include "hybrid_quad/pipeline/preview.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/pipeline/stage_cache.h"
#include "polygon_arrays.h"

namespace py = pybind11;

namespace hybrid_quad {
namespace {

PeriodicSolver solver_named(const std::string& name) {
  if (name == "multilevel") return PeriodicSolver::kMultilevel;
  if (name == "eigen") return PeriodicSolver::kEigenGaussNewton;
  throw py::value_error("solver must be 'multilevel' or 'eigen'");
}

/// \param planes  letters of x, y and z; "auto" for those about which the surface is symmetric
SymmetryOptions symmetry_named(const std::string& planes) {
  SymmetryOptions options;
  if (planes == "auto") {
    options.detect = true;
    return options;
  }
  for (const char letter : planes) {
    if (letter < 'x' || letter > 'z') throw py::value_error("symmetry must be 'auto' or letters of x, y and z");
    options.planes |= plane(letter - 'x');
  }
  return options;
}

/// {"planes": "xz", "deviation_percent": {"x": {"max", "mean"}, ...}}; no deviation where no symmetry was asked for.
py::dict dict_of_symmetry(const SymmetryRecord& record) {
  std::string planes;
  py::dict deviation;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string letter(1, "xyz"[axis]);
    if (has_plane(record.planes, axis)) planes += letter;
    if (!record.is_measured) continue;
    py::dict of_plane;
    of_plane["max"] = record.deviation[axis].largest;
    of_plane["mean"] = record.deviation[axis].mean;
    deviation[letter.c_str()] = of_plane;
  }
  py::dict result;
  result["planes"] = planes;
  result["deviation_percent"] = deviation;
  return result;
}

/// [{"asked", "got", "reason"}, ...]
py::list list_of_counts(const std::vector<CurveCountRecord>& records) {
  py::list result;
  for (const CurveCountRecord& record : records) {
    py::dict row;
    row["asked"] = record.asked;
    row["got"] = record.got;
    row["reason"] = record.reason;
    result.append(row);
  }
  return result;
}

py::dict dict_of_patches(const PatchRecord& patches) {
  py::dict result;
  result["count"] = patches.count;
  result["morse_smale"] = patches.morse_smale;
  result["combinatorial"] = patches.combinatorial;
  result["combinatorial_area_fraction"] = patches.combinatorial_area_fraction;
  return result;
}

py::list list_of_guides(const std::vector<GuideRecord>& guides) {
  py::list result;
  for (const GuideRecord& guide : guides) {
    py::dict row;
    row["kind"] = guide.kind == GuideKind::kRing ? "ring" : "loop";
    row["met"] = guide.is_met;
    row["length"] = guide.fit.length;
    row["edges"] = guide.fit.edges;
    row["edge_length"] = guide.fit.edge_length;
    row["distance"] = guide.fit.distance;
    row["angle"] = guide.fit.angle;
    row["connected"] = guide.fit.is_connected;
    result.append(row);
  }
  return result;
}

py::dict dict_of_repairs(const RepairRecord& repairs) {
  py::dict result;
  result["broken_promises"] = repairs.broken_promises;
  result["released_quads"] = repairs.released_quads;
  result["removed_quads"] = repairs.removed_quads;
  result["added_rings"] = repairs.added_rings;
  result["split_polychords"] = repairs.split_polychords;
  result["fitted_rows"] = repairs.fitted_rows;
  result["fitted_quads"] = repairs.fitted_quads;
  result["opened_straight_quads"] = repairs.opened_straight_quads;
  result["mended_places"] = repairs.mended_places;
  result["poor_places"] = repairs.poor_places;
  result["split_sides"] = repairs.split_sides;
  result["refined_places"] = repairs.refined_places;
  result["reached_places"] = repairs.reached_places;
  result["raised_places"] = repairs.raised_places;
  result["opened_flat_quads"] = repairs.opened_flat_quads;
  result["restored_quads"] = repairs.restored_quads;
  return result;
}

py::list list_of_stages(const std::vector<StageRecord>& stages) {
  py::list result;
  for (const StageRecord& stage : stages) {
    py::dict row;
    row["name"] = stage.name;
    row["seconds"] = stage.seconds;
    row["peak_mb"] = stage.peak_mb;
    result.append(row);
  }
  return result;
}

py::dict dict_of_loops(const EdgeLoopSummary& loops) {
  py::dict out;
  out["closed"] = loops.closed;
  out["open"] = loops.open;
  out["longest"] = loops.longest;
  out["median_length"] = loops.median_length;
  out["self_crossing"] = loops.self_crossing;
  out["spirals"] = loops.spirals;
  out["longest_spiral"] = loops.longest_spiral;
  return out;
}

py::object dict_of_limit_fit(const LimitFitRecord& fit) {
  if (!fit.is_fitted) return py::none();
  const auto distance = [](const DirectedDistance& d) {
    py::dict out;
    out["mean"] = d.mean;
    out["max"] = d.largest;
    return out;
  };
  py::dict out;
  out["before"] = distance(fit.before);
  out["after"] = distance(fit.after);
  out["held_back"] = fit.held_back;
  return out;
}

py::dict dict_of_field(const FieldRecord& field) {
  const auto solution = [](int quarters, int kept) {
    py::dict out;
    out["singularities"] = quarters;
    out["kept"] = kept;
    return out;
  };
  py::dict out;
  out["relaxed"] = solution(field.relaxed_quarters, field.relaxed_kept);
  out["smoothest"] = solution(field.smoothest_quarters, field.smoothest_kept);
  return out;
}

py::dict dict_of_report(const RemeshReport& report) {
  py::dict jacobian;
  jacobian["mean"] = report.scaled_jacobian_mean;
  jacobian["p1"] = report.scaled_jacobian_p1;
  jacobian["min"] = report.scaled_jacobian_min;
  py::dict result;
  result["input_vertices"] = report.input_vertices;
  result["input_faces"] = report.input_faces;
  result["working_faces"] = report.working_faces;
  result["components"] = report.components;
  result["quads"] = report.quads;
  result["fewest_quads"] = report.fewest_quads;
  result["vertices"] = report.vertices;
  result["irregular_vertices"] = report.irregular_vertices;
  result["field_singularities"] = report.field_singularities;
  result["feature_singularities"] = report.feature_singularities;
  result["field_solutions"] = dict_of_field(report.field);
  result["dislocations"] = report.dislocations;
  result["dislocations_found"] = report.dislocations_found;
  result["singular_area_fraction"] = report.singular_area_fraction;
  result["patches"] = dict_of_patches(report.patches);
  result["repairs"] = dict_of_repairs(report.repairs);
  result["symmetry"] = dict_of_symmetry(report.symmetry);
  result["curve_counts"] = list_of_counts(report.curve_counts);
  result["guides"] = list_of_guides(report.guides);
  result["features_given_way"] = report.features_given_way;
  result["sharp_angle_used"] = report.sharp_angle_used > 0 ? py::object(py::float_(report.sharp_angle_used)) : py::none();
  result["flawed_quads"] = report.flawed_quads;
  result["extra_passes"] = report.extra_passes;
  result["edge_loops"] = dict_of_loops(report.edge_loops);
  result["scaled_jacobian"] = jacobian;
  result["hausdorff_percent"] = report.hausdorff_percent;
  result["mean_distance_percent"] = report.mean_distance_percent;
  result["feature_hausdorff_percent"] = report.feature_hausdorff_percent;
  result["limit_distance_percent"] = dict_of_limit_fit(report.limit_fit);
  result["stages"] = list_of_stages(report.stages);
  result["warnings"] = report.warnings;
  result["defects"] = list_of_defects(report.defects);
  return result;
}

py::dict dict_of_result(const RemeshResult& result) {
  const QuadMesh& mesh = result.mesh;
  std::vector<std::array<int, 2>> edges;
  std::vector<int> curves;
  for (const QuadMesh::FeatureEdge& edge : mesh.feature_edges) {
    edges.push_back({edge.a, edge.b});
    curves.push_back(edge.curve);
  }
  std::vector<std::uint8_t> kinds;
  kinds.reserve(mesh.kind.size());
  for (const VertexKind kind : mesh.kind) kinds.push_back(static_cast<std::uint8_t>(kind));
  py::dict out;
  out["vertices"] = array_from_points(mesh.positions);
  out["quads"] = array_from_rows(mesh.quads);
  out["feature_edges"] = array_from_rows(edges);
  out["feature_curves"] = array_from_values(curves);
  out["vertex_kinds"] = array_from_values(kinds);
  out["report"] = dict_of_report(result.report);
  return out;
}

py::dict dict_of_preview(const Preview& found) {
  py::array_t<double> lines({static_cast<py::ssize_t>(found.feature_lines.size()), py::ssize_t{2}, py::ssize_t{3}});
  double* out_line = lines.mutable_data();
  for (const std::array<Vector3, 2>& line : found.feature_lines)
    for (const Vector3& end : line) out_line = std::copy(end.data(), end.data() + 3, out_line);
  py::dict out;
  out["points"] = array_from_points(found.points);
  out["normals"] = array_from_points(found.normals);
  out["u"] = array_from_points(found.u);
  out["v"] = array_from_points(found.v);
  out["spread"] = array_from_values(found.spread);
  out["singular_points"] = array_from_points(found.singular_points);
  out["singular_quarters"] = array_from_values(found.singular_quarters);
  out["feature_lines"] = lines;
  out["quad_vertices"] = array_from_points(found.quads.positions);
  out["quads"] = array_from_rows(found.quads.quads);
  out["wanted_quads"] = found.wanted;
  out["warnings"] = found.warnings;
  out["defects"] = list_of_defects(found.defects);
  out["stages"] = list_of_stages(found.stages);
  return out;
}

enum class StopAfter { kNothing, kField, kQuads };

StopAfter stop_named(const std::string& stage) {
  if (stage.empty()) return StopAfter::kNothing;
  if (stage == "field") return StopAfter::kField;
  if (stage == "quads") return StopAfter::kQuads;
  throw py::value_error("stop_after must be '', 'field' or 'quads'");
}

/// What the core assumes where a caller says nothing; the Python options must say the same.
py::dict default_options() {
  const RemeshOptions options;
  py::dict result;
  result["quads"] = options.quads;
  result["edge_length"] = options.edge_length;
  result["sharp_angle"] = options.use_sharp_angle ? py::object(py::float_(options.sharp_angle)) : py::none();
  result["field_smoothness"] = options.field_smoothness;
  result["adaptivity"] = options.adaptivity;
  result["chord_error"] = options.chord_error;
  result["narrow_quads"] = options.narrow_quads;
  result["anisotropy"] = options.anisotropy;
  result["size_fidelity"] = options.size_fidelity;
  result["fit_limit_surface"] = options.fit_limit_surface;
  result["solver"] = options.solver == PeriodicSolver::kMultilevel ? "multilevel" : "eigen";
  result["seed"] = RunContext{}.seed;
  return result;
}

/// \param points  of all strokes, one after the other  \param sizes  points of each  \param rings  of each: a ring, or a loop
std::vector<GuideStroke> strokes_from_arrays(const DoubleArray& points, const IntArray& sizes, const IntArray& rings) {
  const std::vector<Vector3> all = vectors_from_array(points);
  if (sizes.ndim() != 1 || rings.ndim() != 1 || sizes.size() != rings.size())
    throw py::value_error("strokes need a size and a kind each");
  std::vector<GuideStroke> strokes;
  std::size_t begin = 0;
  for (py::ssize_t i = 0; i < sizes.size(); ++i) {
    const std::size_t end = begin + static_cast<std::size_t>(std::max(0, sizes.data()[i]));
    if (end > all.size()) throw py::value_error("strokes have too few points");
    GuideStroke stroke;
    stroke.points.assign(all.begin() + static_cast<std::ptrdiff_t>(begin), all.begin() + static_cast<std::ptrdiff_t>(end));
    stroke.kind = rings.data()[i] != 0 ? GuideKind::kRing : GuideKind::kLoop;
    strokes.push_back(std::move(stroke));
    begin = end;
  }
  return strokes;
}

RemeshResult run_without_gil(const PolygonSoup& soup, const RemeshOptions& options, const RunContext& context) {
  const py::gil_scoped_release release;
  return remesh(soup, options, context);
}

Preview preview_without_gil(const PolygonSoup& soup, const RemeshOptions& options, bool with_quads, const RunContext& context) {
  const py::gil_scoped_release release;
  return preview(soup, options, with_quads, context);
}

}  // namespace

void bind_remesh(py::module_& module, const ErrorTypes& errors) {
  py::class_<StageCache>(module, "StageCache", "What the first stages of a caller's latest run gave.")
      .def(py::init<>())
      .def_property_readonly("recalled", &StageCache::recalled, "Names of the stages of the latest run that were known.");
  module.def("default_options", &default_options, "Defaults of the core's options, as keyword arguments of remesh.");
  module.def(
      "remesh",
      [errors](const DoubleArray& vertices, const IntArray& face_sizes, const IntArray& face_vertices, int quads,
               double edge_length, std::optional<double> sharp_angle, const IntArray& sharp_edges,
               const DoubleArray& vertex_guides, const DoubleArray& face_guides, const DoubleArray& stroke_points,
               const IntArray& stroke_sizes, const IntArray& stroke_rings, const DoubleArray& density,
               const DoubleArray& vertex_frames, const DoubleArray& face_frames,
               const std::vector<std::pair<std::vector<int>, int>>& curve_counts, double field_smoothness,
               double adaptivity, double chord_error, int narrow_quads, double anisotropy, double size_fidelity,
               bool fit_limit_surface, const std::string& symmetry, const std::string& solver, std::uint64_t seed, int threads, double time_limit,
               double memory_limit, py::object progress,
               py::object cancel, py::object snapshot, const std::string& stop_after, StageCache* cache,
               const StageCache::Keys& cache_keys) {
        const PolygonSoup soup = soup_from_arrays(vertices, face_sizes, face_vertices);
        RemeshOptions options;
        options.quads = quads;
        options.edge_length = edge_length;
        options.use_sharp_angle = sharp_angle.has_value();
        options.sharp_angle = sharp_angle.value_or(options.sharp_angle);
        options.marked_edges = pairs_from_array(sharp_edges);
        options.vertex_guides = vectors_from_array(vertex_guides);
        options.face_guides = vectors_from_array(face_guides);
        options.strokes = strokes_from_arrays(stroke_points, stroke_sizes, stroke_rings);
        options.density = values_from_array(density);
        options.vertex_frames = frames_from_array(vertex_frames);
        options.face_frames = frames_from_array(face_frames);
        for (const auto& [path, count] : curve_counts) options.curve_counts.push_back({path, count});
        options.field_smoothness = field_smoothness;
        options.adaptivity = adaptivity;
        options.chord_error = chord_error;
        options.narrow_quads = narrow_quads;
        options.anisotropy = anisotropy;
        options.size_fidelity = size_fidelity;
        options.fit_limit_surface = fit_limit_surface;
        options.symmetry = symmetry_named(symmetry);
        options.solver = solver_named(solver);
        const StopAfter stop = stop_named(stop_after);
        if (cache != nullptr) cache->begin(cache_keys);
        CallbackBridge bridge(std::move(progress), std::move(cancel), std::move(snapshot), {time_limit, memory_limit});
        RunContext context = bridge.context(seed, threads);
        context.cache = cache;
        try {
          if (stop != StopAfter::kNothing) {
            const Preview found = preview_without_gil(soup, options, stop == StopAfter::kQuads, context);
            bridge.rethrow_pending();
            bridge.finish("done");
            return dict_of_preview(found);
          }
          const RemeshResult result = run_without_gil(soup, options, context);
          bridge.rethrow_pending();
          bridge.finish("done");
          return dict_of_result(result);
        } catch (const InputError& error) {
          bridge.rethrow_pending();
          raise_in_python(errors, error);
        } catch (const InternalError& error) {
          bridge.rethrow_pending();
          raise_in_python(errors, error);
        } catch (const Cancelled& error) {
          bridge.rethrow_pending();
          raise_in_python(errors, error, bridge.passed_limit());
        }
      },
      py::arg("vertices"), py::arg("face_sizes"), py::arg("face_vertices"), py::kw_only(), py::arg("quads"),
      py::arg("edge_length"), py::arg("sharp_angle").none(true), py::arg("sharp_edges"),
      py::arg("vertex_guides"), py::arg("face_guides"), py::arg("stroke_points"), py::arg("stroke_sizes"),
      py::arg("stroke_rings"), py::arg("density"), py::arg("vertex_frames"),
      py::arg("face_frames"), py::arg("curve_counts"), py::arg("field_smoothness"), py::arg("adaptivity"),
      py::arg("chord_error"), py::arg("narrow_quads"), py::arg("anisotropy"),
      py::arg("size_fidelity"), py::arg("fit_limit_surface"), py::arg("symmetry"), py::arg("solver"),
      py::arg("seed"), py::arg("threads"), py::arg("time_limit"), py::arg("memory_limit"), py::arg("progress").none(true),
      py::arg("cancel").none(true), py::arg("snapshot").none(true), py::arg("stop_after") = "", py::arg("cache").none(true) = py::none(),
      py::arg("cache_keys") = StageCache::Keys{},
      "Quad mesh, feature edges and report of one run, as a dict. With stop_after 'field' or 'quads' only what the stages up to\n"
      "there say: frames, singularities, features, and the quads of one try before they are improved. With a cache, which no\n"
      "other run may use at the same time, stages are not done again that go by what its last run went by: `cache_keys` are\n"
      "digests of the surface, of all but directions, and of all.");
}

}  // namespace hybrid_quad
