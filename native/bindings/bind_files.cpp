#include "bind_files.h"

#include <string_view>

#include "hybrid_quad/mesh/obj_text.h"

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
}

}  // namespace hybrid_quad
