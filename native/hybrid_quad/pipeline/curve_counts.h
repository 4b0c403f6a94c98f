#pragma once

#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/pipeline/component.h"
#include "hybrid_quad/pipeline/remesh.h"

namespace hybrid_quad {

/// Refuses paths that are no simple chains of polygon edges, overlap, or ask for nothing.
/// \throws InputError curve_count_too_small, curve_not_simple, unknown_edge, overlapping_curves; names the elements
void check_curve_counts(const PolygonSoup& soup, const std::vector<CurveCount>& asked);

/// 3 #F: which of the asked curves a half-edge of the built mesh lies on, or -1.
std::vector<int> counted_halfedges(const BuiltMesh& built, const std::vector<CurveCount>& asked);

/// The asked curves as far as they lie on each component, and what comes out on them.
class CurveCountLedger {
 public:
  /// \param asked  as asked_after_repair() has them  \param scale  length in the soup of what is 1 long on the components
  /// \param images  mirror images that the remeshed part and the whole consist of
  CurveCountLedger(const std::vector<CurveCount>& asked, const PolygonSoup& soup, double scale, int images);

  /// What one component is to make of each asked curve: its edges there, and the number for their part of its length.
  /// \param face  #F: face of the domain \param on_domain  3 #F of the domain: the asked curve, or -1
  std::vector<CountedChain> chains_on(const TriangleMesh& component, const std::vector<int>& face,
                                      const std::vector<int>& on_domain);

  /// Counts what came out. \param mesh  the component's quads, without mirror images
  void record(const ComponentPlan& plan, const QuadMesh& mesh);

  std::vector<CurveCountRecord> records() const;

 private:
  struct Account {
    double length = 0;        ///< of the curve on the input
    double found_length = 0;  ///< on components so far
    int got = 0, planned = 0;
    CountObstacle obstacle = CountObstacle::kNone;
    bool is_shared = false;   ///< where repairs of the input brought it, another curve lies
  };
  std::string reason_for(const Account& account, int asked, int parts) const;

  std::vector<CurveCount> asked_;
  std::vector<Account> accounts_;
  int images_;
};

/// What a user should know of curves that got another number than was asked.
std::vector<std::string> warnings_of(const std::vector<CurveCountRecord>& records);

/// How far the numbers of edges on counted curves are from what they should be, all together.
int missed_counts(const FeatureGraph& features, const QuadMesh& mesh);

}  // namespace hybrid_quad
