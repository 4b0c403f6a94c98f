#include "hybrid_quad/pipeline/curve_counts.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace hybrid_quad {

namespace {

std::array<int, 2> sorted_pair(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

std::string name_of(std::size_t i) { return "Curve " + std::to_string(i) + " of curve_counts"; }

void check_path(const CurveCount& curve, std::size_t i, int vertex_count) {
  if (curve.count < 1)
    throw InputError("curve_count_too_small", name_of(i) + " is to get " + std::to_string(curve.count) + " quads.", "vertex", curve.vertices);
  for (const int v : curve.vertices)
    if (v < 0 || v >= vertex_count)
      throw InputError("index_out_of_range", name_of(i) + " has an unknown vertex " + std::to_string(v) + ".", "vertex", {v});
  std::vector<int> sorted(curve.vertices.begin(), curve.vertices.end());
  const bool closed = sorted.size() > 3 && sorted.front() == sorted.back();
  if (closed) sorted.pop_back();
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (sorted.size() < 2 || twice != sorted.end())
    throw InputError("curve_not_simple", name_of(i) + " has no edge, or passes a vertex twice.", "vertex",
                     twice == sorted.end() ? curve.vertices : std::vector<int>{*twice});
}

/// Number of edges of each curve.
std::vector<int> edges_by_curve(std::size_t curves, const QuadMesh& mesh) {
  std::vector<int> count(curves, 0);
  for (const QuadMesh::FeatureEdge& e : mesh.feature_edges) ++count[e.curve];
  return count;
}

}  // namespace

void check_curve_counts(const PolygonSoup& soup, const std::vector<CurveCount>& asked) {
  constexpr double kMostEdges = 5e6;  // as many as quads may be asked for
  if (asked.empty()) return;
  double edges = 0;
  for (const CurveCount& each : asked) edges += each.count;
  if (edges > kMostEdges) throw InputError("wrong_count", "The curves of curve_counts ask for more than five million edges.", "", {});
  std::map<std::array<int, 2>, int> curve_of;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    check_path(asked[i], i, static_cast<int>(soup.positions.size()));
    const std::vector<int>& path = asked[i].vertices;
    for (std::size_t k = 0; k + 1 < path.size(); ++k)
      if (!curve_of.emplace(sorted_pair(path[k], path[k + 1]), static_cast<int>(i)).second)
        throw InputError("overlapping_curves", name_of(i) + " has an edge that is listed already.", "edge", {path[k], path[k + 1]});
  }
  std::map<std::array<int, 2>, int> missing = curve_of;
  std::size_t first = 0;
  for (const int size : soup.face_sizes) {
    for (int k = 0; k < size; ++k)
      missing.erase(sorted_pair(soup.face_vertices[first + k], soup.face_vertices[first + (k + 1) % size]));
    first += size;
  }
  if (missing.empty()) return;
  const auto& [pair, curve] = *missing.begin();
  throw InputError("unknown_edge", name_of(curve) + ": vertices " + std::to_string(pair[0]) + " and " + std::to_string(pair[1]) +
                                       " are no edge of the mesh.", "edge", {pair[0], pair[1]});
}

std::vector<int> counted_halfedges(const BuiltMesh& built, const std::vector<CurveCount>& asked) {
  std::vector<int> on(built.mesh.halfedge_count(), -1);
  if (asked.empty()) return on;
  std::map<std::array<int, 2>, int> curve_of;
  for (std::size_t i = 0; i < asked.size(); ++i)
    for (std::size_t k = 0; k + 1 < asked[i].vertices.size(); ++k)
      curve_of.emplace(sorted_pair(asked[i].vertices[k], asked[i].vertices[k + 1]), static_cast<int>(i));
  for (int h = 0; h < built.mesh.halfedge_count(); ++h) {
    const auto found = curve_of.find(sorted_pair(built.input_vertex[built.mesh.from(h)], built.input_vertex[built.mesh.to(h)]));
    if (found != curve_of.end()) on[h] = found->second;
  }
  return on;
}

CurveCountLedger::CurveCountLedger(const std::vector<CurveCount>& asked, const PolygonSoup& soup, double scale, int images)
    : asked_(asked), accounts_(asked.size()), images_(images) {
  std::map<std::array<int, 2>, std::size_t> curve_of;
  for (std::size_t i = 0; i < asked.size(); ++i)
    for (std::size_t k = 0; k + 1 < asked[i].vertices.size(); ++k) {
      const int a = asked[i].vertices[k], b = asked[i].vertices[k + 1];
      accounts_[i].length += (soup.positions[b] - soup.positions[a]).norm() / scale;
      if (a != b && curve_of.emplace(sorted_pair(a, b), i).first->second != i) accounts_[i].is_shared = true;
    }
}

std::vector<CountedChain> CurveCountLedger::chains_on(const TriangleMesh& component, const std::vector<int>& face,
                                                      const std::vector<int>& on_domain) {
  std::vector<CountedChain> chains(asked_.size());
  if (asked_.empty()) return chains;
  std::vector<double> length(asked_.size(), 0.0);
  for (int h = 0; h < component.halfedge_count(); ++h) {
    const int curve = on_domain[3 * face[h / 3] + h % 3];
    if (curve < 0 || component.opposite(h) > h) continue;
    chains[curve].edges.push_back({component.from(h), component.to(h)});
    length[curve] += component.edge_length(h);
  }
  for (std::size_t i = 0; i < chains.size(); ++i) {
    if (chains[i].edges.empty() || !(accounts_[i].length > 0)) continue;
    const double share = length[i] / accounts_[i].length;
    chains[i].count = std::max(1, static_cast<int>(std::lround(asked_[i].count * share)));
    accounts_[i].found_length += length[i];
  }
  return chains;
}

void CurveCountLedger::record(const ComponentPlan& plan, const QuadMesh& mesh) {
  if (asked_.empty()) return;
  const std::vector<int> edges = edges_by_curve(plan.features.curves.size(), mesh);
  for (std::size_t i = 0; i < accounts_.size(); ++i) {
    for (const int c : plan.chains[i].curves) accounts_[i].got += edges[c];
    accounts_[i].planned += plan.chains[i].count;
    accounts_[i].obstacle = std::max(accounts_[i].obstacle, plan.chains[i].obstacle);
  }
}

std::string CurveCountLedger::reason_for(const Account& account, int asked, int parts) const {
  constexpr double kWhole = 1 - 1e-6;
  if (account.is_shared) return "where the input was repaired, it lies on another of these curves";
  if (!(account.found_length > 0))
    return images_ > 1 ? "it is not on the side of a mirror plane that is kept" : "its edges went when the input was repaired";
  if (images_ == 1 && account.found_length < kWhole * account.length) return "some of its edges went when the input was repaired";
  if (asked % parts != 0) return "a mirror plane cuts it into equal parts";
  if (account.got == account.planned && account.obstacle == CountObstacle::kParity)
    return "with quads alone, this curve and those that close it to a loop need an even number together";
  if (account.got == account.planned && account.obstacle == CountObstacle::kTooFew)
    return "it needs more: one for every stretch between corners, four for a loop";
  return "the quads around it leave no room for that number";
}

std::vector<CurveCountRecord> CurveCountLedger::records() const {
  std::vector<CurveCountRecord> records;
  for (std::size_t i = 0; i < accounts_.size(); ++i) {
    const Account& account = accounts_[i];
    CurveCountRecord record;
    record.asked = asked_[i].count;
    const double share = account.length > 0 ? account.found_length / account.length : 0;
    // How often it is part of the whole: parts and their images make up one curve, sheets that were torn apart have one each.
    const int parts = share > 0 && images_ > 1 ? std::max(1, static_cast<int>(std::lround(1 / share))) : 1;
    const int sheets = std::max(1, static_cast<int>(std::lround(share)));
    record.got = parts * account.got / sheets;
    if (record.got != record.asked) record.reason = reason_for(account, record.asked, parts);
    records.push_back(std::move(record));
  }
  return records;
}

std::vector<std::string> warnings_of(const std::vector<CurveCountRecord>& records) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < records.size(); ++i)
    if (records[i].got != records[i].asked)
      warnings.push_back("asked for " + std::to_string(records[i].asked) + " quads along " + name_of(i) + ", got " +
                         std::to_string(records[i].got) + ": " + records[i].reason);
  return warnings;
}

int missed_counts(const FeatureGraph& features, const QuadMesh& mesh) {
  const std::vector<int> edges = edges_by_curve(features.curves.size(), mesh);
  int missed = 0;
  for (std::size_t c = 0; c < edges.size(); ++c)
    if (features.curves[c].asked_count > 0) missed += std::abs(edges[c] - features.curves[c].asked_count);
  return missed;
}

}  // namespace hybrid_quad
