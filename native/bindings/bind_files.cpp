#include "bind_files.h"

#include <pybind11/numpy.h>

#include <string_view>

#include "hybrid_quad/mesh/obj_text.h"
#include "polygon_arrays.h"

namespace py = pybind11;

namespace hybrid_quad {

void bind_files(py::module_& module) {
  module.def(
      "parse_obj",
      [](const py::bytes& text) {
        const std::string_view view = text;
        PolygonSoup soup;
        {
          const py::gil_scoped_release release;
          soup = parse_obj(view);
        }
        return py::make_tuple(array_from_points(soup.positions), array_from_values(soup.face_sizes),
                              array_from_values(soup.face_vertices));
      },
      py::arg("text"),
      "Vertices (n, 3), corners of each face and 0-based vertices of these corners of an OBJ file's bytes; ValueError names a wrong line.");
}

}  // namespace hybrid_quad
