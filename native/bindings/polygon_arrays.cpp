#include "polygon_arrays.h"

#include <cstdint>

namespace py = pybind11;

namespace hybrid_quad {

PolygonSoup soup_from_arrays(const DoubleArray& vertices, const IntArray& face_sizes, const IntArray& face_vertices) {
  if (vertices.ndim() != 2 || vertices.shape(1) != 3) throw py::value_error("vertices must be an (n, 3) array");
  if (face_sizes.ndim() != 1 || face_vertices.ndim() != 1)
    throw py::value_error("face_sizes and face_vertices must be one-dimensional");
  PolygonSoup soup;
  soup.face_sizes.assign(face_sizes.data(), face_sizes.data() + face_sizes.size());
  soup.face_vertices.assign(face_vertices.data(), face_vertices.data() + face_vertices.size());
  std::int64_t corners = 0;
  for (const int size : soup.face_sizes) {
    if (size < 0) throw py::value_error("face_sizes must not be negative");
    corners += size;
  }
  if (corners != static_cast<std::int64_t>(soup.face_vertices.size()))
    throw py::value_error("face_vertices must be as long as the sum of face_sizes");
  const auto rows = vertices.unchecked<2>();
  soup.positions.reserve(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) soup.positions.emplace_back(rows(i, 0), rows(i, 1), rows(i, 2));
  return soup;
}

std::vector<std::array<int, 2>> pairs_from_array(const IntArray& pairs) {
  if (pairs.ndim() != 2 || pairs.shape(1) != 2) throw py::value_error("edges must be a (k, 2) array");
  const auto rows = pairs.unchecked<2>();
  std::vector<std::array<int, 2>> result;
  result.reserve(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) result.push_back({rows(i, 0), rows(i, 1)});
  return result;
}

std::vector<std::array<int, 4>> quads_from_array(const IntArray& quads) {
  if (quads.ndim() != 2 || quads.shape(1) != 4) throw py::value_error("quads must be a (k, 4) array");
  const auto rows = quads.unchecked<2>();
  std::vector<std::array<int, 4>> result;
  result.reserve(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) result.push_back({rows(i, 0), rows(i, 1), rows(i, 2), rows(i, 3)});
  return result;
}

std::vector<Vector3> vectors_from_array(const DoubleArray& vectors) {
  if (vectors.ndim() != 2 || vectors.shape(1) != 3) throw py::value_error("vectors must be a (k, 3) array");
  const auto rows = vectors.unchecked<2>();
  std::vector<Vector3> result;
  result.reserve(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) result.emplace_back(rows(i, 0), rows(i, 1), rows(i, 2));
  return result;
}

std::vector<std::array<Vector3, 2>> frames_from_array(const DoubleArray& frames) {
  if (frames.ndim() != 3 || frames.shape(1) != 2 || frames.shape(2) != 3)
    throw py::value_error("frames must be a (k, 2, 3) array");
  const auto at = frames.unchecked<3>();
  std::vector<std::array<Vector3, 2>> result(static_cast<std::size_t>(at.shape(0)));
  for (py::ssize_t i = 0; i < at.shape(0); ++i)
    for (py::ssize_t k = 0; k < 2; ++k) result[i][k] = Vector3(at(i, k, 0), at(i, k, 1), at(i, k, 2));
  return result;
}

std::vector<double> values_from_array(const DoubleArray& values) {
  if (values.ndim() != 1) throw py::value_error("values must be one-dimensional");
  return {values.data(), values.data() + values.size()};
}

py::array_t<double> array_from_points(const std::vector<Vector3>& points) {
  py::array_t<double> result({points.size(), std::size_t{3}});
  double* out = result.mutable_data();
  for (const Vector3& point : points)
    for (int k = 0; k < 3; ++k) *out++ = point[k];
  return result;
}

}  // namespace hybrid_quad
