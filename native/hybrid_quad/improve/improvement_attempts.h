#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "hybrid_quad/improve/improve.h"
#include "hybrid_quad/improve/restoration.h"

namespace hybrid_quad {

/// Quads that one round has improved.
struct Improved {
  QuadMesh quads;
  ImproveReport report;
  std::vector<Vector3> tips;  ///< that held some of them
  std::vector<int> flawed;
};

/// Improves the same quads again and again, with ever more of what was extracted where improving spoilt it (docs/decisions/0051).
class ImprovementAttempts {
 public:
  /// One round of everything. \param locked  #Q extracted quads that stay as they are  \param released  tips that hold nothing
  using Round = std::function<Improved(const std::vector<char>& locked, const std::vector<Vector3>& released)>;
  /// \param index  of the surface of the component  \param judged  of the surface against which quads are flawed
  ImprovementAttempts(const QuadMesh& extracted, const SurfaceIndex& index, const SurfaceIndex& judged, const Agreement& agreement,
                      const RunContext& context, Round round);

  int flawed_before();  ///< of the extracted quads
  Improved best();      ///< with flaws and what was restored in its report

 private:
  Restoration& restoration();
  Improved attempt();
  Improved with_fewest_flaws();
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
