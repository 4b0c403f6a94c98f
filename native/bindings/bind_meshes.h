#pragma once

#include <pybind11/pybind11.h>

namespace hybrid_quad {

/// Registers the meshes that go in and come out, whose arrays are made, and NumPy loaded, only where they are asked for.
void bind_meshes(pybind11::module_& module);

}  // namespace hybrid_quad
