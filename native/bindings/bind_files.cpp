#include "bind_files.h"

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
        return soup;
      },
      py::arg("text"),
      "The PolygonMesh of an OBJ file's bytes; ValueError names a wrong line.");
  module.def(
      "obj_text",
      [](const DoubleArray& vertices, const IntArray& quads) {
        return py::bytes(obj_text(vectors_from_array(vertices), quads_from_array(quads)));
      },
      py::arg("vertices"), py::arg("quads"), "The bytes of an OBJ file of (n, 3) vertices and (m, 4) quads, which parse_obj reads to the same bits.");
}

}  // namespace hybrid_quad
