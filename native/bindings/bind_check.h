#pragma once

#include <pybind11/pybind11.h>

#include "bind_errors.h"

namespace hybrid_quad {

void bind_check(pybind11::module_& module, const ErrorTypes& errors);

}  // namespace hybrid_quad
