#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/mesh/quad_complex.h"

namespace hybrid_quad {

/// Local changes of a quad complex that keep it a complex of the same topology, with its curves, corners and
/// border. Removed quads stay in the arrays, marked, until compact().
class ComplexEditor {
 public:
  explicit ComplexEditor(QuadComplex& complex);

  const QuadComplex& complex() const { return complex_; }
  bool alive(int q) const { return alive_[q] != 0; }
  int alive_count() const { return alive_count_; }
  int corner_count(int v) const { return corners_[v]; }
  bool on_border(int v) const { return border_[v] != 0; }

  /// Whether the quad of dart d may vanish by making its corners from(d) and from(d + 2) one vertex: they are
  /// two, at most one of them is on the border and at most one is bound to a curve or corner, and no two
  /// feature or border sides would be laid on each other.
  bool can_collapse(int d) const;

  /// Collapses that quad. from(d) stays, with its position, unless from(d + 2) is more bound or on the
  /// border. \pre can_collapse(d) \return the vertex that stayed
  int collapse(int d);

  /// Puts a smaller quad into q and four quads around it: every corner of q gains one quad.
  /// \param anchor  of the four new vertices (free)
  void inset(int q, int anchor);

  /// Whether restar(d) is possible: an inner side that is no feature between two quads, whose end can spare a
  /// quad.
  bool can_restar(int d) const;
  /// Takes the side d away: the hexagon of its two quads becomes three quads around a new free vertex, which
  /// is joined to from(d). to(d) loses a quad. \pre can_restar(d)
  void restar(int d, int anchor);
  /// How much restar(d) raises the sum of squared differences of valences from 4.
  int restar_valence_cost(int d) const;

  /// Drops removed quads and vertices no quad uses; numbers keep their order.
  /// \return #old vertices: the new number, or -1
  std::vector<int> compact();

 private:
  /// Sides that come to lie on each other when a quad collapses: a chain from one outer side to another.
  struct Fold {
    int first = -1, last = -1;  ///< outer darts, -1 beyond the border
    int curve = -1;
    bool allowed = true;
  };
  /// The folds of the quad of dart d. \return their number: 0, 1 or 2
  int folds(int d, std::array<Fold, 2>& out) const;
  int binding(int v) const { return 2 * static_cast<int>(complex_.kind[v]) + border_[v]; }

  QuadComplex& complex_;
  std::vector<char> alive_;
  std::vector<int> corners_;
  std::vector<char> border_;
  int alive_count_ = 0;
};

}  // namespace hybrid_quad
