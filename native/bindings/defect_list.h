#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <vector>

#include "hybrid_quad/mesh/mesh_builder.h"

namespace hybrid_quad {

/// A list of dicts with the fields of Defect; `elements` is a list.
inline pybind11::list list_of_defects(const std::vector<Defect>& defects) {
  namespace py = pybind11;
  py::list result;
  for (const Defect& defect : defects) {
    py::dict row;
    row["code"] = defect.code;
    row["element_kind"] = defect.element_kind;
    row["elements"] = py::cast(defect.elements);
    row["repairable"] = defect.repairable;
    row["kept"] = defect.kept;
    row["remedy"] = defect.remedy;
    result.append(row);
  }
  return result;
}

}  // namespace hybrid_quad
