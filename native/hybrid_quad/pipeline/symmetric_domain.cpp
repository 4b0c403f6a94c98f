#include "hybrid_quad/pipeline/symmetric_domain.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/negligible_faces.h"
#include "hybrid_quad/mesh/topology.h"
#include "hybrid_quad/pipeline/curve_counts.h"
#include "hybrid_quad/sizing/asked_lengths.h"

namespace hybrid_quad {

namespace {

/// Whether quads can be made of what the planes leave.
bool can_be_mirrored(const TriangleMesh& mesh, PlaneSet planes) {
  try {
    const std::vector<Weight> weight = weight_of_faces(positive_part(mesh, planes).mesh);
    return std::find(weight.begin(), weight.end(), Weight::kCounts) != weight.end();
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

SymmetryRecord settle_symmetry(const SymmetryOptions& options, const TriangleMesh& mesh, const RunContext& context) {
  SymmetryRecord record;
  record.is_measured = true;
  record.deviation = plane_deviations(mesh, context);
  record.planes = options.planes;
  for (int axis = 0; axis < 3; ++axis)
    if (options.detect && !has_plane(record.planes, axis) && record.deviation[axis].largest <= options.tolerance &&
        can_be_mirrored(mesh, record.planes | plane(axis)))
      record.planes |= plane(axis);
  return record;
}

namespace {

int nearest_source(const PositivePart::Origin& origin) {
  return origin.vertex[std::max_element(origin.weight.begin(), origin.weight.end()) - origin.weight.begin()];
}

template <class Value>
void take_nearest(const PositivePart& part, const BuiltMesh& built, std::vector<Value>& values) {
  if (values.empty()) return;
  std::vector<Value> taken;
  taken.reserve(part.vertex.size());
  for (const PositivePart::Origin& origin : part.vertex) taken.push_back(values[built.input_vertex[nearest_source(origin)]]);
  values = std::move(taken);
}

/// Lengths are between two others as their logarithms are.
void take_between(const PositivePart& part, const BuiltMesh& built, std::vector<double>& density) {
  if (density.empty()) return;
  std::vector<double> taken;
  taken.reserve(part.vertex.size());
  for (const PositivePart::Origin& origin : part.vertex) {
    double sum = 0;
    for (int i = 0; i < 3 && origin.vertex[i] >= 0; ++i)
      sum += origin.weight[i] * std::log(std::clamp(density[built.input_vertex[origin.vertex[i]]], kLeastDensity, kMostDensity));
    taken.push_back(std::exp(sum));
  }
  density = std::move(taken);
}

/// Leaves out what a cut left of components with too little area for quads, however much the whole ones have.
/// \param input_face  #F of the whole: polygon of the soup  \param defects  gets what is left out
void drop_negligible_components(const std::vector<int>& input_face, PositivePart& part, std::vector<Defect>& defects) {
  const std::vector<Weight> weight = weight_of_faces(part.mesh);
  const auto counting = std::count(weight.begin(), weight.end(), Weight::kCounts);
  if (counting == part.mesh.face_count()) return;
  const auto polygons_of = [&](Weight of) {
    std::vector<int> list;
    for (std::size_t f = 0; f < weight.size(); ++f)
      if (weight[f] == of) list.push_back(input_face[part.face[f]]);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  };
  std::vector<int> thin = polygons_of(Weight::kThin), tiny = polygons_of(Weight::kTiny);
  if (counting == 0 && !thin.empty())
    throw InputError("thin_component", "What is on the positive side of the mirror planes is as thin as a hair: hundreds of "
                                       "thousands of times as long as wide.", "face", std::move(thin));
  if (counting == 0) throw InputError("no_area", "No face on the positive side of the mirror planes has an area.");
  if (!thin.empty())
    defects.push_back({"thin_component", "face", std::move(thin), true, false,
                       "left out on the positive side of the mirror planes: hundreds of thousands of times as long as wide"});
  if (!tiny.empty())
    defects.push_back({"tiny_component", "face", std::move(tiny), true, false,
                       "left out on the positive side of the mirror planes: too small beside the rest for quads with an area"});
  CountingFaces kept = faces_that_count(part.mesh, weight);
  PositivePart less;
  for (const int v : kept.vertex) less.vertex.push_back(part.vertex[v]);
  for (const int f : kept.face) {
    less.face.push_back(part.face[f]);
    less.halfedge.insert(less.halfedge.end(), part.halfedge.begin() + 3 * f, part.halfedge.begin() + 3 * f + 3);
  }
  less.mesh = std::move(kept.mesh);
  less.faces_in_plane = part.faces_in_plane;
  part = std::move(less);
}

}  // namespace

std::vector<char> marked_halfedges(const BuiltMesh& built, const std::vector<std::array<int, 2>>& marked) {
  std::vector<std::array<int, 2>> sorted;
  for (const auto& m : marked) sorted.push_back({std::min(m[0], m[1]), std::max(m[0], m[1])});
  std::sort(sorted.begin(), sorted.end());
  std::vector<char> is_marked(built.mesh.halfedge_count(), 0);
  for (int h = 0; h < built.mesh.halfedge_count() && !sorted.empty(); ++h) {
    const int a = built.input_vertex[built.mesh.from(h)], b = built.input_vertex[built.mesh.to(h)];
    is_marked[h] = std::binary_search(sorted.begin(), sorted.end(), std::array<int, 2>{std::min(a, b), std::max(a, b)});
  }
  return is_marked;
}

RemeshDomain domain_of(const BuiltMesh& built, const RemeshOptions& options, const std::vector<int>& guides, PlaneSet planes) {
  RemeshDomain domain;
  domain.options = options;
  domain.options.symmetry.planes = planes;
  const std::vector<char> is_marked = marked_halfedges(built, options.marked_edges);
  const std::vector<int> counted = counted_halfedges(built, options.curve_counts);
  if (planes == 0) {
    domain.mesh = built.mesh;
    domain.is_marked = is_marked;
    domain.counted_curve = counted;
    domain.guides = guides;
    domain.input_vertex = domain.values.input_vertex = built.input_vertex;
    domain.values.input_face = built.input_face;
    return domain;
  }
  PositivePart part = positive_part(built.mesh, planes);
  drop_negligible_components(built.input_face, part, domain.defects);
  for (const PositivePart::Origin& origin : part.vertex) {
    domain.values.input_vertex.push_back(static_cast<int>(domain.input_vertex.size()));
    domain.input_vertex.push_back(origin.is_vertex() ? built.input_vertex[origin.vertex[0]] : -1);
  }
  for (const int h : part.halfedge) {
    domain.is_marked.push_back(h >= 0 && is_marked[h]);
    domain.counted_curve.push_back(h >= 0 ? counted[h] : -1);
    domain.guides.push_back(h >= 0 ? guides[h] : -1);
  }
  for (const int f : part.face) domain.values.input_face.push_back(built.input_face[f]);
  take_nearest(part, built, domain.options.vertex_guides);
  take_nearest(part, built, domain.options.vertex_frames);
  take_between(part, built, domain.options.density);
  domain.faces_in_plane = part.faces_in_plane;
  domain.mesh = std::move(part.mesh);
  return domain;
}

QuadMesh whole_of(const ComponentResult& component, const TriangleMesh& mesh,
                  const std::vector<std::array<int, 2>>& marked, const RemeshOptions& options) {
  if (options.symmetry.planes == 0) return component.mesh;
  const double sharp_angle = options.use_sharp_angle ? options.sharp_angle : 360;
  const std::vector<char> creases =
      seam_creases(component.mesh, component.curve_planes, mesh, options.symmetry.planes, sharp_angle, marked);
  return mirror_quads(component.mesh, component.curve_planes, options.symmetry.planes, creases);
}

std::vector<std::string> symmetry_warnings(const RemeshDomain& domain, const TriangleMesh& input, const QuadMesh& result) {
  std::vector<std::string> warnings;
  if (domain.faces_in_plane > 0)
    warnings.push_back(std::to_string(domain.faces_in_plane) + " faces in a mirror plane are left out");
  if (euler_characteristics_of_pieces(result) != euler_characteristics_of_pieces(input))
    warnings.push_back("the mirrored surface has another topology than the input");
  return warnings;
}

}  // namespace hybrid_quad
