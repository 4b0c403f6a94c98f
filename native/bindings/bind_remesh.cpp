#include "bind_remesh.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <string>

#include "callback_bridge.h"
#include "defect_list.h"
#include "hybrid_quad/pipeline/preview.h"
#include "hybrid_quad/pipeline/process_memory.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "hybrid_quad/pipeline/stage_cache.h"
#include "polygon_arrays.h"
#include "report_dict.h"

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
  module.def("keep_freed_memory", &keep_freed_memory, "Has a process that ends with its run keep the memory that it frees on the way.");
  module.def("resident_memory_mb", &resident_memory_mb, "Resident memory of the process now, in MB of 2^20 bytes.");
  module.def("default_options", &default_options, "Defaults of the core's options, as keyword arguments of remesh.");
  module.def(
      "remesh",
      [errors](const PolygonSoup& soup, int quads,
               double edge_length, std::optional<double> sharp_angle, const std::optional<IntArray>& sharp_edges,
               const std::optional<DoubleArray>& vertex_guides, const std::optional<DoubleArray>& face_guides,
               const std::optional<DoubleArray>& stroke_points, const std::optional<IntArray>& stroke_sizes,
               const std::optional<IntArray>& stroke_rings, const std::optional<DoubleArray>& density,
               const std::optional<DoubleArray>& vertex_frames, const std::optional<DoubleArray>& face_frames,
               const std::vector<std::pair<std::vector<int>, int>>& curve_counts, double field_smoothness,
               double adaptivity, double chord_error, int narrow_quads, double anisotropy, double size_fidelity,
               bool fit_limit_surface, const std::string& symmetry, const std::string& solver, std::uint64_t seed, int threads, double time_limit,
               double memory_limit, bool measure_distances, py::object progress,
               py::object cancel, py::object snapshot, const std::string& stop_after, StageCache* cache,
               const StageCache::Keys& cache_keys) -> py::object {
        RemeshOptions options;
        options.quads = quads;
        options.edge_length = edge_length;
        options.use_sharp_angle = sharp_angle.has_value();
        options.sharp_angle = sharp_angle.value_or(options.sharp_angle);
        if (sharp_edges) options.marked_edges = pairs_from_array(*sharp_edges);
        if (vertex_guides) options.vertex_guides = vectors_from_array(*vertex_guides);
        if (face_guides) options.face_guides = vectors_from_array(*face_guides);
        if (stroke_points && stroke_sizes && stroke_rings) options.strokes = strokes_from_arrays(*stroke_points, *stroke_sizes, *stroke_rings);
        if (density) options.density = values_from_array(*density);
        if (vertex_frames) options.vertex_frames = frames_from_array(*vertex_frames);
        if (face_frames) options.face_frames = frames_from_array(*face_frames);
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
        options.measure_distances = measure_distances;
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
          RemeshResult result = run_without_gil(soup, options, context);
          bridge.rethrow_pending();
          bridge.finish("done");
          return py::cast(std::move(result));
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
      py::arg("mesh"), py::kw_only(), py::arg("quads"),
      py::arg("edge_length"), py::arg("sharp_angle").none(true), py::arg("sharp_edges") = py::none(),
      py::arg("vertex_guides") = py::none(), py::arg("face_guides") = py::none(), py::arg("stroke_points") = py::none(),
      py::arg("stroke_sizes") = py::none(), py::arg("stroke_rings") = py::none(), py::arg("density") = py::none(),
      py::arg("vertex_frames") = py::none(), py::arg("face_frames") = py::none(),
      py::arg("curve_counts") = std::vector<std::pair<std::vector<int>, int>>{}, py::arg("field_smoothness"), py::arg("adaptivity"),
      py::arg("chord_error"), py::arg("narrow_quads"), py::arg("anisotropy"),
      py::arg("size_fidelity"), py::arg("fit_limit_surface"), py::arg("symmetry"), py::arg("solver"),
      py::arg("seed"), py::arg("threads"), py::arg("time_limit"), py::arg("memory_limit"), py::arg("measure_distances") = true, py::arg("progress").none(true) = py::none(),
      py::arg("cancel").none(true) = py::none(), py::arg("snapshot").none(true) = py::none(), py::arg("stop_after") = "", py::arg("cache").none(true) = py::none(),
      py::arg("cache_keys") = StageCache::Keys{},
      "Quad mesh, feature edges and report of one run, as a QuadMesh. With stop_after 'field' or 'quads', as a dict, only what the\n"
      "stages up to there say: frames, singularities, features, and the quads of one try before they are improved. With a cache, which no\n"
      "other run may use at the same time, stages are not done again that go by what its last run went by: `cache_keys` are\n"
      "digests of the surface, of all but directions, and of all.");
}

}  // namespace hybrid_quad
