#pragma once

#include <array>
#include <vector>

namespace hybrid_quad {

/// Quads that fill a disk whose border is given, with as few irregular vertices inside as its corners allow.
struct PatchPattern {
  int vertex_count = 0;  ///< those of the border come first, counterclockwise from the first side's begin
  std::vector<std::array<int, 4>> quads;  ///< counterclockwise
  int irregular = 0;     ///< vertices inside with other than four quads
};

/// Patterns for a disk with two to six corners between sides of the given numbers of edges, those first whose number of quads
/// is nearest to the wanted one: a grid for four sides that fit, one irregular vertex for three or five sides, two
/// irregular vertices for two, four (a 3-5 pair) or six sides, each pattern of which is a pair of those of three and five
/// sides along a cut. Empty where no such pattern has edges of whole lengths.
/// Source: Tarini, Closed-form quadrangulation of n-sided patches, Computers & Graphics 2022.
/// \param most  patterns returned
std::vector<PatchPattern> patch_patterns(const std::vector<int>& sides, int quads_wanted, std::size_t most);

/// Patterns for a disk whose border of that many edges has no corner: a grid, as square as can be, in a ring of quads. They
/// differ in how the grid lies. Empty for an odd number.
std::vector<PatchPattern> round_patterns(int edges, std::size_t most);

}  // namespace hybrid_quad
