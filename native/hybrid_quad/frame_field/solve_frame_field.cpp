#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/frame_field/acute_tips.h"
#include "hybrid_quad/frame_field/cross_diffusion.h"
#include "hybrid_quad/frame_field/cross_relaxation.h"
#include "hybrid_quad/frame_field/frame_field.h"
#include "hybrid_quad/frame_field/frame_topology.h"
#include "hybrid_quad/frame_field/move_cones.h"
#include "hybrid_quad/frame_field/smooth_connection.h"
#include "hybrid_quad/frame_field/smoothest_crosses.h"
#include "hybrid_quad/frame_field/soft_alignment.h"

namespace hybrid_quad {

namespace {

/// The crosses of a surface as unknowns: z = e^{4 i angle}, the angle from each face's half-edge 0.
struct CrossUnknowns {
  std::vector<Complex> z;      ///< #F
  std::vector<int> unknown;    ///< #F: index into the system, -1 for faces that a feature fixes
  CrossSystem system;
  std::vector<double> diffusion_mass;  ///< #unknowns: area over target length squared
};

/// Faces at features follow their longest feature edge.
void fix_faces_at_features(const WorkingSurface& surface, const FaceAngles& angles, CrossUnknowns& cross) {
  const TriangleMesh& mesh = surface.mesh;
  cross.z.assign(mesh.face_count(), Complex(1, 0));
  cross.unknown.assign(mesh.face_count(), 0);
  int count = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    double longest = -1;
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      if (!surface.features.is_feature(h) && !mesh.is_boundary(h)) continue;
      const double length = mesh.edge_length(h);
      if (length <= longest) continue;
      longest = length;
      cross.z[f] = std::polar(1.0, 4 * angles.direction(h));
    }
    cross.unknown[f] = longest >= 0 ? -1 : count++;
  }
  cross.system.diagonal.assign(count, 0);
  cross.system.source.assign(count, Complex(0, 0));
}

/// |edge| over |dual edge|, up to a factor; bounded, so that slivers neither decouple nor lock their neighbours.
double link_stiffness(const WorkingSurface& surface, int h, double area_sum) {
  constexpr double kStiffest = 1e3, kSoftest = 1e-3, kAcrossFeatures = 1e-3;
  const double square = surface.mesh.edge_vector(h).squaredNorm();
  double w = area_sum > 0 ? 3 * square / area_sum : kStiffest;
  if (!(w < kStiffest)) w = kStiffest;
  w = std::max(w, kSoftest);
  return surface.features.is_feature(h) ? w * kAcrossFeatures : w;
}

/// Adds the soft pulls to the system, so that relaxation and diffusion alike feel them.
void pull_softly(const std::vector<Complex>& pulls, CrossUnknowns& cross) {
  for (std::size_t f = 0; f < pulls.size(); ++f) {
    const int p = cross.unknown[f];
    if (p < 0) continue;
    cross.system.diagonal[p] += 2 * cross.diffusion_mass[p] * std::abs(pulls[f]);
    cross.system.source[p] += 2 * cross.diffusion_mass[p] * pulls[f];
  }
}

CrossUnknowns assemble_cross_system(const WorkingSurface& surface, const FaceAngles& angles, const FrameFieldOptions& options,
                                    const RunContext& context) {
  const TriangleMesh& mesh = surface.mesh;
  std::vector<double> for_lengths;
  if (options.turn_for_lengths > 0) for_lengths = turns_for_lengths(surface);
  CrossUnknowns cross;
  fix_faces_at_features(surface, angles, cross);
  std::vector<double> area(mesh.face_count());
  for (int f = 0; f < mesh.face_count(); ++f) area[f] = mesh.area(f);
  std::vector<double> stiffness(mesh.halfedge_count());
  std::vector<Complex> carried(mesh.halfedge_count());  // z beyond the half-edge from z here
  parallel_chunks(mesh.halfedge_count(), context, [&](int begin, int end) {
    for (int h = begin; h < end; ++h) {
      const int o = mesh.opposite(h);
      if (o < h) continue;
      const double turn = angles.expected_turn(h) + (for_lengths.empty() ? 0.0 : options.turn_for_lengths * for_lengths[h]);
      stiffness[h] = link_stiffness(surface, h, area[h / 3] + area[o / 3]);
      carried[h] = std::polar(stiffness[h], 4 * (angles.transport(h, o) + turn));
    }
  });
  CrossSystem& system = cross.system;
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int o = mesh.opposite(h);
    if (o < h) continue;
    const int f = h / 3, g = o / 3, p = cross.unknown[f], q = cross.unknown[g];
    if (p < 0 && q < 0) continue;
    const double w = stiffness[h];
    const Complex carry = carried[h];
    if (p >= 0) system.diagonal[p] += w;
    if (q >= 0) system.diagonal[q] += w;
    if (p >= 0 && q >= 0) {
      system.links.push_back(p < q ? CrossLink{p, q, carry} : CrossLink{q, p, std::conj(carry)});
    } else if (p >= 0) {
      system.source[p] += std::conj(carry) * cross.z[g];
    } else {
      system.source[q] += carry * cross.z[f];
    }
  }
  cross.diffusion_mass.resize(system.size());
  for (int f = 0; f < mesh.face_count(); ++f)
    if (cross.unknown[f] >= 0) {
      const double h = surface.target_length[f];
      const double share = area[f] / (h * h);
      cross.diffusion_mass[cross.unknown[f]] = std::isfinite(share) ? std::max(share, 1e-6) : 1e-6;
    }
  pull_softly(soft_pulls(surface, options, context), cross);
  return cross;
}

/// A field on its way to being the best.
struct Solution {
  std::vector<double> directions;  ///< #F
  FieldSolution record;
};

std::vector<double> directions_of(const CrossUnknowns& cross, const std::vector<Complex>& solution) {
  std::vector<double> directions(cross.z.size());
  for (std::size_t f = 0; f < cross.z.size(); ++f)
    directions[f] = std::arg(cross.unknown[f] < 0 ? cross.z[f] : solution[cross.unknown[f]]) / 4;
  return directions;
}

/// Quarters that the field turns at the vertices inside, on features or off them.
int inner_quarters(const TriangleMesh& mesh, const FaceAngles& angles, const std::vector<double>& directions) {
  int sum = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (!mesh.is_boundary_vertex(v)) sum += std::abs(quarters_at(mesh, angles, directions, v));
  return sum;
}

Solution finished(const WorkingSurface& surface, const FaceAngles& angles, const CrossUnknowns& cross, const CrossLevel& finest,
                  std::vector<Complex> z, const std::vector<double>& diffusion_times, bool may_cancel, const RunContext& context) {
  std::vector<double> mass(z.size());
  for (const double time : diffusion_times) {
    for (std::size_t i = 0; i < z.size(); ++i) mass[i] = 2 * cross.diffusion_mass[i] / time;
    diffuse_crosses(finest, mass, z, context);
  }
  Solution solution;
  solution.directions = directions_of(cross, z);
  split_strong_cones(surface, angles, solution.directions);
  if (may_cancel) cancel_cones(surface, angles, solution.directions);
  solution.record.quarters = inner_quarters(surface.mesh, angles, solution.directions);
  solution.record.energy = cross_energy(cross.system, z);
  return solution;
}

constexpr double kCone = 50;  ///< about the energy of a cone within a disk of twenty quads

/// What a field costs: its energy, and as much again for every cone. Who asks for the surface's bends to be followed gets the
/// field that follows them best.
double cost(const FieldSolution& solution, const FrameFieldOptions& options) {
  return solution.energy + kCone * (1 - options.curvature_alignment) * solution.quarters;
}

/// The relaxed solution, which is the better one more often, unless the other gains half a cone: no change for nothing.
int better_of(const std::array<Solution, 2>& both, const FrameFieldOptions& options) {
  return cost(both[1].record, options) + 0.5 * kCone < cost(both[0].record, options) ? 1 : 0;
}

std::array<Solution, 2> both_solutions(const WorkingSurface& surface, const FaceAngles& angles, const CrossUnknowns& cross,
                                       const FrameFieldOptions& options, const RunContext& context) {
  constexpr int kLinearSweeps = 3;
  const std::vector<CrossLevel> levels = cross_hierarchy(cross.system, options.coarsest, context);
  RunContext each = context;  // two at once have no common progress
  each.on_progress = nullptr;
  // Lengths need cones of their own, close together: the long diffusion loses them, however smooth what is left.
  const bool compares = !(options.turn_for_lengths > 0);
  std::array<Solution, 2> both;
  parallel_for(compares ? 2 : 1, context.threads, [&](int i) {
    both[i] = i == 0 ? finished(surface, angles, cross, levels[0], relax_crosses(levels, options.sweeps, each),
                                options.diffusion_times, compares, each)
                     : finished(surface, angles, cross, levels[0], smoothest_crosses(levels, kLinearSweeps, each),
                                options.smoothest_diffusion_times, compares, each);
  });
  if (!compares) both[1] = both[0];
  return both;
}

std::vector<double> expected_turns(const WorkingSurface& surface, const FaceAngles& angles, const FrameFieldOptions& options) {
  std::vector<double> turns = turns_for_average_curvature(surface, angles, options.curvature_spread);
  const std::vector<double> at_tips = turns_that_open_tips(surface, angles);
  for (std::size_t h = 0; h < turns.size(); ++h) turns[h] += at_tips[h];
  return turns;
}

}  // namespace

FrameField solve_frame_field(const WorkingSurface& surface, const FrameFieldOptions& options, const RunContext& context) {
  const TriangleMesh& mesh = surface.mesh;
  FaceAngles angles(mesh, context);
  angles.expect_turns(expected_turns(surface, angles, options));
  const CrossUnknowns cross = assemble_cross_system(surface, angles, options, context);
  context.checkpoint(0.1);
  std::array<Solution, 2> both = both_solutions(surface, angles, cross, options, context);
  const int kept = better_of(both, options);
  const std::vector<double>& directions = both[kept].directions;

  std::vector<Vector3> du(mesh.face_count()), dv(mesh.face_count());
  parallel_chunks(mesh.face_count(), context, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) {
      const FaceBasis basis = face_basis(mesh, f);
      const double c = std::cos(directions[f]), s = std::sin(directions[f]);
      du[f] = c * basis.along + s * basis.across;
      dv[f] = c * basis.across - s * basis.along;
    }
  });
  FrameField field = frame_field_from_rows(surface, angles, std::move(du), std::move(dv), context);
  field.choice = {both[0].record, both[1].record, kept};
  return field;
}

}  // namespace hybrid_quad
