#include "bind_errors.h"

#include <pybind11/stl.h>

#include <string>

namespace py = pybind11;

namespace hybrid_quad {
namespace {

[[noreturn]] void raise_instance(const py::object& type, const py::object& instance) {
  PyErr_SetObject(type.ptr(), instance.ptr());
  throw py::error_already_set();
}

}  // namespace

ErrorTypes load_error_types(const py::module_& module) {
  const std::string name = py::cast<std::string>(module.attr("__name__"));
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos) throw py::import_error("the compiled module works only inside the package hybrid_quad");
  const py::module_ errors = py::module_::import((name.substr(0, dot) + ".core.errors").c_str());
  return {errors.attr("InputError"), errors.attr("Cancelled"), errors.attr("InternalError")};
}

void raise_in_python(const ErrorTypes& types, const InputError& error) {
  raise_instance(types.input_error, types.input_error(error.code, error.what(), error.element_kind, error.elements));
}

void raise_in_python(const ErrorTypes& types, const InternalError& error) {
  raise_instance(types.internal_error, types.internal_error(error.what(), error.stage));
}

void raise_in_python(const ErrorTypes& types, const Cancelled& error, const std::string& passed_limit) {
  std::string message = error.what();
  if (passed_limit == "time_limit") message += " (the time limit passed)";
  if (passed_limit == "memory_limit") message += " (the memory limit is reached)";
  raise_instance(types.cancelled, types.cancelled(message, passed_limit.empty() ? "cancelled" : passed_limit));
}

}  // namespace hybrid_quad
