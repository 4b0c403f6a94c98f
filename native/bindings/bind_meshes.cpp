#include "bind_meshes.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "hybrid_quad/mesh/obj_text.h"
#include "hybrid_quad/mesh/quad_mesh.h"
#include "hybrid_quad/pipeline/remesh.h"
#include "polygon_arrays.h"
#include "report_dict.h"

namespace py = pybind11;

namespace hybrid_quad {
namespace {

py::array_t<int> feature_edges_of(const QuadMesh& mesh) {
  std::vector<std::array<int, 2>> edges;
  for (const QuadMesh::FeatureEdge& edge : mesh.feature_edges) edges.push_back({edge.a, edge.b});
  return array_from_rows(edges);
}

py::array_t<int> feature_curves_of(const QuadMesh& mesh) {
  std::vector<int> curves;
  for (const QuadMesh::FeatureEdge& edge : mesh.feature_edges) curves.push_back(edge.curve);
  return array_from_values(curves);
}

py::array_t<std::uint8_t> kinds_of(const QuadMesh& mesh) {
  std::vector<std::uint8_t> kinds;
  kinds.reserve(mesh.kind.size());
  for (const VertexKind kind : mesh.kind) kinds.push_back(static_cast<std::uint8_t>(kind));
  return array_from_values(kinds);
}

}  // namespace

void bind_meshes(py::module_& module) {
  py::class_<PolygonSoup>(module, "PolygonMesh", "Polygons of any size.")
      .def(py::init(&soup_from_arrays), py::arg("vertices"), py::arg("face_sizes"), py::arg("face_vertices"))
      .def_property_readonly("vertices", [](const PolygonSoup& soup) { return array_from_points(soup.positions); }, "(n, 3) float64, a copy.")
      .def_property_readonly("face_sizes", [](const PolygonSoup& soup) { return array_from_values(soup.face_sizes); }, "(m,) int32, a copy.")
      .def_property_readonly(
          "face_vertices", [](const PolygonSoup& soup) { return array_from_values(soup.face_vertices); }, "0-based, of all corners: int32, a copy.");
  py::class_<RemeshResult>(module, "QuadMesh", "What a run gave: quads and a report.")
      .def_property_readonly("vertices", [](const RemeshResult& result) { return array_from_points(result.mesh.positions); }, "(n, 3) float64, a copy.")
      .def_property_readonly("quads", [](const RemeshResult& result) { return array_from_rows(result.mesh.quads); }, "(m, 4) int32, a copy.")
      .def_property_readonly("feature_edges", [](const RemeshResult& result) { return feature_edges_of(result.mesh); }, "(k, 2) int32.")
      .def_property_readonly("feature_curves", [](const RemeshResult& result) { return feature_curves_of(result.mesh); }, "(k,) int32.")
      .def_property_readonly("vertex_kinds", [](const RemeshResult& result) { return kinds_of(result.mesh); }, "(n,) uint8.")
      .def("obj_text", [](const RemeshResult& result) { return py::bytes(obj_text(result.mesh.positions, result.mesh.quads)); }, "The bytes of an OBJ file.")
      .def_property_readonly("report", [](const RemeshResult& result) { return dict_of_report(result.report); }, "Counts, quality, timings and warnings.")
      .def("__len__", [](const RemeshResult& result) { return result.mesh.quads.size(); })
      .def("violations", [](const RemeshResult& result) { return violations_of_result(result.mesh); }, "What keeps it from being a valid pure-quad mesh, in sentences.");
}

}  // namespace hybrid_quad
