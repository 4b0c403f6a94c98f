#include "report_dict.h"

#include <pybind11/stl.h>

#include <string>

#include "defect_list.h"

namespace py = pybind11;

namespace hybrid_quad {
namespace {

/// {"planes": "xz", "deviation_percent": {"x": {"max", "mean"}, ...}}; no deviation where no symmetry was asked for.
py::dict dict_of_symmetry(const SymmetryRecord& record) {
  std::string planes;
  py::dict deviation;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string letter(1, "xyz"[axis]);
    if (has_plane(record.planes, axis)) planes += letter;
    if (!record.is_measured) continue;
    py::dict of_plane;
    of_plane["max"] = record.deviation[axis].largest;
    of_plane["mean"] = record.deviation[axis].mean;
    deviation[letter.c_str()] = of_plane;
  }
  py::dict result;
  result["planes"] = planes;
  result["deviation_percent"] = deviation;
  return result;
}

/// [{"asked", "got", "reason"}, ...]
py::list list_of_counts(const std::vector<CurveCountRecord>& records) {
  py::list result;
  for (const CurveCountRecord& record : records) {
    py::dict row;
    row["asked"] = record.asked;
    row["got"] = record.got;
    row["reason"] = record.reason;
    result.append(row);
  }
  return result;
}

py::dict dict_of_patches(const PatchRecord& patches) {
  py::dict result;
  result["count"] = patches.count;
  result["morse_smale"] = patches.morse_smale;
  result["combinatorial"] = patches.combinatorial;
  result["combinatorial_area_fraction"] = patches.combinatorial_area_fraction;
  return result;
}

py::list list_of_guides(const std::vector<GuideRecord>& guides) {
  py::list result;
  for (const GuideRecord& guide : guides) {
    py::dict row;
    row["kind"] = guide.kind == GuideKind::kRing ? "ring" : "loop";
    row["met"] = guide.is_met;
    row["length"] = guide.fit.length;
    row["edges"] = guide.fit.edges;
    row["edge_length"] = guide.fit.edge_length;
    row["distance"] = guide.fit.distance;
    row["angle"] = guide.fit.angle;
    row["connected"] = guide.fit.is_connected;
    result.append(row);
  }
  return result;
}

py::dict dict_of_repairs(const RepairRecord& repairs) {
  py::dict result;
  result["broken_promises"] = repairs.broken_promises;
  result["released_quads"] = repairs.released_quads;
  result["removed_quads"] = repairs.removed_quads;
  result["added_rings"] = repairs.added_rings;
  result["split_polychords"] = repairs.split_polychords;
  result["fitted_rows"] = repairs.fitted_rows;
  result["fitted_quads"] = repairs.fitted_quads;
  result["opened_straight_quads"] = repairs.opened_straight_quads;
  result["mended_places"] = repairs.mended_places;
  result["poor_places"] = repairs.poor_places;
  result["split_sides"] = repairs.split_sides;
  result["refined_places"] = repairs.refined_places;
  result["reached_places"] = repairs.reached_places;
  result["followed_creases"] = repairs.followed_creases;
  result["raised_places"] = repairs.raised_places;
  result["ended_searches"] = repairs.ended_searches;
  result["opened_flat_quads"] = repairs.opened_flat_quads;
  result["split_triangles"] = repairs.split_triangles;
  result["released_tips"] = repairs.released_tips;
  result["restored_quads"] = repairs.restored_quads;
  return result;
}

py::dict dict_of_loops(const EdgeLoopSummary& loops) {
  py::dict out;
  out["closed"] = loops.closed;
  out["open"] = loops.open;
  out["longest"] = loops.longest;
  out["median_length"] = loops.median_length;
  out["self_crossing"] = loops.self_crossing;
  out["spirals"] = loops.spirals;
  out["longest_spiral"] = loops.longest_spiral;
  return out;
}

py::object dict_of_limit_fit(const LimitFitRecord& fit) {
  if (!fit.is_fitted) return py::none();
  const auto distance = [](const DirectedDistance& d) {
    py::dict out;
    out["mean"] = d.mean;
    out["max"] = d.largest;
    return out;
  };
  py::dict out;
  out["before"] = distance(fit.before);
  out["after"] = distance(fit.after);
  out["held_back"] = fit.held_back;
  return out;
}

py::dict dict_of_field(const FieldRecord& field) {
  const auto solution = [](int quarters, int kept) {
    py::dict out;
    out["singularities"] = quarters;
    out["kept"] = kept;
    return out;
  };
  py::dict out;
  out["relaxed"] = solution(field.relaxed_quarters, field.relaxed_kept);
  out["smoothest"] = solution(field.smoothest_quarters, field.smoothest_kept);
  return out;
}

}  // namespace

py::list list_of_stages(const std::vector<StageRecord>& stages) {
  py::list result;
  for (const StageRecord& stage : stages) {
    py::dict row;
    row["name"] = stage.name;
    row["seconds"] = stage.seconds;
    row["peak_mb"] = stage.peak_mb;
    result.append(row);
  }
  return result;
}

py::dict dict_of_report(const RemeshReport& report) {
  py::dict jacobian;
  jacobian["mean"] = report.scaled_jacobian_mean;
  jacobian["p1"] = report.scaled_jacobian_p1;
  jacobian["min"] = report.scaled_jacobian_min;
  py::dict result;
  result["input_vertices"] = report.input_vertices;
  result["input_faces"] = report.input_faces;
  result["working_faces"] = report.working_faces;
  result["components"] = report.components;
  result["quads"] = report.quads;
  result["fewest_quads"] = report.fewest_quads;
  result["vertices"] = report.vertices;
  result["irregular_vertices"] = report.irregular_vertices;
  result["field_singularities"] = report.field_singularities;
  result["feature_singularities"] = report.feature_singularities;
  result["field_solutions"] = dict_of_field(report.field);
  result["dislocations"] = report.dislocations;
  result["dislocations_found"] = report.dislocations_found;
  result["singular_area_fraction"] = report.singular_area_fraction;
  result["patches"] = dict_of_patches(report.patches);
  result["repairs"] = dict_of_repairs(report.repairs);
  result["symmetry"] = dict_of_symmetry(report.symmetry);
  result["curve_counts"] = list_of_counts(report.curve_counts);
  result["guides"] = list_of_guides(report.guides);
  result["features_given_way"] = report.features_given_way;
  result["marks_given_way"] = report.marks_given_way;
  result["sharp_angle_used"] = report.sharp_angle_used > 0 ? py::object(py::float_(report.sharp_angle_used)) : py::none();
  result["flawed_quads"] = report.flawed_quads;
  result["flawed_faces"] = report.flawed_faces;
  result["extra_passes"] = report.extra_passes;
  result["edge_loops"] = dict_of_loops(report.edge_loops);
  result["scaled_jacobian"] = jacobian;
  const auto measured = [&](double percent) { return report.are_distances_measured ? py::object(py::float_(percent)) : py::none(); };
  result["hausdorff_percent"] = measured(report.hausdorff_percent);
  result["mean_distance_percent"] = measured(report.mean_distance_percent);
  result["feature_hausdorff_percent"] = measured(report.feature_hausdorff_percent);
  result["limit_distance_percent"] = dict_of_limit_fit(report.limit_fit);
  result["stages"] = list_of_stages(report.stages);
  result["warnings"] = report.warnings;
  result["defects"] = list_of_defects(report.defects);
  return result;
}

}  // namespace hybrid_quad
