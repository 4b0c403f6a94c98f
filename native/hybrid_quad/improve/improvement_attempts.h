#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/restoration.h"

namespace hybrid_quad {

/// Improves the same quads again and again, with ever more of what was extracted where improving spoilt it (docs/decisions/0051).
class ImprovementAttempts {
 public:
  /// One round of everything. \param locked  #Q extracted quads that stay as they are  \param released  tips that hold nothing
  using Round = std::function<Improved(const std::vector<char>& locked, const std::vector<Vector3>& released)>;
  /// \param index  of the surface of the component  \param judged  of the surface against which quads are flawed
  ImprovementAttempts(const QuadMesh& extracted, const SurfaceIndex& index, const SurfaceIndex& judged, const Agreement& agreement,
                      const RunContext& context, Round round);

  int flawed_before();  ///< of the extracted quads
  Improved once();      ///< the first attempt, with flaws in its report
  /// With what was restored in its report. \param first  what once() made of the same quads, if it did
  Improved best(std::optional<Improved> first);

 private:
  Restoration& restoration();
  Improved attempt();
  Improved with_fewest_flaws(std::optional<Improved> first);
  void return_to_surface(Improved& best);

  const QuadMesh& extracted_;
  const SurfaceIndex& index_;
  const SurfaceIndex& judged_;
  const Agreement& agreement_;
  const RunContext& context_;
  const Round round_;
  std::optional<Restoration> restoration_;
  std::vector<Vector3> released_;  ///< tips that hold nothing
};

}  // namespace hybrid_quad
