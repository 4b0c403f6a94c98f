#include "hybrid_quad/improve/workpiece.h"

#include <algorithm>
#include <cmath>

#include "hybrid_quad/base/parallel.h"

namespace hybrid_quad {

namespace {

double mean_edge_length(const EditMesh& mesh) {
  double sum = 0;
  int count = 0;
  for (int q = 0; q < mesh.quad_count(); ++q)
    for (int i = 0; i < 4; ++i) {
      sum += (mesh.positions[mesh.quad(q)[i]] - mesh.positions[mesh.quad(q)[(i + 1) & 3]]).norm();
      ++count;
    }
  return count ? sum / count : 0;
}

std::vector<CurveGeometry> geometry_of(const FeatureGraph& features, const TriangleMesh& input) {
  std::vector<CurveGeometry> curves;
  curves.reserve(features.curves.size());
  for (const FeatureCurve& curve : features.curves) {
    std::vector<Vector3> points;
    points.reserve(curve.vertices.size());
    for (const int v : curve.vertices) points.push_back(input.position(v));
    curves.emplace_back(std::move(points), curve.closed);
  }
  return curves;
}

}  // namespace

Workpiece::Workpiece(const QuadMesh& quads, const TriangleMesh& input_mesh, const FeatureGraph& feature_graph,
                     const SurfaceIndex& surface_index)
    : input(input_mesh), features(feature_graph), index(surface_index), mesh(quads, input_mesh, feature_graph),
      h(mean_edge_length(mesh)), curves(geometry_of(feature_graph, input_mesh)), face(quads.near_face),
      arc(quads.positions.size(), 0.0), previous(quads.positions.size(), -1), next(quads.positions.size(), -1),
      region(quads.quads.size(), -1) {
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (!mesh.is_free(v)) face[v] = -1;
  for (const int r : features.face_region) region_count = std::max(region_count, r + 1);
}

void Workpiece::bind_all(const RunContext& context) {
  find_quad_regions();
  std::vector<Vector3> normals(mesh.vertex_count(), Vector3::Zero());
  for (int q = 0; q < mesh.quad_count(); ++q) {
    const auto& v = mesh.quad(q);
    const Vector3 n = (mesh.positions[v[2]] - mesh.positions[v[0]]).cross(mesh.positions[v[3]] - mesh.positions[v[1]]);
    for (const int corner : v) normals[corner] += n;
  }
  parallel_chunks(mesh.vertex_count(), context, [&](int begin, int end) {
    for (int v = begin; v < end; ++v)
      if (mesh.is_free(v)) {
        const Vector3 extracted = mesh.positions[v];
        bind_free(v, normals[v]);
        if (mesh.is_pinned(v)) mesh.positions[v] = extracted;
      } else if (mesh.kind(v) == VertexKind::kCorner && mesh.anchor(v) >= 0 && mesh.anchor(v) < input.vertex_count()) {
        mesh.positions[v] = input.position(mesh.anchor(v));
      }
  });
  place_on_curves();
}

void Workpiece::locate_all(const RunContext& context) {
  const std::vector<Vector3> positions = mesh.positions;
  bind_all(context);
  mesh.positions = positions;
}

void Workpiece::bind_free(int v, const Vector3& normal) {
  SurfaceIndex::Filter filter;
  filter.region = region_filter(mesh.anchor(v));
  filter.hint = face[v];
  const double length = normal.norm();
  constexpr double kAgrees = 0.1, kWorthInEdges = 0.5, kNearInEdges = 0.1;
  if (face[v] >= 0 && length > 0 && (filter.region < 0 || features.face_region[face[v]] == filter.region)) {
    // A walk stays on the vertex's sheet, however near another one is.
    const SurfacePoint walked = walk(mesh.positions[v], face[v]);
    if (walked.squared_distance < std::pow(kNearInEdges * h, 2) && input.normal(walked.face).dot(normal) > kAgrees * length) {
      face[v] = walked.face;
      mesh.positions[v] = walked.position;
      return;
    }
  }
  SurfacePoint point = index.nearest(mesh.positions[v], filter);
  if (length > 0 && point.face >= 0 && input.normal(point.face).dot(normal) < kAgrees * length) {
    // Perhaps the far side of a thin part. But a quad that starts inverted has a wrong normal: believe it only where
    // that costs little distance.
    filter.normal = normal / length;
    filter.min_cosine = kAgrees;
    filter.within = std::sqrt(point.squared_distance) + kWorthInEdges * h;
    const SurfacePoint agreeing = index.nearest(mesh.positions[v], filter);
    if (agreeing.face >= 0) point = agreeing;
  }
  if (point.face < 0) point = index.nearest(mesh.positions[v]);
  if (point.face < 0) return;
  face[v] = point.face;
  mesh.positions[v] = point.position;
}

int Workpiece::add_vertex(const Vector3& position, int region_id, const Vector3& normal, int near) {
  const int v = mesh.add_vertex(position, region_id);
  face.push_back(near);
  arc.push_back(0);
  previous.push_back(-1);
  next.push_back(-1);
  bind_free(v, normal);
  return v;
}

int Workpiece::add_quad(const EditMesh::Quad& corners, int region_id) {
  region.push_back(region_id);
  return mesh.add_quad(corners);
}

void Workpiece::place_on_curves() {
  const int n = mesh.vertex_count();
  const auto usable = [&](int curve) { return curve >= 0 && curve < static_cast<int>(curves.size()); };
  // Links of curve vertices first, so that a chain can be walked from any of them.
  for (int v = 0; v < n; ++v)
    if (mesh.kind(v) == VertexKind::kCurve)
      for (const EditMesh::FeatureLink& link : mesh.feature_links(v))
        if (link.curve == mesh.anchor(v)) (link.forward ? next : previous)[v] = link.vertex;
  std::vector<char> placed(n, 0);
  for (int seed = 0; seed < n; ++seed) {
    if (placed[seed] || mesh.kind(seed) != VertexKind::kCurve || !usable(mesh.anchor(seed))) continue;
    const CurveGeometry& curve = curves[mesh.anchor(seed)];
    int first = seed;
    for (int left = n; left > 0 && previous[first] >= 0 && mesh.kind(previous[first]) == VertexKind::kCurve; --left) {
      first = previous[first];
      if (first == seed) break;
    }
    std::vector<int> chain;
    for (int v = first; v >= 0 && mesh.kind(v) == VertexKind::kCurve && !placed[v]; v = next[v]) {
      placed[v] = 1;
      chain.push_back(v);
    }
    std::vector<Vector3> points;
    for (const int v : chain) points.push_back(mesh.positions[v]);
    std::vector<double> arcs;
    if (!curve.closed() && previous[chain.front()] >= 0 && next[chain.back()] >= 0) {
      points.insert(points.begin(), curve.points().front());
      points.push_back(curve.points().back());
      arcs = chain_arc_lengths(curve, points, true);
      arcs.erase(arcs.begin());
    } else {
      arcs = chain_arc_lengths(curve, points, false);
    }
    for (std::size_t i = 0; i < chain.size(); ++i) {
      arc[chain[i]] = arcs[i];
      mesh.positions[chain[i]] = curve.at(arcs[i]);
    }
  }
}

void Workpiece::find_quad_regions() {
  std::vector<int> reached;
  for (int q = 0; q < mesh.quad_count(); ++q) {
    for (const int v : mesh.quad(q))
      if (mesh.is_free(v) && region_filter(mesh.anchor(v)) >= 0) region[q] = mesh.anchor(v);
    if (region[q] >= 0) reached.push_back(q);
  }
  // Quads between curves only: the region beyond a side that is no feature, or the side of the curve they lie on.
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (int side = 0; side < 4; ++side) {
      const int q = reached[i];
      if (mesh.is_feature(mesh.quad(q)[side], mesh.quad(q)[(side + 1) & 3])) continue;
      const int other = mesh.across(q, side);
      if (other < 0 || region[other] >= 0) continue;
      region[other] = region[q];
      reached.push_back(other);
    }
  for (int q = 0; q < mesh.quad_count(); ++q) {
    for (int side = 0; side < 4 && region[q] < 0; ++side) {
      const int a = mesh.quad(q)[side], b = mesh.quad(q)[(side + 1) & 3];
      for (const EditMesh::FeatureLink& link : mesh.feature_links(a)) {
        if (link.vertex != b || link.curve < 0 || link.curve >= static_cast<int>(features.curves.size())) continue;
        const std::vector<int>& along = features.curves[link.curve].vertices;
        const int from = link.forward ? along[0] : along[1], to = link.forward ? along[1] : along[0];
        int out = input.outgoing(from);
        const int first = out;
        while (out >= 0 && input.to(out) != to) {
          out = input.rotate_ccw(out);
          if (out == first) out = -1;
        }
        if (out >= 0) region[q] = features.face_region[TriangleMesh::face_of(out)];
      }
    }
  }
}

double Workpiece::gap(int v, int direction) const {
  const CurveGeometry& curve = curves[mesh.anchor(v)];
  const int other = direction > 0 ? next[v] : previous[v];
  const bool inner = other >= 0 && mesh.kind(other) == VertexKind::kCurve;
  if (!inner && curve.closed()) return curve.length() / 2;
  const double end = inner ? arc[other] : direction > 0 ? curve.length() : 0.0;
  const double distance = direction > 0 ? end - arc[v] : arc[v] - end;
  return curve.closed() && distance <= 0 ? distance + curve.length() : distance;
}

double Workpiece::room(int v, int direction, double edge) const {
  constexpr double kPartOfGap = 0.8, kLeastGap = 0.1;
  const double between = gap(v, direction);
  return std::max(0.0, std::min(kPartOfGap * between, between - kLeastGap * edge));
}

double Workpiece::edge_at(int v) const {
  double sum = 0;
  for (const int q : mesh.quads_at(v)) {
    const int i = mesh.corner_of(q, v);
    for (const int side : {1, 3}) sum += (mesh.positions[mesh.quad(q)[(i + side) & 3]] - mesh.positions[v]).norm();
  }
  return sum / (2.0 * mesh.valence(v));
}

bool Workpiece::may_move(int v) const { return !mesh.is_pinned(v) && (mesh.is_free(v) ? face[v] >= 0 : may_slide(v)); }

void Workpiece::put(int v, const VertexPlace& place) {
  mesh.positions[v] = place.position;
  face[v] = place.face;
  arc[v] = place.arc;
}

double Workpiece::weighted_gap(int v, int direction) const {
  const CurveGeometry& curve = curves[mesh.anchor(v)];
  const int other = direction > 0 ? next[v] : previous[v];
  const bool inner = other >= 0 && mesh.kind(other) == VertexKind::kCurve;
  if (!inner && curve.closed()) return curve.weighted_length() / 2;
  const double here = curve.weighted(arc[v]);
  const double end = inner ? curve.weighted(arc[other]) : direction > 0 ? curve.weighted_length() : 0.0;
  const double distance = direction > 0 ? end - here : here - end;
  return curve.closed() && distance <= 0 ? distance + curve.weighted_length() : distance;
}

bool Workpiece::may_slide(int v) const {
  const int curve = mesh.anchor(v);
  return mesh.kind(v) == VertexKind::kCurve && curve >= 0 && curve < static_cast<int>(curves.size()) &&
         curves[curve].length() > 0;
}

}  // namespace hybrid_quad
