#pragma once

#include <pybind11/pybind11.h>

namespace hybrid_quad {

void bind_files(pybind11::module_& module);

}  // namespace hybrid_quad
