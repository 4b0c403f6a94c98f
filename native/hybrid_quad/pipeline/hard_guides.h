#pragma once

#include <vector>

#include "hybrid_quad/guide_curves/guide_curves.h"

namespace hybrid_quad {

/// Hard guides on the mesh that is remeshed. Edges refer to `sets` by number.
struct HardGuides {
  struct Set {
    std::vector<int> guides;
    bool is_marked = false;  ///< an edge to keep besides
    bool is_loop = false;    ///< one of the guides is
  };
  std::vector<Set> sets;
  std::vector<StrokeTrace> traces;  ///< by guide

  /// Whether edges of a set are to become a strip along a guide.
  bool is_ring_only(int set, int guide) const {
    return set >= 0 && !sets[set].is_marked && !sets[set].is_loop && sets[set].guides.size() == 1 && sets[set].guides[0] == guide;
  }
};

}  // namespace hybrid_quad
