#include "hybrid_quad/pipeline/guided_input.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <utility>

#include "hybrid_quad/frame_field/guide_map.h"
#include "hybrid_quad/pipeline/symmetric_domain.h"
#include "hybrid_quad/sizing/asked_lengths.h"

namespace hybrid_quad {

namespace {

constexpr double kSquare = 10;  ///< degrees: a ring that is met crosses edges as squarely as that

/// Where a new vertex lies in the mesh before.
struct Place {
  std::array<int, 3> vertex;  ///< of the polygon soup
  std::array<double, 3> weight;
};

std::vector<Place> places_of_new(const BuiltMesh& built, const EmbeddedStrokes& embedded) {
  std::vector<Place> places;
  const int old = built.mesh.vertex_count();
  for (std::size_t i = 0; i < embedded.vertex_face.size(); ++i) {
    const int f = embedded.vertex_face[i];
    Place place;
    place.weight = corner_weights_at(built.mesh, f, embedded.mesh.position(old + static_cast<int>(i)));
    for (int k = 0; k < 3; ++k) place.vertex[k] = built.input_vertex[built.mesh.face(f)[k]];
    places.push_back(place);
  }
  return places;
}

template <class Value>
void extend_with_nearest(const std::vector<Place>& places, std::vector<Value>& values) {
  if (values.empty()) return;
  for (const Place& place : places)
    values.push_back(values[place.vertex[std::max_element(place.weight.begin(), place.weight.end()) - place.weight.begin()]]);
}

/// Lengths are between others as their logarithms are.
void extend_between(const std::vector<Place>& places, std::vector<double>& density) {
  if (density.empty()) return;
  for (const Place& place : places) {
    double sum = 0, weight = 0;
    for (int k = 0; k < 3; ++k) {
      sum += place.weight[k] * std::log(std::clamp(density[place.vertex[k]], kLeastDensity, kMostDensity));
      weight += place.weight[k];
    }
    density.push_back(std::exp(sum / weight));
  }
}

std::array<int, 2> sorted_pair(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// Pairs of vertices that are marked edges, or on counted curves.
std::vector<std::array<int, 2>> kept_edges(const BuiltMesh& built, const RemeshOptions& options) {
  std::vector<std::array<int, 2>> asked = options.marked_edges;
  for (const CurveCount& curve : options.curve_counts)
    for (std::size_t k = 0; k + 1 < curve.vertices.size(); ++k) asked.push_back({curve.vertices[k], curve.vertices[k + 1]});
  const std::vector<char> is_marked = marked_halfedges(built, asked);
  std::vector<std::array<int, 2>> pairs;
  for (int h = 0; h < built.mesh.halfedge_count(); ++h)
    if (is_marked[h] && built.mesh.opposite(h) < h) pairs.push_back({built.mesh.from(h), built.mesh.to(h)});
  return pairs;
}

/// The parts of edges that are marked, and of those on counted curves, in the options.
/// \param kept  what the parts are of
void mark_parts(const EmbeddedStrokes& embedded, const std::vector<std::array<int, 2>>& kept, GuidedInput& out) {
  const std::vector<int>& id = out.built.input_vertex;
  std::set<std::array<int, 2>> marked;
  for (const auto& e : out.options.marked_edges) marked.insert(sorted_pair(e[0], e[1]));
  std::map<std::array<int, 2>, std::set<int>> vertices_of;  // by the ends of the whole edge
  for (std::size_t i = 0; i < embedded.marked_edges.size(); ++i) {
    const auto& [a, b] = kept[embedded.source[i]];
    const std::array<int, 2> whole = sorted_pair(id[a], id[b]);
    const auto& [p, q] = embedded.marked_edges[i];
    if (marked.count(whole)) out.options.marked_edges.push_back({id[p], id[q]});
    for (const int v : {p, q})
      if (v != a && v != b) vertices_of[whole].insert(v);
  }
  for (CurveCount& curve : out.options.curve_counts) {
    std::vector<int> path;
    for (std::size_t k = 0; k < curve.vertices.size(); ++k) {
      path.push_back(curve.vertices[k]);
      if (k + 1 == curve.vertices.size()) break;
      const auto found = vertices_of.find(sorted_pair(curve.vertices[k], curve.vertices[k + 1]));
      if (found == vertices_of.end()) continue;
      const auto start = std::find(id.begin(), id.end(), curve.vertices[k]);
      const Vector3& from = embedded.mesh.position(static_cast<int>(start - id.begin()));
      std::vector<int> between(found->second.begin(), found->second.end());
      std::sort(between.begin(), between.end(), [&](int x, int y) {
        return (embedded.mesh.position(x) - from).squaredNorm() < (embedded.mesh.position(y) - from).squaredNorm();
      });
      for (const int v : between) path.push_back(id[v]);
    }
    curve.vertices = std::move(path);
  }
}

/// Numbers the sets of guides that edges have. \return 3 #F: that of the edge, -1: none
std::vector<int> number_sets(const EmbeddedStrokes& embedded, const std::vector<GuideStroke>& strokes, HardGuides& guides) {
  std::map<std::array<int, 2>, HardGuides::Set> on_edge;
  for (const GuideEdge& e : embedded.edges) {
    HardGuides::Set& set = on_edge[{std::min(e.a, e.b), std::max(e.a, e.b)}];
    set.guides.push_back(e.guide);
    set.is_loop |= strokes[e.guide].kind == GuideKind::kLoop;
  }
  for (const auto& [a, b] : embedded.marked_edges) {
    const auto found = on_edge.find({std::min(a, b), std::max(a, b)});
    if (found != on_edge.end()) found->second.is_marked = true;
  }
  std::map<std::pair<std::vector<int>, bool>, int> numbers;
  std::vector<int> edge_guides(embedded.mesh.halfedge_count(), -1);
  for (int h = 0; h < embedded.mesh.halfedge_count() && !on_edge.empty(); ++h) {
    const int a = embedded.mesh.from(h), b = embedded.mesh.to(h);
    const auto found = on_edge.find({std::min(a, b), std::max(a, b)});
    if (found == on_edge.end()) continue;
    const auto [number, is_new] = numbers.try_emplace({found->second.guides, found->second.is_marked}, static_cast<int>(guides.sets.size()));
    if (is_new) guides.sets.push_back(found->second);
    edge_guides[h] = number->second;
  }
  return edge_guides;
}

std::string text(double value, const char* format) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string shortcoming(int guide, const GuideRecord& record) {
  const bool is_ring = record.kind == GuideKind::kRing;
  const std::string name = "guide " + std::to_string(guide) + (is_ring ? " (ring) " : " (loop) ");
  if (record.fit.edges == 0 && is_ring) return name + "could not be made a strip: it is a chain of edges instead";
  if (!record.fit.is_connected) return name + "is not followed all along";
  if (record.fit.distance > GuideFit::kNear) return name + "is up to " + text(record.fit.distance, "%.2f") + " edge lengths from its edges";
  return name + "crosses edges up to " + text(record.fit.angle, "%.0f") + " degrees from a right angle";
}

}  // namespace

GuidedInput with_guides(BuiltMesh built, int soup_vertices, const RemeshOptions& options, const RunContext& context) {
  GuidedInput out;
  out.options = options;
  if (options.strokes.empty()) {
    out.edge_guides.assign(built.mesh.halfedge_count(), -1);
    out.built = std::move(built);
    return out;
  }
  const double length = options.edge_length > 0 ? options.edge_length
                                                : std::sqrt(built.mesh.total_area() / std::max(1, options.quads));
  const std::vector<std::array<int, 2>> kept = kept_edges(built, options);
  EmbeddedStrokes embedded = embed_strokes(built.mesh, kept, options.strokes, length, context);
  const std::vector<Place> places = places_of_new(built, embedded);
  extend_with_nearest(places, out.options.vertex_guides);
  extend_with_nearest(places, out.options.vertex_frames);
  extend_between(places, out.options.density);
  out.built.input_vertex = std::move(built.input_vertex);
  for (std::size_t i = 0; i < places.size(); ++i) out.built.input_vertex.push_back(soup_vertices + static_cast<int>(i));
  for (const int f : embedded.face) out.built.input_face.push_back(built.input_face[f]);
  out.built.defects = std::move(built.defects);
  const auto mark = [&](int a, int b) {
    out.options.marked_edges.push_back({out.built.input_vertex[a], out.built.input_vertex[b]});
  };
  mark_parts(embedded, kept, out);
  for (const GuideEdge& e : embedded.edges) mark(e.a, e.b);
  out.edge_guides = number_sets(embedded, options.strokes, out.guides);
  out.built.mesh = std::move(embedded.mesh);
  out.guides.traces = std::move(embedded.traces);
  out.warnings = std::move(embedded.warnings);
  return out;
}

std::vector<StrokeTrace> positive_traces(const std::vector<StrokeTrace>& traces, PlaneSet planes) {
  if (planes == 0) return traces;
  std::vector<StrokeTrace> positive;
  for (const StrokeTrace& trace : traces) {
    positive.emplace_back();
    for (const StrokeTrace::Run& run : trace.runs) {
      bool in_run = false;
      for (const SurfacePoint& p : run.samples) {
        bool is_positive = true;
        for (int axis = 0; axis < 3; ++axis) is_positive &= !has_plane(planes, axis) || p.position[axis] >= 0;
        if (is_positive && !in_run) positive.back().runs.emplace_back();
        if (is_positive) positive.back().runs.back().samples.push_back(p);
        in_run = is_positive;
      }
      if (!positive.back().runs.empty() && positive.back().runs.back().samples.size() == run.samples.size())
        positive.back().runs.back().closed = run.closed;
    }
  }
  return positive;
}

std::vector<GuideRecord> measure_guides(const std::vector<GuideStroke>& strokes, const std::vector<StrokeTrace>& traces,
                                        const QuadMesh& quads, const GuidedEdges& guided,
                                        std::vector<std::string>& warnings) {
  std::vector<GuideRecord> records;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    GuideRecord record;
    record.kind = strokes[i].kind;
    const int guide = static_cast<int>(i);
    record.fit = record.kind == GuideKind::kRing ? measure_ring(traces[i], quads, guided.rings, guide)
                                                 : measure_loop(traces[i], quads, guided.chains, guide);
    record.is_met = record.fit.edges > 0 && record.fit.is_connected && record.fit.distance <= GuideFit::kNear && record.fit.angle <= kSquare;
    if (!record.is_met && !traces[i].runs.empty()) warnings.push_back(shortcoming(guide, record));
    records.push_back(record);
  }
  return records;
}

}  // namespace hybrid_quad
