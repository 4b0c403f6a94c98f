#include "hybrid_quad/frame_field/frame_topology.h"

#include <cmath>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/grid_algebra/quarter_turn.h"

namespace hybrid_quad {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kQuarter = kPi / 2;

int nearest_quarters(double angle) { return static_cast<int>(std::lround(angle / kQuarter)); }

/// Angle from the nearest axis of the frame to half-edge h.
double deviation_from_axis(const FaceAngles& angles, const std::vector<double>& directions, int h) {
  const double angle = angles.direction(h) - directions[h / 3];
  return angle - nearest_quarters(angle) * kQuarter;
}

}  // namespace

std::vector<double> frame_directions(const TriangleMesh& mesh, const std::vector<Vector3>& du, const std::vector<Vector3>& dv,
                                     const RunContext& context) {
  std::vector<double> directions(mesh.face_count(), 0);
  parallel_chunks(mesh.face_count(), context, [&](int begin, int end) {
    for (int f = begin; f < end; ++f) {
      const FaceBasis basis = face_basis(mesh, f);
      // The rotation nearest to a matrix of positive determinant: its conformal part, which cannot vanish.
      const double cosine = du[f].dot(basis.along) + dv[f].dot(basis.across);
      const double sine = du[f].dot(basis.across) - dv[f].dot(basis.along);
      const double angle = std::atan2(sine, cosine);
      if (std::isfinite(angle)) directions[f] = angle;
    }
  });
  return directions;
}

FrameTurn turn_across(const TriangleMesh& mesh, const FaceAngles& angles, const std::vector<double>& directions, int h) {
  const int o = mesh.opposite(h);
  const double angle = directions[o / 3] - directions[h / 3] - angles.transport(h, o);
  // Rounded from one side only: the two half-edges of an edge must not disagree where the turn is half a quarter.
  if (h > o) {
    const FrameTurn back = turn_across(mesh, angles, directions, o);
    return {inverse_turns(back.quarters), -back.angle};
  }
  const int quarters = nearest_quarters(angle - angles.expected_turn(h));
  return {wrap_turns(quarters), angle - quarters * kQuarter};
}

FrameTurn turn_across(const FaceAngles& angles, const std::vector<double>& directions, int h, int opposite, int quarters) {
  const double angle = directions[opposite / 3] - directions[h / 3] - angles.transport(h, opposite);
  return {quarters, std::remainder(angle - quarters * kQuarter, 2 * kPi)};
}

int quarters_at(const TriangleMesh& mesh, const FaceAngles& angles, const std::vector<double>& directions, int v,
                const std::vector<std::uint8_t>* matching) {
  const int first = mesh.outgoing(v);
  if (first < 0) return 0;
  double fan = 0, turning = 0;
  int h = first, last = first;
  do {
    fan += angles.corner(h);
    last = TriangleMesh::previous(h);
    if (!mesh.is_boundary(last))
      turning += matching ? turn_across(angles, directions, last, mesh.opposite(last), (*matching)[last]).angle
                          : turn_across(mesh, angles, directions, last).angle;
    h = mesh.rotate_ccw(h);
  } while (h >= 0 && h != first);
  if (h >= 0) return nearest_quarters(2 * kPi - fan + turning);
  const double sector =
      fan - turning + deviation_from_axis(angles, directions, first) - deviation_from_axis(angles, directions, last);
  return 2 - nearest_quarters(sector);
}

int sector_quarters(const TriangleMesh& mesh, const FaceAngles& angles, const std::vector<double>& directions, int first,
                    const std::vector<char>& is_marked) {
  double sector = deviation_from_axis(angles, directions, first);
  for (int h = first;;) {
    sector += angles.corner(h);
    const int last = TriangleMesh::previous(h);
    h = mesh.rotate_ccw(h);
    if (h < 0 || is_marked[h]) return nearest_quarters(sector - deviation_from_axis(angles, directions, last));
    sector -= turn_across(mesh, angles, directions, last).angle;
  }
}

std::vector<int> vertex_quarters(const TriangleMesh& mesh, const FaceAngles& angles, const std::vector<double>& directions,
                                 const std::vector<std::uint8_t>* matching, const RunContext& context) {
  std::vector<int> quarters(mesh.vertex_count());
  parallel_chunks(mesh.vertex_count(), context, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) quarters[v] = quarters_at(mesh, angles, directions, v, matching);
  });
  return quarters;
}

}  // namespace hybrid_quad
