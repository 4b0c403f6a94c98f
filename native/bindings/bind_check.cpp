#include "bind_check.h"

#include <pybind11/numpy.h>

#include "defect_list.h"
#include "polygon_arrays.h"

namespace py = pybind11;

namespace hybrid_quad {

void bind_check(py::module_& module) {
  module.def(
      "check",
      [](const DoubleArray& vertices, const IntArray& face_sizes, const IntArray& face_vertices) {
        const PolygonSoup soup = soup_from_arrays(vertices, face_sizes, face_vertices);
        std::vector<Defect> defects;
        {
          const py::gil_scoped_release release;
          defects = check_mesh(soup);
        }
        return list_of_defects(defects);
      },
      py::arg("vertices"), py::arg("face_sizes"), py::arg("face_vertices"), "Defects of a polygon mesh, as dicts.");
}

}  // namespace hybrid_quad
