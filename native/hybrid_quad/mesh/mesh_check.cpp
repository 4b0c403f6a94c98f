#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/mesh/mesh_oddities.h"

namespace hybrid_quad {

namespace {

/// Takes the faces away that a refusal is about, where it is about some. \param face  of the soup that is left, in the one that was given
/// \returns whether any were taken away and any are left
bool leave_out(const Defect& refusal, PolygonSoup& soup, std::vector<int>& face) {
  const bool by_vertices = refusal.element_kind == "vertex";
  if (!by_vertices && refusal.code != "index_out_of_range" && refusal.code != "non_orientable") return false;
  std::vector<char> is_bad(by_vertices ? soup.positions.size() : soup.face_sizes.size(), 0);
  for (const int i : refusal.elements) is_bad[i] = 1;
  std::vector<int> sizes, vertices, kept;
  std::size_t first = 0;
  for (std::size_t f = 0; f < soup.face_sizes.size(); ++f) {
    const auto begin = soup.face_vertices.begin() + static_cast<std::ptrdiff_t>(first), end = begin + soup.face_sizes[f];
    first += soup.face_sizes[f];
    if (by_vertices ? std::any_of(begin, end, [&](int v) { return is_bad[v] != 0; }) : is_bad[f] != 0) continue;
    sizes.push_back(soup.face_sizes[f]);
    vertices.insert(vertices.end(), begin, end);
    kept.push_back(face[f]);
  }
  const bool is_any_taken = sizes.size() < soup.face_sizes.size();
  soup.face_sizes = std::move(sizes);
  soup.face_vertices = std::move(vertices);
  face = std::move(kept);
  return is_any_taken && !face.empty();
}

/// Adds the elements of a defect to those of its kind, if there is one: what was found before some faces were left out may be
/// found again. \returns whether it is of a new kind
bool is_new_kind(const Defect& defect, std::vector<Defect>& known) {
  const auto same = std::find_if(known.begin(), known.end(), [&](const Defect& d) {
    return d.code == defect.code && d.element_kind == defect.element_kind && d.remedy == defect.remedy;
  });
  if (same == known.end()) return true;
  const std::size_t size = defect.element_kind == "edge" ? 2 : 1;
  std::vector<std::vector<int>> elements;
  for (const std::vector<int>* list : {&std::as_const(same->elements), &defect.elements})
    for (std::size_t i = 0; i + size <= list->size(); i += size)
      elements.emplace_back(list->begin() + static_cast<std::ptrdiff_t>(i), list->begin() + static_cast<std::ptrdiff_t>(i + size));
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  same->elements.clear();
  for (const auto& e : elements) same->elements.insert(same->elements.end(), e.begin(), e.end());
  return false;
}

}  // namespace

std::vector<Defect> check_mesh(const PolygonSoup& soup) {
  std::vector<Defect> found;
  PolygonSoup rest = soup;
  std::vector<int> face(soup.face_sizes.size());
  std::iota(face.begin(), face.end(), 0);
  for (bool is_whole = true;; is_whole = false) {
    std::vector<Defect> noted;
    bool is_refused = false;
    try {
      const BuiltMesh built = build_mesh(rest, noted);
      for (Defect& oddity : oddities_of(built, rest)) noted.push_back(std::move(oddity));
    } catch (const InputError&) {
      is_refused = true;  // the last defect says why
    }
    const Defect last = noted.empty() ? Defect{} : noted.back();
    std::vector<Defect> here;
    for (Defect& defect : noted) {
      // What the faces that were left out leave behind is no defect of the mesh.
      if (!is_whole && (defect.code == "isolated_vertex" || defect.elements.empty())) continue;
      if (defect.element_kind == "face")
        for (int& f : defect.elements) f = face[f];
      if (is_whole || is_new_kind(defect, found)) here.push_back(std::move(defect));
    }
    found.insert(found.begin(), here.begin(), here.end());  // so that what a run is refused for comes last
    if (!is_refused || !leave_out(last, rest, face)) return found;
  }
}

}  // namespace hybrid_quad
