#include "hybrid_quad/features/narrow_facets.h"

#include <cmath>
#include <map>
#include <queue>
#include <utility>

namespace hybrid_quad {

namespace {

constexpr double kFoldedShare = 0.25;  ///< of its border: less, and a facet lies as its neighbours say
constexpr int kRounds = 3;             ///< what takes other normals may fold what was smooth before

/// Facets between edges that bend, of which the narrow folded ones join others one by one.
class Facets {
 public:
  Facets(const TriangleMesh& mesh, std::vector<Vector3>& normals, const std::vector<char>& is_inner, double bend, double fold, double rise)
      : mesh_(mesh), normals_(normals), is_inner_(is_inner), most_bent_(std::cos(bend)), fold_(std::cos(fold)), facet_(mesh.face_count(), -1) {
    for (int f = 0; f < mesh.face_count(); ++f)
      if (facet_[f] < 0) flood(f);
    find_narrow(rise);
  }

  bool any_narrow() const { return !narrow_.empty(); }

  void join_narrow() {
    std::priority_queue<Border> borders;
    const auto offer = [&](int narrow, int wide) { borders.push({narrow_.at(narrow).border[wide], narrow, wide}); };
    for (const auto& [id, facet] : narrow_)
      for (const auto& [other, worth] : facet.border)
        if (!is_waiting(other)) offer(id, other);
    while (!borders.empty()) {
      const auto [worth, id, wide] = borders.top();
      borders.pop();
      Narrow& facet = narrow_.at(id);
      if (!is_waiting(id) || facet.border[wide] != worth) continue;
      facet.joined = wide;
      take_normals(facet);
      // From now on it is part of the other's side of their neighbours' borders.
      for (const auto& [other, shared] : facet.border) {
        if (!is_waiting(other)) continue;
        narrow_.at(other).border[wide] += shared;
        offer(other, wide);
      }
    }
  }

 private:
  struct Narrow {
    std::vector<int> faces;
    std::map<int, double> border;  ///< what joining others is worth: the length of the border, less for a fold
    int joined = -1;               ///< the wide facet that it is part of by now
  };
  struct Border {
    double worth;
    int narrow, wide;
    bool operator<(const Border& o) const { return worth != o.worth ? worth < o.worth : std::pair(narrow, wide) > std::pair(o.narrow, o.wide); }
  };

  bool is_waiting(int facet) const {
    const auto found = narrow_.find(facet);
    return found != narrow_.end() && found->second.joined < 0;
  }
  double cosine(int h) const { return normals_[h / 3].dot(normals_[mesh_.opposite(h) / 3]); }

  void flood(int seed) {
    facet_[seed] = count_;
    queue_.assign(1, seed);
    for (std::size_t next = 0; next < queue_.size(); ++next)
      for (int h = 3 * queue_[next], end = h + 3; h < end; ++h) {
        if (!is_inner_[h] || cosine(h) < most_bent_) continue;
        const int g = mesh_.opposite(h) / 3;
        if (facet_[g] >= 0) continue;
        facet_[g] = count_;
        queue_.push_back(g);
      }
    ++count_;
  }

  void find_narrow(double rise) {
    struct Measure {
      double area = 0, border = 0, folded = 0, sines = 0;  ///< lengths; sines: times those of the folds' bends
    };
    std::vector<Measure> of(count_);
    const auto is_border = [&](int h) { return mesh_.is_boundary(h) || facet_[h / 3] != facet_[mesh_.opposite(h) / 3]; };
    for (int h = 0; h < mesh_.halfedge_count(); ++h) {
      Measure& facet = of[facet_[h / 3]];
      if (h % 3 == 0) facet.area += mesh_.area(h / 3);
      if (!is_border(h)) continue;
      facet.border += mesh_.edge_length(h);
      if (!is_inner_[h] || cosine(h) >= fold_) continue;
      facet.folded += mesh_.edge_length(h);
      facet.sines += mesh_.edge_length(h) * (cosine(h) > 0 ? std::sqrt(1 - cosine(h) * cosine(h)) : 1);
    }
    for (int f = 0; f < mesh_.face_count(); ++f) {
      const Measure& m = of[facet_[f]];
      if (2 * m.area * m.sines < rise * m.border * m.folded && m.folded > kFoldedShare * m.border) narrow_[facet_[f]].faces.push_back(f);
    }
    for (auto& [id, facet] : narrow_)
      for (const int f : facet.faces)
        for (int h = 3 * f; h < 3 * f + 3; ++h)
          if (is_inner_[h] && is_border(h)) facet.border[facet_[mesh_.opposite(h) / 3]] += mesh_.edge_length(h) * (1 + cosine(h));
  }

  /// From face to face, over the longest edges first.
  void take_normals(const Narrow& narrow) {
    struct Way {
      double length;
      int halfedge;  ///< of the face that has the normal
      bool operator<(const Way& o) const { return length != o.length ? length < o.length : halfedge > o.halfedge; }
    };
    std::priority_queue<Way> ways;
    std::map<int, bool> waits;
    for (const int f : narrow.faces) waits[f] = true;
    const auto is_beside = [&](int facet) {
      const auto found = narrow_.find(facet);
      return facet == narrow.joined || (found != narrow_.end() && found->second.joined == narrow.joined);
    };
    for (const int f : narrow.faces)
      for (int h = 3 * f; h < 3 * f + 3; ++h)
        if (is_inner_[h] && !waits.count(mesh_.opposite(h) / 3) && is_beside(facet_[mesh_.opposite(h) / 3]))
          ways.push({mesh_.edge_length(h), mesh_.opposite(h)});
    while (!ways.empty()) {
      const int h = ways.top().halfedge, g = mesh_.opposite(h) / 3;
      ways.pop();
      if (!std::exchange(waits[g], false)) continue;
      normals_[g] = normals_[h / 3];
      for (int e = 3 * g; e < 3 * g + 3; ++e) {
        if (!is_inner_[e]) continue;
        const auto next = waits.find(mesh_.opposite(e) / 3);
        if (next != waits.end() && next->second) ways.push({mesh_.edge_length(e), e});
      }
    }
  }

  const TriangleMesh& mesh_;
  std::vector<Vector3>& normals_;
  const std::vector<char>& is_inner_;
  double most_bent_, fold_;  ///< cosines
  std::vector<int> facet_;   ///< #F
  std::map<int, Narrow> narrow_;
  std::vector<int> queue_;
  int count_ = 0;
};

}  // namespace

std::vector<Vector3> normals_beside_narrow_facets(const TriangleMesh& mesh, const std::vector<Vector3>& normals,
                                                  const std::vector<char>& is_inner, double bend, double fold, double rise) {
  std::vector<Vector3> seen = normals;
  for (int round = 0; round < kRounds; ++round) {
    Facets facets(mesh, seen, is_inner, bend, fold, rise);
    if (!facets.any_narrow()) break;
    facets.join_narrow();
  }
  return seen;
}

}  // namespace hybrid_quad
