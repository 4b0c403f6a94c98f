#include "hybrid_quad/quality/quality.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <tuple>

#include "hybrid_quad/base/parallel.h"
#include "hybrid_quad/mesh/bucket_sort.h"
#include "hybrid_quad/mesh/segment_index.h"

namespace hybrid_quad {

namespace {

/// A side of a quad, by its sorted ends.
struct Side {
  int low, high, dart;
  bool same_edge(const Side& other) const { return low == other.low && high == other.high; }
};

std::vector<Side> sorted_sides(const QuadMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(4 * mesh.quads.size());
  for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q)
    for (int i = 0; i < 4; ++i) {
      const int a = mesh.quads[q][i], b = mesh.quads[q][(i + 1) % 4];
      sides.push_back({std::min(a, b), std::max(a, b), 4 * q + i});
    }
  bucket_sort(sides, [](const Side& x) { return x.low; }, [](const Side& x, const Side& y) {
    return std::tie(x.low, x.high, x.dart) < std::tie(y.low, y.high, y.dart);
  });
  return sides;
}

/// Triangles 2 q = (0, 1, 2) and 2 q + 1 = (0, 2, 3) of every quad, glued side by side: two quads may share a diagonal's
/// ends, so vertex pairs would not do.
TriangleMesh triangulated(const QuadMesh& mesh) {
  std::vector<std::array<int, 3>> faces;
  faces.reserve(2 * mesh.quads.size());
  for (const auto& v : mesh.quads) {
    faces.push_back({v[0], v[1], v[2]});
    faces.push_back({v[0], v[2], v[3]});
  }
  const auto halfedge_of_dart = [](int dart) {
    static constexpr int kHalfedge[4] = {0, 1, 4, 5};
    return 6 * (dart / 4) + kHalfedge[dart % 4];
  };
  std::vector<int> opposite(3 * faces.size(), -1);
  for (int q = 0; q < static_cast<int>(mesh.quads.size()); ++q) {
    opposite[6 * q + 2] = 6 * q + 3;
    opposite[6 * q + 3] = 6 * q + 2;
  }
  const std::vector<Side> sides = sorted_sides(mesh);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i)
    if (sides[i].same_edge(sides[i + 1])) {
      const int g = halfedge_of_dart(sides[i].dart), h = halfedge_of_dart(sides[i + 1].dart);
      opposite[g] = h;
      opposite[h] = g;
    }
  return TriangleMesh(mesh.positions, std::move(faces), std::move(opposite));
}

/// Points spread evenly over a mesh's area: systematic in the area, a low-discrepancy sequence in the triangles
/// (Roberts' R2).
std::vector<Vector3> area_samples(const TriangleMesh& mesh, int count) {
  std::vector<double> until(mesh.face_count());
  double total = 0;
  for (int f = 0; f < mesh.face_count(); ++f) until[f] = total += mesh.area(f);
  std::vector<Vector3> points;
  if (!(total > 0)) return points;
  points.reserve(count);
  constexpr double kPlastic = 1.32471795724474602596;
  int f = 0;
  for (int i = 0; i < count; ++i) {
    const double target = total * (i + 0.5) / count;
    while (f + 1 < mesh.face_count() && until[f] < target) ++f;
    double u = std::fmod(0.5 + (i + 1) / kPlastic, 1.0), v = std::fmod(0.5 + (i + 1) / (kPlastic * kPlastic), 1.0);
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const auto& t = mesh.face(f);
    points.push_back((1 - u - v) * mesh.position(t[0]) + u * mesh.position(t[1]) + v * mesh.position(t[2]));
  }
  return points;
}

/// At most `count` of the vertices that have a face, evenly strided.
std::vector<Vector3> vertex_samples(const TriangleMesh& mesh, int count, int* used) {
  std::vector<int> vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (mesh.outgoing(v) >= 0) vertices.push_back(v);
  *used = static_cast<int>(vertices.size());
  const std::size_t n = std::min<std::size_t>(vertices.size(), count);
  std::vector<Vector3> points;
  points.reserve(n);
  for (std::size_t i = 0; i < n; ++i) points.push_back(mesh.position(vertices[i * vertices.size() / n]));
  return points;
}

struct Tally {
  double sum = 0, largest = 0;
};

/// Sum and maximum of distance(i) for i in [0, count), in chunks of a fixed size, so that neither depends on how
/// many threads there are.
Tally tally(int count, const RunContext& context, const std::function<double(int)>& distance) {
  constexpr int kChunk = 1024;
  const int chunks = (count + kChunk - 1) / kChunk;
  std::vector<Tally> parts(chunks);
  context.checkpoint();
  parallel_for(chunks, context.threads, [&](int c) {
    for (int i = c * kChunk; i < std::min(count, (c + 1) * kChunk); ++i) {
      const double d = distance(i);
      parts[c].sum += d;
      parts[c].largest = std::max(parts[c].largest, d);
    }
  });
  Tally all;
  for (const Tally& part : parts) {
    all.sum += part.sum;
    all.largest = std::max(all.largest, part.largest);
  }
  return all;
}

/// Mean over samples of the area and vertices, and the maximum of both, of the distance to `target`. Vertices weigh as
/// if the area had 40 000 samples, however many there are.
Tally one_sided_distance(const TriangleMesh& source, const SurfaceIndex& target, int samples, const RunContext& context) {
  constexpr double kAreaWeight = 40000;
  int vertex_count = 0;
  const std::vector<Vector3> on_faces = area_samples(source, samples);
  const std::vector<Vector3> on_vertices = vertex_samples(source, samples, &vertex_count);
  const auto distances = [&](const std::vector<Vector3>& points) {
    return tally(static_cast<int>(points.size()), context,
                 [&](int i) { return std::sqrt(std::max(0.0, target.nearest(points[i]).squared_distance)); });
  };
  const Tally faces = distances(on_faces), vertices = distances(on_vertices);
  Tally result;
  const double weight = (on_faces.empty() ? 0 : kAreaWeight) + vertex_count;
  if (!on_faces.empty()) result.sum += kAreaWeight * faces.sum / on_faces.size();
  if (!on_vertices.empty()) result.sum += vertex_count * vertices.sum / on_vertices.size();
  if (weight > 0) result.sum /= weight;
  result.largest = std::max(faces.largest, vertices.largest);
  return result;
}

/// Points no further apart than `step` along every curve, ends included.
std::vector<Vector3> curve_samples(const TriangleMesh& input, const FeatureGraph& features, double step) {
  constexpr double kMostPerEdge = 1000;
  std::vector<Vector3> points;
  for (const FeatureCurve& curve : features.curves)
    for (std::size_t i = 0; i + 1 < curve.vertices.size(); ++i) {
      const Vector3 a = input.position(curve.vertices[i]), b = input.position(curve.vertices[i + 1]);
      const int n = static_cast<int>(std::max(1.0, std::min(kMostPerEdge, std::ceil((b - a).norm() / step))));
      for (int k = 0; k <= n; ++k) points.push_back(a + (static_cast<double>(k) / n) * (b - a));
    }
  return points;
}

}  // namespace

double scaled_jacobian(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  const std::array<Vector3, 4> p{a, b, c, d};
  Vector3 normal = (c - a).cross(d - b);
  const double length = normal.norm();
  if (!(length > 0)) return -1;
  normal /= length;
  double least = 1;
  for (int i = 0; i < 4; ++i) {
    const Vector3 forth = p[(i + 1) % 4] - p[i], back = p[(i + 3) % 4] - p[i];
    const double size = forth.norm() * back.norm();
    least = std::min(least, size > 0 ? forth.cross(back).dot(normal) / size : 0.0);
  }
  return least;
}

ShapeQuality shape_quality(const QuadMesh& mesh) {
  constexpr double kPoor = 0.2;
  ShapeQuality quality;
  std::vector<double> values;
  values.reserve(mesh.quads.size());
  for (const auto& v : mesh.quads)
    values.push_back(scaled_jacobian(mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]], mesh.positions[v[3]]));
  std::sort(values.begin(), values.end());
  if (!values.empty()) {
    quality.scaled_jacobian_mean = std::accumulate(values.begin(), values.end(), 0.0) / values.size();
    quality.scaled_jacobian_min = values.front();
    const double place = 0.01 * (values.size() - 1);
    const std::size_t below = static_cast<std::size_t>(place), above = std::min(below + 1, values.size() - 1);
    quality.scaled_jacobian_p1 = values[below] + (place - below) * (values[above] - values[below]);
    quality.below_zero = static_cast<int>(std::upper_bound(values.begin(), values.end(), 0.0) - values.begin());
    quality.poor = static_cast<int>(std::lower_bound(values.begin(), values.end(), kPoor) - values.begin());
  }
  std::vector<int> valence(mesh.positions.size(), 0);
  std::vector<char> boundary(mesh.positions.size(), 0);
  for (const auto& quad : mesh.quads)
    for (const int v : quad) ++valence[v];
  const std::vector<Side> sides = sorted_sides(mesh);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const bool shared = (i > 0 && sides[i].same_edge(sides[i - 1])) || (i + 1 < sides.size() && sides[i].same_edge(sides[i + 1]));
    if (!shared) boundary[sides[i].low] = boundary[sides[i].high] = 1;
  }
  for (std::size_t v = 0; v < valence.size(); ++v)
    quality.irregular_vertices += valence[v] > 0 && !boundary[v] && valence[v] != 4;
  return quality;
}

SurfaceDistance surface_distance(const QuadMesh& quads, const SurfaceIndex& input, const RunContext& context, int samples) {
  SurfaceDistance distance;
  const double diagonal = input.mesh().diagonal();
  if (quads.quads.empty() || !(diagonal > 0)) return distance;
  const TriangleMesh triangles = triangulated(quads);
  const SurfaceIndex output(triangles, {}, context);
  const Tally there = one_sided_distance(triangles, input, samples / 2, context);
  const Tally back = one_sided_distance(input.mesh(), output, samples / 2, context);
  distance.quads_to_input_max = 100 * there.largest / diagonal;
  distance.input_to_quads_max = 100 * back.largest / diagonal;
  distance.mean = 100 * (there.sum + back.sum) / 2 / diagonal;
  return distance;
}

double mean_distance_in_edges(const QuadMesh& quads, const SurfaceIndex& input, const RunContext& context) {
  constexpr int kSamplesPerQuad = 8, kLeast = 4000, kMost = 100000;
  const int samples = std::clamp(kSamplesPerQuad * static_cast<int>(quads.quads.size()), kLeast, kMost);
  const double length = std::sqrt(input.mesh().total_area() / static_cast<double>(quads.quads.size()));
  return surface_distance(quads, input, context, samples).mean / 100 * input.mesh().diagonal() / length;
}

std::vector<SurfacePoint> nearest_on_quads(const std::vector<Vector3>& points, const QuadMesh& quads, const RunContext& context) {
  const TriangleMesh triangles = triangulated(quads);
  const SurfaceIndex index(triangles, {}, context);
  std::vector<SurfacePoint> out(points.size());
  parallel_chunks(static_cast<int>(points.size()), context, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      out[i] = index.nearest(points[i]);
      out[i].face /= 2;
    }
  });
  return out;
}

FarthestPlace farthest_from_quads(const TriangleMesh& surface, const QuadMesh& quads, const RunContext& context) {
  constexpr std::size_t kPerQuad = 8, kLeast = 4000;
  const std::size_t wanted = std::max(kLeast, kPerQuad * quads.quads.size());
  const int stride = std::max(1, static_cast<int>(surface.vertex_count() / wanted));
  std::vector<Vector3> places;
  for (int v = 0; v < surface.vertex_count(); v += stride)
    if (surface.outgoing(v) >= 0) places.push_back(surface.position(v));
  const std::vector<SurfacePoint> nearest = nearest_on_quads(places, quads, context);
  const auto farthest = std::max_element(nearest.begin(), nearest.end(), [](const SurfacePoint& a, const SurfacePoint& b) {
    return a.squared_distance < b.squared_distance;
  });
  return {places[farthest - nearest.begin()], std::sqrt(farthest->squared_distance) / mean_edge_length(quads)};
}

DirectedDistance directed_distance(const TriangleMesh& from, const SurfaceIndex& to, const RunContext& context, int samples) {
  const Tally tally = one_sided_distance(from, to, samples, context);
  return {tally.largest, tally.sum};
}

std::vector<double> point_distances(const std::vector<Vector3>& points, const SurfaceIndex& to, const RunContext& context) {
  std::vector<double> out(points.size());
  parallel_chunks(static_cast<int>(points.size()), context, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) out[i] = std::sqrt(to.nearest(points[i]).squared_distance);
  });
  return out;
}

double feature_distance(const QuadMesh& quads, const TriangleMesh& input, const FeatureGraph& features,
                        const RunContext& context) {
  const double diagonal = input.diagonal();
  if (features.curves.empty() || !(diagonal > 0)) return 0;
  std::vector<std::array<Vector3, 2>> segments;
  segments.reserve(quads.feature_edges.size());
  for (const QuadMesh::FeatureEdge& e : quads.feature_edges)
    segments.push_back({quads.positions[e.a], quads.positions[e.b]});
  if (segments.empty()) return 100;
  const SegmentIndex index(std::move(segments));
  const std::vector<Vector3> points = curve_samples(input, features, diagonal / 1000);
  const Tally all = tally(static_cast<int>(points.size()), context,
                          [&](int i) { return std::sqrt(index.nearest(points[i]).squared_distance); });
  return 100 * all.largest / diagonal;
}

}  // namespace hybrid_quad
