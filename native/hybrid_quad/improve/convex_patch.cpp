#include "hybrid_quad/improve/convex_patch.h"

#include <algorithm>
#include <map>

#include "hybrid_quad/improve/quad_moves.h"

namespace hybrid_quad {

bool PatchGrower::start(int v) {
  if (lies_on_inner_feature(v)) return false;
  quads_.clear();
  looked_at_ = 0;
  taken_.assign(mesh_.quad_count(), 0);
  for (const int q : mesh_.quads_at(v))
    if (!take(q)) return false;
  return fill_notches();
}

bool PatchGrower::grow() {
  const std::vector<int> before = quads_;
  for (const int q : before)
    for (const int v : mesh_.quad(q))
      if (!take_around(v)) return false;
  return quads_.size() > before.size() && fill_notches();
}

/// A patch with a feature inside it is none, however far it grows.
bool PatchGrower::lies_on_inner_feature(int v) const {
  const std::vector<int>& quads = mesh_.quads_at(v);
  return std::any_of(quads.begin(), quads.end(), [&](int q) {
    const int i = mesh_.corner_of(q, v);
    return mesh_.is_feature(v, mesh_.quad(q)[(i + 1) & 3]) && mesh_.across(q, i) >= 0;
  });
}

bool PatchGrower::take(int q) {
  if (taken_[q]) return true;
  if (mesh_.is_locked(q) || static_cast<int>(quads_.size()) >= most_quads_) return false;
  taken_[q] = 1;
  quads_.push_back(q);
  return true;
}

/// Takes the quads at v that can be reached from the set without crossing a feature.
bool PatchGrower::take_around(int v) {
  bool any = true;
  while (any) {
    any = false;
    for (const int q : mesh_.quads_at(v)) {
      if (taken_[q]) continue;
      const int i = mesh_.corner_of(q, v);
      for (const int side : {i, (i + 3) & 3}) {
        const int other = mesh_.across(q, side);
        if (other < 0 || !taken_[other] || mesh_.is_feature(mesh_.quad(q)[side], mesh_.quad(q)[(side + 1) & 3])) continue;
        if (!take(q)) return false;
        any = true;
        break;
      }
    }
  }
  return true;
}

int PatchGrower::count_at(int v) const {
  int count = 0;
  for (const int q : mesh_.quads_at(v)) count += taken_[q];
  return count;
}

/// Takes what is missing where the border turns inwards, until it does so nowhere but around features. The number of quads
/// at a vertex changes only when one is taken there, so that each needs one look.
bool PatchGrower::fill_notches() {
  for (; looked_at_ < quads_.size(); ++looked_at_)
    for (const int v : mesh_.quad(quads_[looked_at_])) {
      const int count = count_at(v);
      if (count >= 3 && count < mesh_.valence(v) && !take_around(v)) return false;
    }
  return true;
}

/// Whether there are vertices enough that could be regular: with less than two no other quads are better.
bool PatchGrower::holds_irregular_vertices(const std::vector<int>& vertices) const {
  int count = 0;
  for (const int v : vertices) count += valence_cost(mesh_, v) > 0.5;
  return count >= least_irregular_;
}

/// Quads that the patch should have at border vertex v between its neighbours along the border.
int PatchGrower::wanted_at(int before, int v, int after) const {
  if (mesh_.is_feature(before, v))
    for (const EditMesh::FeatureLink& link : mesh_.feature_links(v))
      if (link.vertex == after) return link.ideal;
  return count_at(v);
}

std::optional<ConvexPatch> PatchGrower::patch() const {
  ConvexPatch patch;
  patch.quads = quads_;
  std::vector<int> vertices;
  for (const int q : quads_) vertices.insert(vertices.end(), mesh_.quad(q).begin(), mesh_.quad(q).end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  if (!holds_irregular_vertices(vertices)) return std::nullopt;
  std::map<int, int> next;  // along the border
  int inner_sides = 0;
  for (const int q : quads_)
    for (int side = 0; side < 4; ++side) {
      const int a = mesh_.quad(q)[side], b = mesh_.quad(q)[(side + 1) & 3], other = mesh_.across(q, side);
      if (other >= 0 && taken_[other]) {
        if (mesh_.is_feature(a, b)) return std::nullopt;
        ++inner_sides;
      } else if (!next.emplace(a, b).second) {
        return std::nullopt;
      }
    }
  const int edges = inner_sides / 2 + static_cast<int>(next.size());
  if (next.empty() || static_cast<int>(vertices.size() + quads_.size()) - edges != 1) return std::nullopt;
  for (const int v : vertices) {
    if (next.count(v)) continue;
    if (!mesh_.is_free(v) || mesh_.is_pinned(v) || mesh_.on_boundary(v) || !mesh_.feature_links(v).empty()) return std::nullopt;
    patch.inside.push_back(v);
    patch.irregular += mesh_.valence(v) != 4;
  }
  std::vector<int> border{next.begin()->first}, wanted;
  while (border.size() <= next.size() && next.at(border.back()) != border.front()) border.push_back(next.at(border.back()));
  if (border.size() != next.size()) return std::nullopt;
  const std::size_t n = border.size();
  for (std::size_t i = 0; i < n; ++i) {
    wanted.push_back(wanted_at(border[(i + n - 1) % n], border[i], border[(i + 1) % n]));
    const int fewer = count_at(border[i]) - wanted[i];
    if (wanted[i] < 1 || wanted[i] > 2) return std::nullopt;
    if (fewer > 0 && mesh_.valence(border[i]) - fewer < mesh_.least_valence(border[i])) return std::nullopt;
    patch.irregular += fewer != 0;
  }
  const auto corner = std::find(wanted.begin(), wanted.end(), 1) - wanted.begin();
  patch.has_corners = corner < static_cast<std::ptrdiff_t>(n);
  const std::size_t first = patch.has_corners ? static_cast<std::size_t>(corner) : 0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t at = (first + i) % n;
    if (i == 0 || wanted[at] == 1) {
      if (i > 0) patch.sides.back().push_back(border[at]);
      patch.sides.emplace_back();
    }
    patch.sides.back().push_back(border[at]);
  }
  patch.sides.back().push_back(border[first]);
  return patch;
}

}  // namespace hybrid_quad
