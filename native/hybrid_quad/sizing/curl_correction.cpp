#include "hybrid_quad/sizing/curl_correction.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/grid_algebra/quarter_turn.h"
#include "hybrid_quad/numerics/sparse_solve.h"

namespace hybrid_quad {

namespace {

/// Row r of X_f enters a constraint as  sum of coefficients times (X_f)_{r0}, (X_f)_{r1}.
struct RowTerm {
  int constraint;
  Vector2 coefficients;
};

/// The linear constraints on all rows, softened by `compliance` (1 / weight). Row r of face f is node 2 f + r.
struct RowConstraints {
  std::vector<std::array<RowTerm, 6>> terms;  ///< per node: at most an edge and a feature on each of three sides
  std::vector<int> term_count;
  std::vector<double> compliance;
  std::vector<Vector3> place;      ///< per constraint: the middle of its edge
  std::vector<Vector2> stiffness;  ///< per node: what X - I costs, without lambda
  std::vector<Vector2> feature;    ///< per node: the feature edge whose row this has to vanish on, or zero

  int add(double softness, const Vector3& middle) {
    compliance.push_back(softness);
    place.push_back(middle);
    return static_cast<int>(compliance.size()) - 1;
  }
  void put(int node, int constraint, const Vector2& coefficients) {
    terms[node][term_count[node]++] = {constraint, coefficients};
  }
};

Vector3 middle_of(const TriangleMesh& mesh, int h) { return 0.5 * (mesh.position(mesh.from(h)) + mesh.position(mesh.to(h))); }

/// Both rows must agree across the edge: X_f d_f + turned(X_g d_g) = 0.
void add_edge(const FrameField& field, const TriangleMesh& mesh, int h, double relative_area, RowConstraints& constraints) {
  const int o = mesh.opposite(h), f = h / 3, g = o / 3;
  const Vector2 here = field.grid_vector(mesh, h), there = field.grid_vector(mesh, o);
  const double softness = std::max(here.squaredNorm(), 1e-12) / relative_area;
  for (int row = 0; row < 2; ++row) {
    // Row `row` of turned(value) is one row of the value with a sign; ask the turn itself which.
    const Vector2 from_u = turned(Vector2(1, 0), field.matching[o]), from_v = turned(Vector2(0, 1), field.matching[o]);
    const int source = std::abs(from_u[row]) > 0.5 ? 0 : 1;
    const double sign = source == 0 ? from_u[row] : from_v[row];
    const int constraint = constraints.add(softness, middle_of(mesh, h));
    constraints.put(2 * f + row, constraint, here);
    constraints.put(2 * g + source, constraint, sign * there);
  }
}

/// The feature edges of face f stay isolines: at most one a row, the longest, or the row would have to vanish.
void add_features(const FrameField& field, const WorkingSurface& surface, int f, double weight, RowConstraints& constraints) {
  constexpr double kMostSlanted = 0.6;  // sine of the angle beyond which an edge follows no axis of the frame
  std::array<int, 2> chosen{-1, -1};
  std::array<double, 2> longest{0, 0};
  for (int h = 3 * f; h < 3 * f + 3; ++h) {
    if (!surface.features.is_feature(h) && !surface.mesh.is_boundary(h)) continue;
    const Vector2 d = field.grid_vector(surface.mesh, h);
    const int row = std::abs(d[0]) >= std::abs(d[1]) ? 1 : 0;
    const double length = d.norm();
    if (length <= longest[row] || std::abs(d[row]) > kMostSlanted * length) continue;
    longest[row] = length;
    chosen[row] = h;
  }
  for (int row = 0; row < 2; ++row) {
    if (chosen[row] < 0) continue;
    const Vector2 d = field.grid_vector(surface.mesh, chosen[row]);
    const double softness = std::max(d.squaredNorm(), 1e-12) / (weight * weight);
    constraints.put(2 * f + row, constraints.add(softness, middle_of(surface.mesh, chosen[row])), d);
    constraints.feature[2 * f + row] = d;
  }
}

RowConstraints gather_constraints(const WorkingSurface& surface, const FrameField& field, const CurlCorrectionOptions& options) {
  const TriangleMesh& mesh = surface.mesh;
  const int faces = mesh.face_count();
  std::vector<double> area(faces);
  double total = 0;
  for (int f = 0; f < faces; ++f) total += area[f] = mesh.area(f);
  const double mean = total > 0 ? total / faces : 1;
  RowConstraints constraints;
  constraints.terms.resize(2 * faces);
  constraints.term_count.assign(2 * faces, 0);
  constraints.stiffness.resize(2 * faces);
  constraints.feature.assign(2 * faces, Vector2::Zero());
  constraints.compliance.reserve(mesh.halfedge_count());
  for (int f = 0; f < faces; ++f) {
    const double share = area[f] / mean + 1e-4;  // a face without area still resists
    const double turning = options.direction_weight.empty() ? 2.0 : 2 * options.direction_weight[f];
    constraints.stiffness[2 * f] = Vector2(1, turning) * share;
    constraints.stiffness[2 * f + 1] = Vector2(turning, 1) * share;
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      const int o = mesh.opposite(h);
      if (o > h) add_edge(field, mesh, h, (area[f] + area[o / 3]) / (3 * mean) + 1e-4, constraints);
    }
    add_features(field, surface, f, options.feature_weight, constraints);
  }
  return constraints;
}

/// Lower triangle of  lambda * compliance + B stiffness^-1 B^T,  and B times the identity's rows.
void assemble_dual(const RowConstraints& constraints, double lambda, SparseMatrix& matrix, Eigen::VectorXd& right_side) {
  const int n = static_cast<int>(constraints.compliance.size());
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(n + 10 * constraints.terms.size());
  right_side = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, lambda * constraints.compliance[i]);
  for (std::size_t node = 0; node < constraints.terms.size(); ++node) {
    const Vector2 inverse = constraints.stiffness[node].cwiseInverse();
    for (int a = 0; a < constraints.term_count[node]; ++a) {
      const RowTerm& x = constraints.terms[node][a];
      right_side[x.constraint] += x.coefficients[node % 2];
      for (int b = 0; b <= a; ++b) {
        const RowTerm& y = constraints.terms[node][b];
        const double value = x.coefficients.dot(inverse.cwiseProduct(y.coefficients));
        entries.emplace_back(std::max(x.constraint, y.constraint), std::min(x.constraint, y.constraint), value);
      }
    }
  }
  matrix.resize(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
}

/// The correction for given stiffnesses, with feature edges put on their isolines exactly.
void solve_rows(const RowConstraints& constraints, double lambda, std::vector<std::array<double, 4>>& x, const RunContext& context) {
  context.checkpoint(0.1);
  SparseMatrix matrix;
  Eigen::VectorXd right_side;
  assemble_dual(constraints, lambda, matrix, right_side);
  const Eigen::VectorXd multiplier = solve_sparse(matrix, right_side, constraints.place, context);
  for (std::size_t node = 0; node < constraints.terms.size(); ++node) {
    Vector2 push = Vector2::Zero();
    for (int a = 0; a < constraints.term_count[node]; ++a)
      push += multiplier[constraints.terms[node][a].constraint] * constraints.terms[node][a].coefficients;
    const bool is_u = node % 2 == 0;
    Vector2 row = Vector2(is_u ? 1 : 0, is_u ? 0 : 1) - push.cwiseQuotient(constraints.stiffness[node]);
    const Vector2& feature = constraints.feature[node];
    if (feature.squaredNorm() > 0) row -= (row.dot(feature) / feature.squaredNorm()) * feature;
    x[node / 2][is_u ? 0 : 2] = row[0];
    x[node / 2][is_u ? 1 : 3] = row[1];
  }
}

/// Makes folded faces and their neighbours stiffer. \return false if too few are folded to matter
bool raise_around_folds(const TriangleMesh& mesh, const std::vector<std::array<double, 4>>& x, double tolerated,
                        RowConstraints& constraints) {
  constexpr double kRaise = 10;
  std::vector<char> marked(x.size(), 0);
  int folded = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (is_sound_correction(x[f])) continue;
    ++folded;
    marked[f] = 1;
    for (int h = 3 * f; h < 3 * f + 3; ++h)
      if (!mesh.is_boundary(h)) marked[mesh.opposite(h) / 3] = 1;
  }
  if (folded <= tolerated * mesh.face_count()) return false;
  for (int f = 0; f < mesh.face_count(); ++f)
    if (marked[f]) {
      constraints.stiffness[2 * f] *= kRaise;
      constraints.stiffness[2 * f + 1] *= kRaise;
    }
  return true;
}

}  // namespace

bool is_sound_correction(const std::array<double, 4>& x) {
  constexpr double kLeastDeterminant = 0.2, kMostDeviation = 3;
  const double deviation = (x[0] - 1) * (x[0] - 1) + x[1] * x[1] + x[2] * x[2] + (x[3] - 1) * (x[3] - 1);
  return x[0] * x[3] - x[1] * x[2] > kLeastDeterminant && deviation < kMostDeviation * kMostDeviation;
}

std::vector<std::array<double, 4>> curl_correction(const WorkingSurface& surface, const FrameField& field,
                                                   const CurlCorrectionOptions& options, const RunContext& context) {
  RowConstraints constraints = gather_constraints(surface, field, options);
  std::vector<std::array<double, 4>> x(surface.mesh.face_count(), {1, 0, 0, 1});
  if (constraints.compliance.empty()) return x;
  for (int round = 0;; ++round) {
    solve_rows(constraints, options.curl_weight, x, context);
    if (round == options.max_raises || !raise_around_folds(surface.mesh, x, options.tolerated_folds, constraints)) break;
  }
  return x;
}

double curl_of(const TriangleMesh& mesh, const FrameField& field) {
  double mismatch = 0, length = 0;
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int o = mesh.opposite(h);
    if (o < h) continue;
    const Vector2 here = field.grid_vector(mesh, h), there = turned(field.grid_vector(mesh, o), field.matching[o]);
    mismatch += (here + there).squaredNorm();
    length += here.squaredNorm();
  }
  return length > 0 ? std::sqrt(mismatch / length) : 0;
}

}  // namespace hybrid_quad
