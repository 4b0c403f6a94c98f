#pragma once

#include <pybind11/numpy.h>

#include <vector>

#include "hybrid_quad/base/types.h"
#include "hybrid_quad/mesh/mesh_builder.h"

namespace hybrid_quad {

using DoubleArray = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast>;
using IntArray = pybind11::array_t<int, pybind11::array::c_style | pybind11::array::forcecast>;

/// \param vertices #V by 3  \param face_sizes #F  \param face_vertices sum of face_sizes
/// \throws pybind11::value_error where the shapes do not fit each other
PolygonSoup soup_from_arrays(const DoubleArray& vertices, const IntArray& face_sizes, const IntArray& face_vertices);

/// \param pairs k by 2
std::vector<std::array<int, 2>> pairs_from_array(const IntArray& pairs);

/// \param quads k by 4
std::vector<std::array<int, 4>> quads_from_array(const IntArray& quads);

/// \param vectors k by 3
std::vector<Vector3> vectors_from_array(const DoubleArray& vectors);

/// \param frames k by 2 by 3
std::vector<std::array<Vector3, 2>> frames_from_array(const DoubleArray& frames);

/// \param values one-dimensional
std::vector<double> values_from_array(const DoubleArray& values);

/// n by 3, a copy
pybind11::array_t<double> array_from_points(const std::vector<Vector3>& points);

/// One-dimensional, a copy.
template <typename T>
pybind11::array_t<T> array_from_values(const std::vector<T>& values) {
  return pybind11::array_t<T>(static_cast<pybind11::ssize_t>(values.size()), values.data());
}

/// n by Columns, a copy.
template <std::size_t Columns>
pybind11::array_t<int> array_from_rows(const std::vector<std::array<int, Columns>>& rows) {
  pybind11::array_t<int> result({rows.size(), Columns});
  int* out = result.mutable_data();
  for (const std::array<int, Columns>& row : rows)
    for (const int value : row) *out++ = value;
  return result;
}

}  // namespace hybrid_quad
