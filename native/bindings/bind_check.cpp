#include "bind_check.h"

#include <pybind11/numpy.h>

#include <utility>

#include "defect_list.h"
#include "heed_signals.h"
#include "hybrid_quad/mesh/indexed_surface.h"
#include "polygon_arrays.h"

namespace py = pybind11;

namespace hybrid_quad {

void bind_check(py::module_& module, const ErrorTypes& errors) {
  module.def(
      "check",
      [](const DoubleArray& vertices, const IntArray& face_sizes, const IntArray& face_vertices) {
        PolygonSoup given = soup_from_arrays(vertices, face_sizes, face_vertices);
        return list_of_defects(heeding_signals([soup = std::move(given)] { return check_mesh(soup); }));
      },
      py::arg("vertices"), py::arg("face_sizes"), py::arg("face_vertices"), "Defects of a polygon mesh, as dicts.");
  module.def(
      "repair",
      [errors](const DoubleArray& vertices, const IntArray& face_sizes, const IntArray& face_vertices) {
        PolygonSoup given = soup_from_arrays(vertices, face_sizes, face_vertices);
        try {
          const BuiltMesh built = heeding_signals([soup = std::move(given)] { return build_mesh(soup); });
          const IndexedSurface surface = indexed_surface(built);
          py::dict out;
          out["vertices"] = array_from_points(surface.positions);
          out["triangles"] = array_from_rows(surface.triangles);
          out["vertex_origins"] = array_from_values(surface.input_vertex);
          out["face_origins"] = array_from_values(surface.input_face);
          out["defects"] = list_of_defects(built.defects);
          return out;
        } catch (const InputError& error) {
          raise_in_python(errors, error);
        }
      },
      py::arg("vertices"), py::arg("face_sizes"), py::arg("face_vertices"),
      "The triangle mesh that a run works with, what it was made of and what was repaired, as a dict.");
}

}  // namespace hybrid_quad
