#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "hybrid_quad/base/errors.h"

namespace hybrid_quad {

/// The Python classes of core/errors.py that stand for the errors of base/errors.h.
struct ErrorTypes {
  pybind11::object input_error;
  pybind11::object cancelled;
  pybind11::object internal_error;
};

/// Looked up beside the module, under whatever name the package was imported: Blender's extensions rename it.
ErrorTypes load_error_types(const pybind11::module_& module);

[[noreturn]] void raise_in_python(const ErrorTypes& types, const InputError& error);
[[noreturn]] void raise_in_python(const ErrorTypes& types, const InternalError& error);
/// \param passed_limit  the reason, where it was a limit: "time_limit" or "memory_limit"
[[noreturn]] void raise_in_python(const ErrorTypes& types, const Cancelled& error, const std::string& passed_limit);

}  // namespace hybrid_quad
