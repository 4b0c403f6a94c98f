#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/improve/flaw_measure.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

/// Scaled Jacobian of a quad of the mesh.
double shape_of(const EditMesh& mesh, int q);

/// The quads at some vertices, ascending.
std::vector<int> quads_at(const EditMesh& mesh, const std::vector<int>& vertices);

/// The vertices of the quads at some vertices, ascending.
std::vector<int> with_ring(const EditMesh& mesh, const std::vector<int>& vertices);

/// At or below this scaled Jacobian a quad is concave or a triangle, or hardly better: more than nothing, as files round.
constexpr double kFolded = 0.01;

/// Of some quads together.
struct Shapes {
  int flaws = 0;   ///< FlawMeasure::flaws, summed
  int folded = 0;  ///< quads, kFolded
  double worst = 1, lack = 0;  ///< the least scaled Jacobian; what all lack to a fair one, summed

  bool are_better_than(const Shapes& other) const;
  /// Whether no more are flawed or folded than before, and the worst is fair (a scaled Jacobian of 0.4) or no worse.
  bool are_kept_since(const Shapes& before) const;
};

Shapes shapes_of(const EditMesh& mesh, const std::vector<int>& quads, const FlawMeasure& measure);

/// How to go down. A number of sweeps over the vertices with each softness, in turn.
struct DescentPlan {
  std::array<double, 4> softness{0.3, 0.15, 0.07, 0.03};
  int sweeps = 12;
};

/// Moves vertices downhill on the sum over the corners of their quads of exp(-sine / softness), each in turn to the best of some
/// places a step away, over the surface or along its curve. While that is soft all quads have a say, in the end the worst alone.
class ShapeDescent {
 public:
  /// \param vertices  those among them that may move do
  ShapeDescent(Workpiece& piece, const FlawMeasure& measure, const std::vector<int>& vertices);

  int size() const { return static_cast<int>(vertices_.size()); }  ///< vertices that move
  void descend(const DescentPlan& plan);
  /// Descends. \returns whether shapes are better now; everything is as before otherwise
  bool run(const DescentPlan& plan);

 private:
  bool move(int v, double step);
  /// \param enough  what is no less than this may be anything from it on
  double energy(int v, double enough) const;
  int flaws_at(int v, int enough) const;
  std::vector<VertexPlace> places_at(int v, double step) const;

  Workpiece& piece_;
  const FlawMeasure& measure_;
  std::vector<int> vertices_, quads_;
  double softness_ = 1;
};

}  // namespace hybrid_quad
