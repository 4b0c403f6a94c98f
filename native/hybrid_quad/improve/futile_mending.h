#pragma once

#include <cstdint>
#include <unordered_set>

#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Where mending, raising shapes, looking for places or untangling failed: quads, known by the shapes of all quads within a few rings. Nothing
/// else decides how it ends (but for untangling four rings, which sees one more), so it need not be tried there again, in this mesh or in one that
/// differs from it elsewhere.
class FutileMending {
 public:
  /// \param edge  mean edge length: a millionth of it makes no difference
  explicit FutileMending(double edge) : unit_(kUnit * edge) {}

  bool knows(const Workpiece& piece, int q) const { return known_.count(surroundings(piece, q)) > 0; }
  void remember(const Workpiece& piece, int q) { known_.insert(surroundings(piece, q)); }

 private:
  static constexpr int kRings = 4;
  static constexpr double kUnit = 1e-6;

  std::uint64_t surroundings(const Workpiece& piece, int q) const;
  std::uint64_t shape_of(const Workpiece& piece, int q) const;

  double unit_;
  std::unordered_set<std::uint64_t> known_;
};

}  // namespace hybrid_quad
