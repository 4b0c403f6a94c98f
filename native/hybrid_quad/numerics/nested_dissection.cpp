#include "hybrid_quad/numerics/nested_dissection.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "hybrid_quad/base/parallel.h"

namespace hybrid_quad {

namespace {

constexpr int kLeaf = 12;  ///< as many unknowns are eliminated at once whatever couples them

class Dissection {
 public:
  Dissection(const SparseMatrix& lower, const std::vector<Vector3>& places, const RunContext& context)
      : places_(places), context_(context), first_(lower.rows() + 1, 0), set_(lower.rows(), 0) {
    context_.on_progress = nullptr;
    visit_couplings(lower, [this](int i, int j) {
      ++first_[i + 1];
      ++first_[j + 1];
    });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    neighbour_.resize(first_.back());
    std::vector<int> end(first_.begin(), first_.end() - 1);
    visit_couplings(lower, [&](int i, int j) {
      neighbour_[end[i]++] = j;
      neighbour_[end[j]++] = i;
    });
  }

  EliminationForest run() {
    std::vector<int> all(places_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    EliminationForest forest;
    dissect_pieces(std::move(all), context_.threads, forest);
    return forest;
  }

 private:
  struct Separation {
    std::vector<int> low, high, cut;
  };

  template <class Visit>
  static void visit_couplings(const SparseMatrix& lower, const Visit& visit) {
    for (int c = 0; c < lower.outerSize(); ++c)
      for (SparseMatrix::InnerIterator it(lower, c); it; ++it)
        if (it.row() > c) visit(static_cast<int>(it.row()), c);
  }

  /// Gives the unknowns a mark of their own.
  int mark(const std::vector<int>& unknowns) {
    const int mark = ++marks_;
    for (const int i : unknowns) set_[i] = mark;
    return mark;
  }

  static int add_part(const std::vector<int>& own, std::vector<int> children, EliminationForest& forest) {
    EliminationForest::Part part;
    part.begin = static_cast<int>(forest.order.size());
    forest.order.insert(forest.order.end(), own.begin(), own.end());
    part.end = static_cast<int>(forest.order.size());
    part.children = std::move(children);
    forest.parts.push_back(std::move(part));
    return static_cast<int>(forest.parts.size()) - 1;
  }

  /// Puts `added` behind what is in `forest`. \param tops  of `added`; get their numbers there
  static void append(EliminationForest added, std::vector<int>& tops, EliminationForest& forest) {
    const int parts = static_cast<int>(forest.parts.size()), unknowns = static_cast<int>(forest.order.size());
    for (EliminationForest::Part& part : added.parts) {
      part.begin += unknowns;
      part.end += unknowns;
      for (int& child : part.children) child += parts;
      forest.parts.push_back(std::move(part));
    }
    forest.order.insert(forest.order.end(), added.order.begin(), added.order.end());
    for (int& top : tops) top += parts;
  }

  /// \return the parts on top, one for every connected piece
  std::vector<int> dissect_pieces(std::vector<int> unknowns, int threads, EliminationForest& forest) {
    std::vector<int> tops;
    if (static_cast<int>(unknowns.size()) <= kLeaf) {
      if (!unknowns.empty()) tops.push_back(add_part(unknowns, {}, forest));
      return tops;
    }
    const int within = mark(unknowns);
    std::vector<std::vector<int>> pieces;
    for (const int seed : unknowns) {
      if (set_[seed] != within) continue;
      std::vector<int> piece{seed};
      set_[seed] = 0;
      append_reachable(within, piece);
      pieces.push_back(std::move(piece));
    }
    unknowns = {};
    for (std::vector<int>& piece : pieces) tops.push_back(dissect_connected(std::move(piece), threads, forest));
    return tops;
  }

  int dissect_connected(std::vector<int> piece, int threads, EliminationForest& forest) {
    constexpr std::size_t kLarge = 10000, kWideCut = 3;
    if (static_cast<int>(piece.size()) <= kLeaf) return add_part(piece, {}, forest);
    const bool is_large = piece.size() > kLarge;
    if (is_large) context_.checkpoint();
    Separation parted = halved_by_plane(piece);
    // A disk of n unknowns is cut through by about the root of n.
    if (parted.cut.size() * parted.cut.size() > kWideCut * piece.size()) {
      Separation other = halved_by_distance(piece);
      if (other.cut.size() < parted.cut.size()) parted = std::move(other);
    }
    piece = {};
    std::vector<int> children, others;
    if (is_large && threads > 1) {
      // The two sides share no coupling, so that neither looks at a mark of the other.
      EliminationForest high;
      parallel_for(2, 2, [&](int side) {
        if (side == 0) children = dissect_pieces(std::move(parted.low), threads - threads / 2, forest);
        else others = dissect_pieces(std::move(parted.high), threads / 2, high);
      });
      append(std::move(high), others, forest);
    } else {
      children = dissect_pieces(std::move(parted.low), 1, forest);
      others = dissect_pieces(std::move(parted.high), 1, forest);
    }
    children.insert(children.end(), others.begin(), others.end());
    return add_part(parted.cut, std::move(children), forest);
  }

  Separation separated(std::vector<int> low, std::vector<int> high) {
    // Whichever side has fewer unknowns at the cut gives them away.
    const int low_mark = mark(low), high_mark = mark(high);
    std::vector<int> low_cut = coupled_with(low, high_mark), high_cut = coupled_with(high, low_mark);
    Separation parted{std::move(low), std::move(high), {}};
    const bool from_low = low_cut.size() < high_cut.size();
    parted.cut = std::move(from_low ? low_cut : high_cut);
    std::vector<int>& side = from_low ? parted.low : parted.high;
    const int cut_mark = mark(parted.cut);
    side.erase(std::remove_if(side.begin(), side.end(), [&](int k) { return set_[k] == cut_mark; }), side.end());
    return parted;
  }

  /// The half that is fewer couplings away from one end of the piece, and the other.
  /// \param piece  in the order of a breadth-first search, so that the last unknown is at an end
  Separation halved_by_distance(const std::vector<int>& piece) {
    const int within = mark(piece);
    std::vector<int> order{piece.back()};
    set_[piece.back()] = 0;
    append_reachable(within, order);
    const auto middle = order.begin() + static_cast<std::ptrdiff_t>(order.size() / 2);
    return separated({order.begin(), middle}, {middle, order.end()});
  }

  Separation halved_by_plane(std::vector<int> piece) {
    Vector3 least = places_[piece[0]], most = least;
    for (const int i : piece) {
      least = least.cwiseMin(places_[i]);
      most = most.cwiseMax(places_[i]);
    }
    int axis = 0;
    (most - least).maxCoeff(&axis);
    const auto middle = piece.begin() + static_cast<std::ptrdiff_t>(piece.size() / 2);
    std::nth_element(piece.begin(), middle, piece.end(), [&](int i, int j) {
      return places_[i][axis] != places_[j][axis] ? places_[i][axis] < places_[j][axis] : i < j;
    });
    return separated({piece.begin(), middle}, {middle, piece.end()});
  }

  /// Breadth-first search from the unknowns in `found` over those that are marked; their marks go.
  void append_reachable(int within, std::vector<int>& found) {
    for (std::size_t k = 0; k < found.size(); ++k)
      for (int e = first_[found[k]]; e < first_[found[k] + 1]; ++e) {
        const int j = neighbour_[e];
        if (set_[j] != within) continue;
        set_[j] = 0;
        found.push_back(j);
      }
  }

  std::vector<int> coupled_with(const std::vector<int>& side, int other) const {
    std::vector<int> cut;
    for (const int i : side)
      if (std::any_of(neighbour_.begin() + first_[i], neighbour_.begin() + first_[i + 1], [&](int j) { return set_[j] == other; }))
        cut.push_back(i);
    return cut;
  }

  const std::vector<Vector3>& places_;
  RunContext context_;  ///< reports nothing: several pieces at once have no common progress
  std::vector<int> first_, neighbour_;
  std::vector<int> set_;  ///< the latest mark that an unknown got
  std::atomic<int> marks_{0};
};

}  // namespace

EliminationForest nested_dissection(const SparseMatrix& lower, const std::vector<Vector3>& places, const RunContext& context) {
  return Dissection(lower, places, context).run();
}

}  // namespace hybrid_quad
