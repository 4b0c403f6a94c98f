#pragma once

#include <string>
#include <vector>

#include "hybrid_quad/mesh/mesh_builder.h"

namespace hybrid_quad {

/// A polygon soup in an order that its places alone determine: its vertices are numbered by places and faces by their vertices,
/// so that what is done to it one after the other does not depend on the file. Isolated vertices are left out.
struct OrderedSoup {
  PolygonSoup soup;
  std::vector<int> first_corner;  ///< #F + 1, into soup.face_vertices
  std::vector<int> given_vertex;  ///< #V: index into the given soup
  std::vector<int> given_face;    ///< #F: likewise
};

/// Faces in the order of their corners' places, each from its least corner on; vertices in the order in which faces use them.
/// Faces of the same places stay in their order.
/// \pre used vertices are finite, indices within range
/// \throws Cancelled
OrderedSoup in_order_of_places(const PolygonSoup& given, const RunContext& context = {});

/// Elements ("vertex", "edge" as pairs of vertices, or "face") as they were given, ascending and each once.
std::vector<int> given_elements(const OrderedSoup& ordered, const std::string& kind, std::vector<int> elements);

}  // namespace hybrid_quad
