#include "hybrid_quad/pipeline/wishes.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "hybrid_quad/sizing/asked_lengths.h"
#include "hybrid_quad/sizing/chord_lengths.h"

namespace hybrid_quad {

namespace {

constexpr double kGrowth = 0.5;  ///< of lengths over a unit of distance

using Frame = std::array<Vector3, 2>;

bool is_finite(double x) { return std::isfinite(x); }
bool is_finite(const Vector3& x) { return x.allFinite(); }
bool is_finite(const Frame& x) { return x[0].allFinite() && x[1].allFinite(); }
bool is_free(const Vector3& guide) { return guide.isZero(0); }
bool is_free(const Frame& frame) { return frame[0].isZero(0) && frame[1].isZero(0); }

/// Longer over shorter axis of the ellipse that the frame's vectors span; infinite where they are parallel.
double stretch_ratio(const Frame& frame) {
  const double sum = frame[0].squaredNorm() + frame[1].squaredNorm(), area = frame[0].cross(frame[1]).norm();
  return (sum + std::sqrt(std::max(0.0, sum * sum - 4 * area * area))) / (2 * area);
}

/// #V: whether a polygon uses the vertex; what others are asked makes no difference.
std::vector<char> used_vertices(const PolygonSoup& soup) {
  std::vector<char> is_used(soup.positions.size(), 0);
  for (const int v : soup.face_vertices)
    if (v >= 0 && v < static_cast<int>(is_used.size())) is_used[v] = 1;
  return is_used;
}

/// One value for each element of a kind, all finite. \param counts  of each element: whether its value makes a difference
template <class Value>
void check_values(const std::vector<Value>& values, const std::vector<char>& counts, const std::string& what, const std::string& kind) {
  const std::size_t count = counts.size();
  if (values.empty()) return;
  if (values.size() != count)
    throw InputError("wrong_count", std::to_string(values.size()) + " values of " + what + " for " + std::to_string(count) +
                                        " elements (" + kind + ").");
  std::vector<int> bad;
  for (std::size_t i = 0; i < count; ++i)
    if (counts[i] && !is_finite(values[i])) bad.push_back(static_cast<int>(i));
  if (!bad.empty())
    throw InputError("non_finite_" + what, "The " + what + " is not finite at " + kind + " " + std::to_string(bad.front()) + ".", kind, bad);
}

void check_frames(const std::vector<Frame>& frames, const std::vector<char>& counts, const std::string& kind) {
  std::vector<int> bad;
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (counts[i] && !is_free(frames[i]) && !(stretch_ratio(frames[i]) <= kMostFrameStretch)) bad.push_back(static_cast<int>(i));
  if (!bad.empty())
    throw InputError("degenerate_frame", "The two vectors of the frame at " + kind + " " + std::to_string(bad.front()) +
                                             " are (nearly) parallel, or one is far longer.", kind, bad);
}

/// By vertices and by polygons, at the corners of a component's triangles; a polygon's own value goes first.
template <class Value>
std::vector<Value> at_corners(const std::vector<Value>& by_vertex, const std::vector<Value>& by_face, const Value& none,
                              const TriangleMesh& mesh, const std::vector<int>& vertex, const std::vector<int>& face,
                              const BuiltMesh& built) {
  std::vector<Value> corners;
  if (by_vertex.empty() && by_face.empty()) return corners;
  corners.assign(mesh.halfedge_count(), none);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (!by_vertex.empty()) corners[h] = by_vertex[built.input_vertex[vertex[mesh.from(h)]]];
    if (by_face.empty()) continue;
    const Value& own = by_face[built.input_face[face[h / 3]]];
    if (!is_free(own)) corners[h] = own;
  }
  return corners;
}

/// Where there is a frame, its rotation goes before a guide.
void put_frames_first(const TriangleMesh& mesh, const std::vector<Frame>& frames, std::vector<Vector3>& guides) {
  guides.resize(frames.size(), Vector3(0, 0, 0));
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (is_free(frames[h])) continue;
    const FaceBasis basis = face_basis(mesh, h / 3);
    const Vector3& u = frames[h][0];
    // Which way round the two vectors come does not matter.
    const Vector3 v = u.cross(frames[h][1]).dot(basis.normal) < 0 ? Vector3(-frames[h][1]) : frames[h][1];
    const double angle = std::atan2(u.dot(basis.across) - v.dot(basis.along), u.dot(basis.along) + v.dot(basis.across));
    guides[h] = std::cos(angle) * basis.along + std::sin(angle) * basis.across;
  }
}

/// How much longer than usual a frame makes edges, averaged around every vertex in logarithms.
void multiply_by_frames(const TriangleMesh& mesh, const std::vector<Frame>& frames, std::vector<double>& density) {
  std::vector<double> sum(mesh.vertex_count(), 0), count(mesh.vertex_count(), 0);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    count[mesh.from(h)] += 1;
    if (!is_free(frames[h])) sum[mesh.from(h)] -= 0.5 * std::log(frames[h][0].cross(frames[h][1]).norm());
  }
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (count[v] > 0) density[v] *= std::exp(sum[v] / count[v]);
}

/// Multiplies the density by what the curvature asks for.
void multiply_by_curvature(const TriangleMesh& component, const std::vector<std::array<int, 2>>& marked,
                           const RemeshOptions& options, double usual_length, std::vector<double>& density,
                           const RunContext& context) {
  FeatureOptions asked = feature_options(options, usual_length);
  asked.marked_edges = marked;
  const FeatureGraph features = detect_features(component, asked, context);
  const std::vector<double> even(component.vertex_count(), usual_length);
  const WorkingSurface surface = build_working_surface(component, features, even, WorkingSurfaceOptions{}, context);
  const std::vector<double> by_curvature = curvature_density(surface, component, usual_length, options.adaptivity, context);
  for (int v = 0; v < component.vertex_count(); ++v) density[v] *= by_curvature[v];
}

std::vector<double> density_of(const TriangleMesh& component, const std::vector<int>& vertex, const BuiltMesh& built,
                               const std::vector<Frame>& frames, const std::vector<std::array<int, 2>>& marked,
                               const RemeshOptions& options, double usual_length, const std::vector<double>& chords,
                               const RunContext& context) {
  const bool by_curvature = chords.empty() && options.adaptivity > 0;
  if (options.density.empty() && frames.empty() && chords.empty() && !by_curvature) return {};
  std::vector<double> density(component.vertex_count(), 1.0);
  if (!options.density.empty())
    for (int v = 0; v < component.vertex_count(); ++v) density[v] = options.density[built.input_vertex[vertex[v]]];
  if (!frames.empty()) multiply_by_frames(component, frames, density);
  for (double& d : density) d = std::clamp(d, kLeastDensity, kMostDensity);
  for (std::size_t v = 0; v < chords.size(); ++v) density[v] *= usual_length / chords[v];
  if (by_curvature) multiply_by_curvature(component, marked, options, usual_length, density, context);
  grade_density(component, usual_length, kGrowth, density, context);
  return density;
}

}  // namespace

void check_wishes(const PolygonSoup& soup, const RemeshOptions& options) {
  const std::vector<char> vertices = used_vertices(soup), faces(soup.face_sizes.size(), 1);
  check_values(options.vertex_guides, vertices, "guide", "vertex");
  check_values(options.face_guides, faces, "guide", "face");
  check_values(options.density, vertices, "density", "vertex");
  check_values(options.vertex_frames, vertices, "frame", "vertex");
  check_values(options.face_frames, faces, "frame", "face");
  check_frames(options.vertex_frames, vertices, "vertex");
  check_frames(options.face_frames, faces, "face");
  std::vector<int> bad;
  for (const auto& edge : options.marked_edges)
    for (const int v : edge)
      if (v < 0 || v >= static_cast<int>(vertices.size())) bad.push_back(v);
  if (!bad.empty())
    throw InputError("index_out_of_range", "A marked edge has an unknown vertex " + std::to_string(bad.front()) + ".", "vertex", bad);
  for (std::size_t i = 0; i < options.strokes.size(); ++i)
    for (const Vector3& p : options.strokes[i].points)
      if (!is_finite(p) && (bad.empty() || bad.back() != static_cast<int>(i))) bad.push_back(static_cast<int>(i));
  if (!bad.empty())
    throw InputError("non_finite_stroke", "Guide " + std::to_string(bad.front()) + " has points that are not finite.", "guide", bad);
}

Wishes wishes_on(const TriangleMesh& component, const std::vector<int>& vertex, const std::vector<int>& face,
                 const BuiltMesh& built, const std::vector<std::array<int, 2>>& marked, const RemeshOptions& options,
                 double usual_length, const std::vector<double>& chords, const RunContext& context) {
  Wishes wishes;
  wishes.corner_frames = at_corners(options.vertex_frames, options.face_frames, Frame{Vector3::Zero(), Vector3::Zero()},
                                    component, vertex, face, built);
  wishes.density = density_of(component, vertex, built, wishes.corner_frames, marked, options, usual_length, chords, context);
  wishes.most_stretch = std::clamp(options.anisotropy, 1.0, kMostFrameStretch);
  for (const Frame& frame : wishes.corner_frames)
    if (!is_free(frame)) wishes.most_stretch = std::max(wishes.most_stretch, stretch_ratio(frame));
  if (!wishes.corner_frames.empty() || !wishes.density.empty())
    wishes.index = std::make_shared<const SurfaceIndex>(component, std::vector<int>{});
  return wishes;
}

void add_directions(const TriangleMesh& component, const std::vector<int>& vertex, const std::vector<int>& face,
                    const BuiltMesh& built, const RemeshOptions& options, Wishes& wishes) {
  std::vector<Vector3> guides =
      at_corners(options.vertex_guides, options.face_guides, Vector3(0, 0, 0), component, vertex, face, built);
  if (!wishes.corner_frames.empty()) put_frames_first(component, wishes.corner_frames, guides);
  if (!guides.empty()) wishes.guides = GuideMap(component, guides);
}

std::vector<double> chord_lengths_on(const TriangleMesh& component, const std::vector<std::array<int, 2>>& marked,
                                     const RemeshOptions& options, double extent, const RunContext& context) {
  constexpr double kLongest = 1 / 8.0, kLeast = 1 / 64.0;  // of the extent, and of the longest
  if (!(options.chord_error > 0)) return {};
  ChordOptions chord;
  chord.error = options.chord_error;
  chord.longest = options.edge_length > 0 ? options.edge_length : kLongest * extent;
  chord.least = kLeast * chord.longest;
  chord.start = std::sqrt(options.chord_error * extent);  // right where the radius is an eighth of the extent
  FeatureOptions asked = feature_options(options, std::min(chord.start, chord.longest));
  asked.marked_edges = marked;
  return chord_lengths(component, detect_features(component, asked, context), chord, context);
}

FeatureOptions feature_options(const RemeshOptions& options, double length) {
  constexpr double kLeastFeature = 3;
  FeatureOptions features;
  features.use_sharp_angle = options.use_sharp_angle;
  features.sharp_angle = options.sharp_angle;
  features.minimum_length = kLeastFeature * length;
  return features;
}

std::vector<double> density_on(const Wishes& wishes, const TriangleMesh& finer, double length, const RunContext& context) {
  if (wishes.density.empty()) return {};
  const TriangleMesh& mesh = wishes.index->mesh();
  std::vector<double> density = wishes.density;  // the vertices of both come first
  for (int v = mesh.vertex_count(); v < finer.vertex_count(); ++v) {
    const int f = wishes.index->nearest(finer.position(v)).face;
    const std::array<double, 3> weight = corner_weights_at(mesh, f, finer.position(v));
    double log_density = 0;
    for (int i = 0; i < 3; ++i) log_density += weight[i] * std::log(wishes.density[mesh.face(f)[i]]);
    density.push_back(std::exp(log_density));
  }
  grade_density(finer, length, kGrowth, density, context);
  return density;
}

WorkingSurfaceOptions working_surface_options(const Wishes& wishes, double quads, bool has_hard_guides) {
  constexpr double kOfMany = 1.1, kFew = 800, kMany = 1600;
  WorkingSurfaceOptions options;
  const bool is_asked_more = has_hard_guides || !wishes.density.empty();
  const double many = is_asked_more ? 0.0 : std::clamp(std::log(quads / kFew) / std::log(kMany / kFew), 0.0, 1.0);
  options.edge_fraction += many * (kOfMany - options.edge_fraction);
  const double shorter = 1 / std::sqrt(wishes.most_stretch);
  options.edge_fraction *= shorter;
  options.feature_edge_limit *= shorter;
  return options;
}

}  // namespace hybrid_quad
