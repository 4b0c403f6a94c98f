#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace hybrid_quad {

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;

/// A point of the integer grid's plane in fixed point: one unit of the grid (a quad edge) is kGridUnit.
using GridVector = std::array<std::int64_t, 2>;
inline constexpr std::int64_t kGridUnit = std::int64_t{1} << 20;

}  // namespace hybrid_quad
