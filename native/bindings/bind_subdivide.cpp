#include "bind_subdivide.h"

#include <pybind11/numpy.h>

#include <utility>

#include "heed_signals.h"
#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/quality/quality.h"
#include "hybrid_quad/subdivision/subdivision.h"
#include "polygon_arrays.h"

namespace py = pybind11;

namespace hybrid_quad {
namespace {

std::vector<int> integers_from_array(const IntArray& values) {
  return {values.data(), values.data() + values.size()};
}

py::dict dict_of_mesh(const SubdividedMesh& mesh) {
  py::dict out;
  out["vertices"] = array_from_points(mesh.positions);
  out["normals"] = array_from_points(mesh.normals);
  out["quads"] = array_from_rows(mesh.quads);
  out["faces"] = array_from_values(mesh.face);
  return out;
}

std::vector<double> distances_to_mesh(const std::vector<Vector3>& points, const PolygonSoup& soup, int threads) {
  RunContext context;
  context.threads = threads;
  const BuiltMesh built = build_mesh(soup, context);
  return point_distances(points, SurfaceIndex(built.mesh, {}), context);
}

}  // namespace

void bind_subdivide(py::module_& module, const ErrorTypes& errors) {
  module.def(
      "subdivide",
      [errors](const DoubleArray& vertices, const IntArray& face_sizes, const IntArray& face_vertices, int levels, bool limit,
               bool keep_corners, const IntArray& crease_edges, const DoubleArray& crease_sharpness,
               const IntArray& sharp_vertices, const DoubleArray& vertex_sharpness) {
        PolygonSoup given = soup_from_arrays(vertices, face_sizes, face_vertices);
        SubdivisionOptions options;
        options.levels = levels;
        options.limit = limit;
        options.keep_corners = keep_corners;
        options.crease_edges = pairs_from_array(crease_edges);
        options.crease_sharpness = values_from_array(crease_sharpness);
        options.sharp_vertices = integers_from_array(sharp_vertices);
        options.vertex_sharpness = values_from_array(vertex_sharpness);
        try {
          return dict_of_mesh(
              heeding_signals([soup = std::move(given), options = std::move(options)] { return subdivide(soup, options, RunContext{}); }));
        } catch (const InputError& error) {
          raise_in_python(errors, error);
        } catch (const InternalError& error) {
          raise_in_python(errors, error);
        }
      },
      py::arg("vertices"), py::arg("face_sizes"), py::arg("face_vertices"), py::kw_only(), py::arg("levels"),
      py::arg("limit"), py::arg("keep_corners"), py::arg("crease_edges"), py::arg("crease_sharpness"),
      py::arg("sharp_vertices"), py::arg("vertex_sharpness"), "A Catmull-Clark subdivision surface, as a dict.");
  module.def(
      "distances",
      [errors](const DoubleArray& points, const DoubleArray& vertices, const IntArray& face_sizes,
               const IntArray& face_vertices, int threads) {
        std::vector<Vector3> places = vectors_from_array(points);
        PolygonSoup given = soup_from_arrays(vertices, face_sizes, face_vertices);
        try {
          return array_from_values(heeding_signals(
              [own = std::move(places), soup = std::move(given), threads] { return distances_to_mesh(own, soup, threads); }));
        } catch (const InputError& error) {
          raise_in_python(errors, error);
        }
      },
      py::arg("points"), py::arg("vertices"), py::arg("face_sizes"), py::arg("face_vertices"), py::kw_only(),
      py::arg("threads"), "How far each point is from a surface.");
}

}  // namespace hybrid_quad
