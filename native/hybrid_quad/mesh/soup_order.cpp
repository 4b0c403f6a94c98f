#include "hybrid_quad/mesh/soup_order.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>

namespace hybrid_quad {

namespace {

/// For every used vertex the number of its place, by coordinates; 0 for others. \param count  receives how many places there are
std::vector<int> places_of(const PolygonSoup& soup, int& count, const RunContext& context) {
  std::vector<char> is_used(soup.positions.size(), 0);
  for (const int v : soup.face_vertices) is_used[v] = 1;
  struct Point {
    double x, y, z;
    int vertex;
    bool operator<(const Point& o) const { return std::tie(x, y, z) < std::tie(o.x, o.y, o.z); }
  };
  std::vector<Point> points;
  for (std::size_t v = 0; v < is_used.size(); ++v) {
    const Vector3& p = soup.positions[v];
    if (is_used[v]) points.push_back({p.x(), p.y(), p.z(), static_cast<int>(v)});
  }
  context.checkpoint();
  std::sort(points.begin(), points.end());
  context.checkpoint();
  std::vector<int> place(is_used.size(), 0);
  count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && points[i - 1] < points[i]) ++count;
    place[points[i].vertex] = count;
  }
  ++count;
  return place;
}

}  // namespace

OrderedSoup in_order_of_places(const PolygonSoup& given, const RunContext& context) {
  const std::size_t face_count = given.face_sizes.size();
  int place_count = 0;
  const std::vector<int> place = places_of(given, place_count, context);

  // Each face from its least corner on; where a place comes twice, so that the places after it are least.
  std::vector<int> corners = given.face_vertices, places(corners.size()), begin(face_count + 1, 0);
  for (std::size_t f = 0; f < face_count; ++f) {
    context.checkpoint_at(f);
    begin[f + 1] = begin[f] + given.face_sizes[f];
    const auto first = corners.begin() + begin[f], last = corners.begin() + begin[f + 1];
    const auto by_place = [&](int v, int w) { return place[v] < place[w]; };
    auto start = std::min_element(first, last, by_place);
    const auto is_before = [&](std::vector<int>::iterator a, std::vector<int>::iterator b) {
      for (int i = 0; i < given.face_sizes[f]; ++i) {
        const int pa = place[*(last - a > i ? a + i : first + (i - (last - a)))];
        const int pb = place[*(last - b > i ? b + i : first + (i - (last - b)))];
        if (pa != pb) return pa < pb;
      }
      return false;
    };
    for (auto other = first; other != last; ++other)
      if (other != start && place[*other] == place[*start] && is_before(other, start)) start = other;
    std::rotate(first, start, last);
    for (int c = begin[f]; c < begin[f + 1]; ++c) places[c] = place[corners[c]];
  }

  // Faces by their first places, then those of one first place by the others.
  std::vector<int> bucket(static_cast<std::size_t>(place_count) + 1, 0), order(face_count);
  const auto first_place = [&](std::size_t f) { return begin[f] < begin[f + 1] ? places[begin[f]] : 0; };
  for (std::size_t f = 0; f < face_count; ++f) ++bucket[first_place(f) + 1];
  for (int p = 0; p < place_count; ++p) bucket[p + 1] += bucket[p];
  std::vector<int> fill(bucket.begin(), bucket.end() - 1);
  for (std::size_t f = 0; f < face_count; ++f) order[fill[first_place(f)]++] = static_cast<int>(f);
  for (int p = 0; p < place_count; ++p) {
    context.checkpoint_at(p);
    std::stable_sort(order.begin() + bucket[p], order.begin() + bucket[p + 1], [&](int f, int g) {
      return std::lexicographical_compare(places.begin() + begin[f], places.begin() + begin[f + 1],
                                          places.begin() + begin[g], places.begin() + begin[g + 1]);
    });
  }

  OrderedSoup out;
  std::vector<int> number(given.positions.size(), -1);
  out.first_corner.push_back(0);
  for (const int f : order) {
    context.checkpoint_at(out.given_face.size());
    out.given_face.push_back(f);
    out.soup.face_sizes.push_back(given.face_sizes[f]);
    for (int c = begin[f]; c < begin[f + 1]; ++c) {
      int& v = number[corners[c]];
      if (v < 0) {
        v = static_cast<int>(out.given_vertex.size());
        out.given_vertex.push_back(corners[c]);
        out.soup.positions.push_back(given.positions[corners[c]]);
      }
      out.soup.face_vertices.push_back(v);
    }
    out.first_corner.push_back(static_cast<int>(out.soup.face_vertices.size()));
  }
  return out;
}

std::vector<int> given_elements(const OrderedSoup& ordered, const std::string& kind, std::vector<int> elements) {
  for (int& e : elements) e = kind == "face" ? ordered.given_face[e] : ordered.given_vertex[e];
  if (kind != "edge") {
    std::sort(elements.begin(), elements.end());
    elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
    return elements;
  }
  std::vector<std::array<int, 2>> pairs;
  for (std::size_t i = 0; i + 1 < elements.size(); i += 2)
    pairs.push_back({std::min(elements[i], elements[i + 1]), std::max(elements[i], elements[i + 1])});
  std::sort(pairs.begin(), pairs.end());
  elements.clear();
  for (const auto& pair : pairs) elements.insert(elements.end(), pair.begin(), pair.end());
  return elements;
}

}  // namespace hybrid_quad
