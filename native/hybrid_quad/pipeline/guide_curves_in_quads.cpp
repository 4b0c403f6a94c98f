#include "hybrid_quad/pipeline/guide_curves_in_quads.h"

#include <algorithm>
#include <set>
#include <utility>

#include "hybrid_quad/assemble/feature_chains.h"
#include "hybrid_quad/quality/quality.h"

namespace hybrid_quad {

namespace {

class GuideSettler {
 public:
  GuideSettler(GuidedQuads& guided, const ComponentPlan& plan, const HardGuides& guides, const ImproveOptions& improve,
               const RemeshOptions& options, const SurfaceIndex& whole, const RunContext& context)
      : guided_(guided), plan_(plan), guides_(guides), improve_(improve), options_(options), whole_(whole), context_(context) {
    improve_.edit_connectivity = false;
    // Rows next to a strip are narrow at first: towards squares they share the width.
    constexpr double kSharing = 0.3;
    if (options.anisotropy <= 1 && options.vertex_frames.empty() && options.face_frames.empty()) improve_.aspect_power = kSharing;
  }

  void put_in(int ring);
  void fit();
  void centre();
  void list_chains();

 private:
  FeatureGraph features_without(int ring) const;
  std::vector<std::array<int, 2>> chain_of(int ring) const;
  std::vector<std::set<int>> guides_of_curves() const;
  bool is_flat(int h) const;
  void take_if_sound(QuadMesh moved);
  int flaws(const QuadMesh& mesh) const { return static_cast<int>(flawed_quads(mesh, whole_, improve_.agreement).size()); }

  GuidedQuads& guided_;
  const ComponentPlan& plan_;
  const HardGuides& guides_;
  ImproveOptions improve_;
  const RemeshOptions& options_;
  const SurfaceIndex& whole_;
  const RunContext& context_;
};

FeatureGraph GuideSettler::features_without(int ring) const {
  std::vector<char> is_feature(plan_.mesh.halfedge_count());
  for (int h = 0; h < plan_.mesh.halfedge_count(); ++h)
    is_feature[h] = guided_.features.is_feature(h) && !guides_.is_ring_only(plan_.guides[h], ring);
  return trace_features(plan_.mesh, is_feature, corners_for_quads(plan_.length), seam_ends(plan_.mesh, options_.symmetry.planes));
}

std::vector<std::array<int, 2>> GuideSettler::chain_of(int ring) const {
  std::vector<char> on_ring(guided_.features.curves.size(), 0);
  for (int h = 0; h < plan_.mesh.halfedge_count(); ++h)
    if (guided_.features.is_feature(h) && guides_.is_ring_only(plan_.guides[h], ring)) on_ring[guided_.features.halfedge_curve[h]] = 1;
  std::vector<std::array<int, 2>> chain;
  for (const QuadMesh::FeatureEdge& e : guided_.mesh.feature_edges)
    if (on_ring[e.curve]) chain.push_back({e.a, e.b});
  return chain;
}

void GuideSettler::put_in(int ring) {
  GuidedQuads next = guided_;
  next.features = features_without(ring);
  if (!insert_ring(next.mesh, next.rings, ring, chain_of(ring), plan_.mesh, guided_.features, next.features)) return;
  order_feature_edges(next.mesh, plan_.mesh, next.features);
  if (options_.improve) {
    const SurfaceIndex index(plan_.mesh, next.features.face_region);
    const RingPulls pulls(next.rings, guides_.traces, next.mesh.positions.size());
    improve_.rings = &pulls;
    improve_quads(next.mesh, plan_.mesh, next.features, index, improve_, context_, &whole_);
  }
  next.flawed = flaws(next.mesh);
  if (next.flawed <= guided_.flawed) guided_ = std::move(next);
}

/// Guides that run along each curve, somewhere at least.
std::vector<std::set<int>> GuideSettler::guides_of_curves() const {
  std::vector<std::set<int>> of_curve(guided_.features.curves.size());
  for (int h = 0; h < plan_.mesh.halfedge_count(); ++h)
    if (guided_.features.is_feature(h) && plan_.guides[h] >= 0) {
      const std::vector<int>& guides = guides_.sets[plan_.guides[h]].guides;
      of_curve[guided_.features.halfedge_curve[h]].insert(guides.begin(), guides.end());
    }
  return of_curve;
}

/// Whether the surface is smooth across a half-edge's edge.
bool GuideSettler::is_flat(int h) const {
  constexpr double kCosine = 0.94;  // of the weak angle of features
  return !plan_.mesh.is_boundary(h) && plan_.mesh.normal(h / 3).dot(plan_.mesh.normal(plan_.mesh.opposite(h) / 3)) > kCosine;
}

void GuideSettler::fit() {
  std::vector<char> chosen(guided_.features.curves.size(), 1);
  for (int h = 0; h < plan_.mesh.halfedge_count(); ++h) {
    const int curve = guided_.features.halfedge_curve[h];
    if (curve >= 0 && (plan_.guides[h] < 0 || guides_.sets[plan_.guides[h]].is_marked || !is_flat(h))) chosen[curve] = 0;
  }
  QuadMesh moved = guided_.mesh;
  fit_to_curves(moved, plan_.mesh, guided_.features, chosen, guided_.rings);
  take_if_sound(std::move(moved));
}

void GuideSettler::centre() {
  QuadMesh moved = guided_.mesh;
  centre_on_guides(moved, guided_.rings, guides_.traces);
  take_if_sound(std::move(moved));
}

void GuideSettler::take_if_sound(QuadMesh moved) {
  const int flawed = flaws(moved);
  if (flawed > guided_.flawed) return;
  guided_.mesh = std::move(moved);
  guided_.flawed = flawed;
}

void GuideSettler::list_chains() {
  const std::vector<std::set<int>> of_curve = guides_of_curves();
  for (const QuadMesh::FeatureEdge& e : guided_.mesh.feature_edges)
    for (const int guide : of_curve[e.curve]) guided_.chains.push_back({e.a, e.b, guide});
}

}  // namespace

void settle_guides(GuidedQuads& guided, const ComponentPlan& plan, const HardGuides& guides, ImproveOptions improve,
                   const RemeshOptions& options, const SurfaceIndex& whole, const RunContext& context) {
  if (plan.guides.empty()) return;
  GuideSettler settler(guided, plan, guides, improve, options, whole, context);
  std::set<int> rings;
  for (const int set : plan.guides)
    if (set >= 0 && guides.is_ring_only(set, guides.sets[set].guides[0])) rings.insert(guides.sets[set].guides[0]);
  for (const int ring : rings) {
    context.checkpoint();
    settler.put_in(ring);
  }
  if (options.fit && options.improve) {
    settler.fit();
    settler.centre();
  }
  settler.list_chains();
}

}  // namespace hybrid_quad
