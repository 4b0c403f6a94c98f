#include <pybind11/pybind11.h>

#include "bind_check.h"
#include "bind_errors.h"
#include "bind_files.h"
#include "bind_meshes.h"
#include "bind_remesh.h"
#include "bind_subdivide.h"

PYBIND11_MODULE(_native, module) {
  module.doc() = "Compiled core of hybrid_quad; call it through hybrid_quad.remesh, check, preview and subdivide.";
  const hybrid_quad::ErrorTypes errors = hybrid_quad::load_error_types(module);
  hybrid_quad::bind_check(module, errors);
  hybrid_quad::bind_meshes(module);
  hybrid_quad::bind_files(module);
  hybrid_quad::bind_remesh(module, errors);
  hybrid_quad::bind_subdivide(module, errors);
}
