#include "hybrid_quad/spanning_parameterization/spanning_parameterization.h"

#include <cmath>
#include <string>

#include "hybrid_quad/spanning_parameterization/dislocations.h"
#include "hybrid_quad/spanning_parameterization/grid_poisson.h"
#include "hybrid_quad/spanning_parameterization/lifted_grid.h"

namespace hybrid_quad {

namespace {

GridVector sum(const GridVector& x, const GridVector& y) { return {x[0] + y[0], x[1] + y[1]}; }
GridVector minus(const GridVector& x) { return {-x[0], -x[1]}; }
GridVector difference(const GridVector& x, const GridVector& y) { return {x[0] - y[0], x[1] - y[1]}; }
bool is_zero(const GridVector& x) { return x[0] == 0 && x[1] == 0; }
bool is_integer(std::int64_t x) { return x % kGridUnit == 0; }

/// A translation that leaves Psi alone: both coordinates whole, their sum even.
bool is_lattice(const GridVector& x) {
  return is_integer(x[0]) && is_integer(x[1]) && (x[0] / kGridUnit + x[1] / kGridUnit) % 2 == 0;
}

std::int64_t fixed_point(double x) {
  return static_cast<std::int64_t>(std::llround(x * static_cast<double>(kGridUnit)));
}

/// Vertex values in fixed point: constrained coordinates whole, so that every later difference is exact.
std::vector<GridVector> quantized_values(const LiftedGrid& grid) {
  std::vector<GridVector> values(grid.value.size());
  for (std::size_t v = 0; v < values.size(); ++v) {
    const GridConstraint c = grid.constraint[v];
    const bool whole[2] = {c == GridConstraint::kCorner || c == GridConstraint::kIsolineU,
                           c == GridConstraint::kCorner || c == GridConstraint::kIsolineV};
    for (int i = 0; i < 2; ++i)
      values[v][i] = whole[i] ? std::llround(grid.value[v][i]) * kGridUnit : fixed_point(grid.value[v][i]);
  }
  return values;
}

/// Twice the area in the grid's plane, or 0 for a face so large that the product would not fit.
std::int64_t determinant(const GridVector& x, const GridVector& y) {
  constexpr std::int64_t kLargest = std::int64_t{1} << 30;
  for (const GridVector& z : {x, y})
    for (const std::int64_t c : z)
      if (c > kLargest || c < -kLargest) return 0;
  return x[0] * y[1] - x[1] * y[0];
}

void write_coordinates(const TriangleMesh& mesh, const FrameField& frames, const LiftedGrid& grid,
                       SpanningParameterization& param) {
  const std::vector<GridVector> values = quantized_values(grid);
  param.halfedge_uv.resize(mesh.halfedge_count());
  param.corner_uv.resize(mesh.halfedge_count());
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int o = mesh.opposite(h);
    if (o > h) continue;
    const GridVector p = turned(values[mesh.from(h)], grid.corner_turn[h]);
    const GridVector q = turned(values[mesh.to(h)], grid.corner_turn[TriangleMesh::next(h)]);
    const GridVector jump{grid.jump[h][0] * kGridUnit, grid.jump[h][1] * kGridUnit};
    param.halfedge_uv[h] = sum(difference(q, p), jump);
    if (o >= 0) param.halfedge_uv[o] = minus(turned(param.halfedge_uv[h], frames.matching[h]));
  }
  for (int f = 0; f < mesh.face_count(); ++f) {
    param.corner_uv[3 * f] = turned(values[mesh.from(3 * f)], grid.corner_turn[3 * f]);
    for (int i = 0; i < 2; ++i)
      param.corner_uv[3 * f + i + 1] = sum(param.corner_uv[3 * f + i], param.halfedge_uv[3 * f + i]);
  }
}

GridVector closing_gap(const SpanningParameterization& param, int f) {
  return sum(param.halfedge_uv[3 * f], sum(param.halfedge_uv[3 * f + 1], param.halfedge_uv[3 * f + 2]));
}

bool features_on_isolines(const WorkingSurface& surface, const SpanningParameterization& param, int f) {
  for (int h = 3 * f; h < 3 * f + 3; ++h)
    if (surface.features.is_feature(h) && (param.halfedge_uv[h][0] != 0) == (param.halfedge_uv[h][1] != 0))
      return false;
  return true;
}

void classify_faces(const WorkingSurface& surface, SpanningParameterization& param) {
  const int n = surface.mesh.face_count();
  param.charge.assign(n, {0, 0});
  param.is_regular.assign(n, 0);
  for (int f = 0; f < n; ++f) {
    const GridVector gap = closing_gap(param, f);
    param.charge[f] = windings({static_cast<int>(gap[0] / kGridUnit), static_cast<int>(gap[1] / kGridUnit)});
    if (!is_zero(gap)) continue;
    const bool unfolded = determinant(param.halfedge_uv[3 * f], param.halfedge_uv[3 * f + 1]) > 0;
    param.folded_faces += !unfolded;
    param.is_regular[f] = unfolded && features_on_isolines(surface, param, f);
  }
}

}  // namespace

SpanningParameterization build_spanning_parameterization(const WorkingSurface& surface,
                                                         const FrameField& frames, const PeriodicField& psi,
                                                         const SpanningOptions& options,
                                                         const RunContext& context) {
  context.checkpoint(0);
  SpanningParameterization param;
  const GridMeasure measure = measure_edges(surface, frames, options.strip_rows);
  LiftedGrid grid = lift(surface, frames, psi, measure);
  context.checkpoint(0.3);
  param.dislocations_found = count_dislocations(surface.mesh, grid);
  if (options.cancel_dislocations) cancel_dislocations(surface, frames, measure, options, context, grid);
  param.dislocations_left = count_dislocations(surface.mesh, grid);
  const GridFolds folds = spread_slip(surface, frames, measure, options.stiffening_rounds, context, grid);
  param.folded_feature_edges = folds.feature_edges;
  for (std::size_t c = 0; c < grid.curve_count.size(); ++c) param.vanished_curves += grid.curve_count[c] <= 0;
  write_coordinates(surface.mesh, frames, grid, param);
  classify_faces(surface, param);
  param.is_grid_vertex.resize(surface.mesh.vertex_count());
  for (int v = 0; v < surface.mesh.vertex_count(); ++v)
    param.is_grid_vertex[v] = grid.constraint[v] == GridConstraint::kCorner;
  context.checkpoint(1);
  return param;
}

std::vector<std::string> violations_of(const SpanningParameterization& param, const WorkingSurface& surface,
                                       const FrameField& frames) {
  std::vector<std::string> found;
  const TriangleMesh& mesh = surface.mesh;
  const std::size_t halfedges = mesh.halfedge_count(), faces = mesh.face_count();
  if (param.corner_uv.size() != halfedges || param.halfedge_uv.size() != halfedges ||
      param.charge.size() != faces || param.is_regular.size() != faces ||
      param.is_grid_vertex.size() != static_cast<std::size_t>(mesh.vertex_count())) {
    found.push_back("array sizes");
    return found;
  }
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const auto report = [&](const char* what) { found.push_back(std::string(what) + " at half-edge " + std::to_string(h)); };
    const int o = mesh.opposite(h), f = h / 3;
    if (o >= 0 && param.halfedge_uv[o] != minus(turned(param.halfedge_uv[h], frames.matching[h])))
      report("sides disagree");
    if (h % 3 < 2 && param.corner_uv[h + 1] != sum(param.corner_uv[h], param.halfedge_uv[h]))
      report("corners do not follow the edge");
    const int around = mesh.rotate_ccw(h);
    if (around >= 0 &&
        !is_lattice(difference(turned(param.corner_uv[h], frames.matching[TriangleMesh::previous(h)]),
                               param.corner_uv[around])))
      report("corner leaves the lattice");
    if (param.is_grid_vertex[mesh.from(h)] &&
        !(is_integer(param.corner_uv[h][0]) && is_integer(param.corner_uv[h][1])))
      report("pinned vertex is off the grid");
    if (surface.features.is_feature(h) && param.is_regular[f]) {
      const GridVector& d = param.halfedge_uv[h];
      const int across = d[0] == 0 ? 0 : 1;
      if (d[across] != 0 || !is_integer(param.corner_uv[h][across]))
        report("feature is off its isoline");
    }
  }
  for (int f = 0; f < mesh.face_count(); ++f) {
    const GridVector gap = closing_gap(param, f);
    const IntVector2 burgers = burgers_of(param.charge[f]);
    const auto report = [&](const char* what) { found.push_back(std::string(what) + " at face " + std::to_string(f)); };
    if (gap[0] != burgers[0] * kGridUnit || gap[1] != burgers[1] * kGridUnit)
      report("gap is not the charge");
    if (!param.is_regular[f]) continue;
    if (!is_zero(gap)) report("regular face does not close");
    if (determinant(param.halfedge_uv[3 * f], param.halfedge_uv[3 * f + 1]) <= 0)
      report("regular face is folded");
  }
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (!param.is_grid_vertex[v] && (surface.features.is_corner[v] || (frames.cone_index[v] & 1)))
      found.push_back("corner or cone is not pinned: vertex " + std::to_string(v));
  return found;
}

}  // namespace hybrid_quad
