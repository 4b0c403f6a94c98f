#include "hybrid_quad/mesh/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/bucket_sort.h"
#include "hybrid_quad/mesh/canonical_order.h"
#include "hybrid_quad/mesh/copied_parts.h"
#include "hybrid_quad/mesh/degenerate_faces.h"
#include "hybrid_quad/mesh/manifold_gluing.h"
#include "hybrid_quad/mesh/mesh_oddities.h"
#include "hybrid_quad/mesh/negligible_faces.h"
#include "hybrid_quad/mesh/pinholes.h"
#include "hybrid_quad/mesh/polygon_cuts.h"
#include "hybrid_quad/mesh/polygon_triangulation.h"
#include "hybrid_quad/mesh/soup_order.h"
#include "hybrid_quad/mesh/t_junctions.h"
#include "hybrid_quad/mesh/vertex_spread.h"
#include "hybrid_quad/mesh/vertex_welding.h"
#include "hybrid_quad/mesh/whiskers.h"

namespace hybrid_quad {

namespace {

constexpr double kOutlierFactor = 1e8;   ///< how many times farther than nearly all others a vertex must lie
constexpr double kLooseShare = 0.9;      ///< share of open edges above which a mesh is a soup of loose triangles
constexpr double kCrackWidth = 1e-9;     ///< over the diagonal: a vertex that near to an open edge lies on it
constexpr double kLooseTolerance = 2e-5; ///< corners of a soup that near (over the diagonal) are one
constexpr double kLeastSize = 4 * std::numeric_limits<double>::min();  ///< half the longest side; below it digits are lost, and reciprocals overflow
constexpr double kMostCoordinate = 1e-3 * std::numeric_limits<double>::max();  ///< beyond it differences, and their sums, overflow
/// Edges with more than two faces, and sides that part there, over the number of triangles, from which on it is no surface that is
/// cut but a volume's inside. A surface has 1.5 edges a triangle.
constexpr double kMostCrowded = 0.5, kMostTorn = 0.1;
/// Over the distance from the origin. There are then ten million places along the mesh: enough that quads of a thousandth of it
/// have an area, and do not lose the ten thousandth of an edge by which flat ones are opened.
constexpr double kLeastExtent = 1e-9;  // half the longest side of the box, and half the root of the area

/// Builds the mesh step by step; every step notes the defects that it found.
class MeshBuilder {
 public:
  explicit MeshBuilder(const PolygonSoup& soup) : given_(soup) {}

  BuiltMesh build(const RunContext& context);
  std::vector<Defect> defects;

 private:
  void check_faces();
  void find_references();
  void check_positions();
  void order(const RunContext& context);
  void normalize_positions();
  void check_digits(const TriangleMesh& mesh);
  [[noreturn]] void refuse_coarse_coordinates();
  void make_triangles(const RunContext& context);
  void weld();
  void weld_exactly();
  void weld_soup();
  void weld_seams();
  void close_pinholes();
  bool merge_vertices(const std::vector<int>& target);
  void note_targets(const std::vector<int>& target);
  void drop_copied_parts();
  void drop_duplicates();
  std::vector<int> drop(const std::vector<char>& goes);
  void drop_copies(const std::vector<char>& is_copy);
  BuiltMesh glue(const RunContext& context);
  void drop_negligible_components(BuiltMesh& built);
  void tell_of_remaining_faces(const BuiltMesh& built);
  void put_back(BuiltMesh& built) const;

  std::vector<int> as_given(const char* kind, std::vector<int> elements) const {
    return is_in_order_ ? given_elements(ordered_, kind, std::move(elements)) : elements;
  }
  void note(const char* code, const char* kind, std::vector<int> elements, const char* remedy) {
    if (!elements.empty()) defects.push_back({code, kind, as_given(kind, std::move(elements)), true, false, remedy});
  }
  [[noreturn]] void refuse(const char* code, const std::string& message, const char* kind, std::vector<int> elements) {
    elements = as_given(kind, std::move(elements));
    defects.push_back({code, kind, elements, false, false, message});
    throw InputError(code, message, kind, std::move(elements));
  }
  int face_count() const { return static_cast<int>(given_.face_sizes.size()); }

  const PolygonSoup& given_;
  std::vector<char> is_used_;       ///< of the vertices as they were given
  bool is_in_order_ = false;
  OrderedSoup ordered_;             ///< what all elements below are of
  std::vector<Vector3> positions_;  ///< moved to the box's centre and divided by its diagonal
  double farthest_ = 0;  ///< the largest of the given coordinates, without its sign
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> polygon_;        ///< of each triangle
  bool is_closed_ = false;   ///< no edge was open when vertices were last welded
  std::vector<int> welded_;  ///< vertices merged with others at the same place
  std::vector<int> target_;  ///< the vertex that each was merged into, in however many steps; empty: none was
  std::vector<int> copies_;  ///< polygons left out, whole or in part, because others lie there
};

void MeshBuilder::check_faces() {
  std::vector<int> first_corner{0};
  long long corners = 0;
  for (const int size : given_.face_sizes) {
    corners += std::max(size, 0);
    if (size < 0 || corners > static_cast<long long>(given_.face_vertices.size())) break;
    first_corner.push_back(static_cast<int>(corners));
  }
  if (static_cast<int>(first_corner.size()) != face_count() + 1 || corners != static_cast<long long>(given_.face_vertices.size()))
    refuse("malformed_faces", "The sizes of the faces do not add up to the number of face corners.", "", {});
  std::vector<int> bad;
  const int vertex_count = static_cast<int>(given_.positions.size());
  for (int f = 0; f < face_count(); ++f)
    for (int c = first_corner[f]; c < first_corner[f + 1]; ++c)
      if (given_.face_vertices[c] < 0 || given_.face_vertices[c] >= vertex_count) {
        bad.push_back(f);
        break;
      }
  if (!bad.empty()) refuse("index_out_of_range", "Faces use vertices that do not exist.", "face", std::move(bad));
  if (face_count() == 0) refuse("empty_mesh", "The mesh has no faces.", "", {});
}

void MeshBuilder::find_references() {
  is_used_.assign(given_.positions.size(), 0);
  for (const int v : given_.face_vertices) is_used_[v] = 1;
  std::vector<int> isolated;
  for (int v = 0; v < static_cast<int>(is_used_.size()); ++v)
    if (!is_used_[v]) isolated.push_back(v);
  note("isolated_vertex", "vertex", std::move(isolated), "left out");
}

void MeshBuilder::check_positions() {
  std::vector<int> bad, used;
  for (int v = 0; v < static_cast<int>(is_used_.size()); ++v) {
    if (!is_used_[v]) continue;
    used.push_back(v);
    if (!given_.positions[v].allFinite()) bad.push_back(v);
  }
  if (!bad.empty()) refuse("non_finite_vertex", "Vertices have coordinates that are no finite numbers.", "vertex", std::move(bad));
  for (const int v : used)
    if (given_.positions[v].cwiseAbs().maxCoeff() > kMostCoordinate) bad.push_back(v);
  if (!bad.empty())
    refuse("coordinates_too_large", "Vertices have coordinates too large to compute with.", "vertex", std::move(bad));

  std::vector<Vector3> points;
  for (const int v : used) points.push_back(given_.positions[v]);
  if (points.empty()) return;  // faces without corners
  const VertexSpread spread = spread_of(points);
  for (const int v : used)
    if (spread.ratio(given_.positions[v]) > kOutlierFactor) bad.push_back(v);
  if (!bad.empty())
    refuse("coordinate_outlier", "Vertices lie so far from all others that these shrink to a point.", "vertex", std::move(bad));
}

/// From here on the order of the file makes no difference.
void MeshBuilder::order(const RunContext& context) {
  ordered_ = in_order_of_places(given_, context);
  is_in_order_ = true;
}

void MeshBuilder::normalize_positions() {
  const std::vector<Vector3>& given = ordered_.soup.positions;
  Vector3 low = Vector3::Constant(HUGE_VAL), high = Vector3::Constant(-HUGE_VAL);
  for (const Vector3& p : given) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vector3 centre = 0.5 * low + 0.5 * high;
  const Vector3 half = high - centre;
  const double size = half.maxCoeff();
  if (!(size > 0)) refuse("no_area", "All vertices lie at the same place.", "", {});
  if (size < kLeastSize) refuse("coordinates_too_small", "The mesh is too small to compute with.", "", {});
  farthest_ = low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
  if (size < kLeastExtent * farthest_) refuse_coarse_coordinates();
  const double diagonal = 2 * (half / size).norm();  // over `size`: squares of tiny or huge numbers are lost
  positions_.reserve(given.size());
  for (const Vector3& p : given) positions_.push_back((p - centre) / size / diagonal);
}

/// A wire is as long as one likes: it is its area that has to hold the quads.
void MeshBuilder::check_digits(const TriangleMesh& mesh) {
  double area = 0;  // over the squared distance: squares of tiny or huge numbers are lost
  for (int h = 0; h < mesh.halfedge_count(); h += 3)
    area += 0.5 * (mesh.edge_vector(h) / farthest_).cross(mesh.edge_vector(h + 1) / farthest_).norm();
  if (std::sqrt(area) < 2 * kLeastExtent) refuse_coarse_coordinates();
}

void MeshBuilder::refuse_coarse_coordinates() {
  refuse("coordinates_too_coarse", "The mesh is so far from the origin that its coordinates have no digits left for its shape.",
         "", {});
}

void MeshBuilder::make_triangles(const RunContext& context) {
  std::vector<int> repeated, few, corners, flat;
  std::vector<std::size_t> given_begin{0};
  for (const int size : given_.face_sizes) given_begin.push_back(given_begin.back() + size);
  Vector3 middle = Vector3::Zero();
  for (const Vector3& p : positions_) middle += p / static_cast<double>(positions_.size());
  PolygonCuts cuts(positions_, ordered_.soup);
  for (int f = 0; f < face_count(); ++f) {
    const auto begin = ordered_.soup.face_vertices.begin();
    context.checkpoint_at(f);
    corners.assign(begin + ordered_.first_corner[f], begin + ordered_.first_corner[f + 1]);
    const std::size_t size = corners.size();
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    if (size < 3) few.push_back(f);
    else if (corners.size() < size) repeated.push_back(f);
    if (corners.size() < 3) continue;
    bool is_flat = true;
    std::vector<std::array<int, 3>> cut = cuts.like_a_copy(f, corners);
    if (cut.empty()) {
      if (corners.size() > 3) begin_far_from(middle, positions_, corners);
      const int given_first = given_.face_vertices[given_begin[ordered_.given_face[f]]];
      const auto fan_corner = std::find_if(corners.begin(), corners.end(), [&](int v) { return ordered_.given_vertex[v] == given_first; });
      cut = triangulate_polygon(positions_, corners, static_cast<int>(fan_corner - corners.begin()));
      cuts.keep(f, corners, cut);
    }
    for (const auto& t : cut) {
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      is_flat = is_flat && has_no_area(positions_[t[0]], positions_[t[1]], positions_[t[2]]);
      triangles_.push_back(t);
      polygon_.push_back(f);
    }
    if (is_flat) flat.push_back(f);
  }
  note("too_few_corners", "face", std::move(few), "left out");
  note("repeated_index_face", "face", std::move(repeated), "repeated corners are left out");
  note("zero_area_face", "face", std::move(flat), "removed by flips and collapses, or taken away at a border");
}

/// Replaces vertices by their targets and drops triangles that this closes; true if any vertex changed.
bool MeshBuilder::merge_vertices(const std::vector<int>& target) {
  bool changed = false;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    std::array<int, 3> t = triangles_[i];
    for (int& v : t) {
      changed |= target[v] != v;
      v = target[v];
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    triangles_[kept] = t;
    polygon_[kept++] = polygon_[i];
  }
  triangles_.resize(kept);
  polygon_.resize(kept);
  return changed;
}

/// Vertices that are merged into others.
std::vector<int> merged(const std::vector<int>& target) {
  std::vector<int> list;
  for (int v = 0; v < static_cast<int>(target.size()); ++v)
    if (target[v] != v) list.push_back(v);
  return list;
}

void MeshBuilder::note_targets(const std::vector<int>& target) {
  if (target_.empty()) target_ = target;
  else
    for (int& v : target_) v = target[v];
}

void MeshBuilder::weld_exactly() {
  const auto open = open_edges(triangles_);
  is_closed_ = open.empty();
  if (is_closed_) return;
  const std::vector<int> target = welded_vertices(positions_, open);
  if (!merge_vertices(target)) return;
  note_targets(target);
  const std::vector<int> list = merged(target);
  welded_.insert(welded_.end(), list.begin(), list.end());
  std::sort(welded_.begin(), welded_.end());
  welded_.erase(std::unique(welded_.begin(), welded_.end()), welded_.end());
}

void MeshBuilder::weld() {
  weld_exactly();
  if (is_closed_) return;
  if (triangles_.size() >= 8 && open_edge_share(triangles_) >= kLooseShare)
    weld_soup();
  else
    weld_seams();
}

void MeshBuilder::weld_seams() {
  const std::vector<int> target = nearly_welded_seams(positions_, open_edges(triangles_));
  if (!merge_vertices(target)) return;
  note_targets(target);
  note("nearly_welded_vertex", "vertex", merged(target), "merged with the vertex next to it");
}

void MeshBuilder::close_pinholes() {
  const std::vector<int> target = closed_pinholes(positions_, triangles_, open_edges(triangles_));
  if (!merge_vertices(target)) return;
  note_targets(target);
  note("pinhole", "vertex", merged(target), "closed: the vertices around it are merged");
}

void MeshBuilder::weld_soup() {
  const std::vector<int> target = nearly_welded_vertices(positions_, kLooseTolerance);
  const auto triangles = triangles_;
  const auto polygon = polygon_;
  merge_vertices(target);
  if (open_edge_share(triangles_) < 0.5) {
    note("nearly_welded_vertex", "vertex", merged(target), "merged with the vertex next to it");
    note_targets(target);
  } else {
    triangles_ = triangles;
    polygon_ = polygon;
  }
}

void MeshBuilder::drop_duplicates() {
  using Key = std::pair<std::array<int, 3>, int>;
  std::vector<Key> keys;
  keys.reserve(triangles_.size());
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    std::array<int, 3> key = triangles_[i];
    std::sort(key.begin(), key.end());
    keys.push_back({key, static_cast<int>(i)});
  }
  bucket_sort(keys, [](const Key& key) { return key.first[0]; }, std::less<>());
  std::vector<char> is_copy(triangles_.size(), 0);
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (keys[i].first == keys[i - 1].first) is_copy[keys[i].second] = 1;
  drop_copies(is_copy);
  std::sort(copies_.begin(), copies_.end());
  copies_.erase(std::unique(copies_.begin(), copies_.end()), copies_.end());
  note("duplicate_face", "face", copies_, "left out");
}

/// Leaves triangles out. \return their polygons
std::vector<int> MeshBuilder::drop(const std::vector<char>& goes) {
  std::vector<int> dropped;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    if (goes[i]) {
      dropped.push_back(polygon_[i]);
      continue;
    }
    triangles_[kept] = triangles_[i];
    polygon_[kept++] = polygon_[i];
  }
  triangles_.resize(kept);
  polygon_.resize(kept);
  return dropped;
}

/// Leaves copies of other triangles out.
void MeshBuilder::drop_copies(const std::vector<char>& is_copy) {
  const std::vector<int> dropped = drop(is_copy);
  copies_.insert(copies_.end(), dropped.begin(), dropped.end());
}

/// Before cracks are closed: a part would be joined to what it lies on, along its border.
void MeshBuilder::drop_copied_parts() { drop_copies(copied_parts(positions_, triangles_)); }

BuiltMesh MeshBuilder::glue(const RunContext& context) {
  constexpr const char* kCut = "the surface is cut there";
  ManifoldGluing glued = glue_triangles(positions_, triangles_, context);
  const auto polygons_of = [this](const std::vector<int>& faces) {
    std::vector<int> list;
    for (const int f : faces) list.push_back(polygon_[f]);
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  };
  std::vector<int> flipped, edge_ends;
  for (const auto& e : glued.non_manifold_edges) edge_ends.insert(edge_ends.end(), e.begin(), e.end());
  if (!glued.non_orientable_faces.empty()) {
    note("non_manifold_edge", "edge", std::move(edge_ends), kCut);
    refuse("non_orientable", "The surface has one side only (like a Moebius strip): it cannot be oriented.", "face",
           polygons_of(glued.non_orientable_faces));
  }
  for (int f = 0; f < static_cast<int>(glued.was_flipped.size()); ++f)
    if (glued.was_flipped[f]) flipped.push_back(f);
  const double faces = static_cast<double>(triangles_.size());
  if (glued.non_manifold_edges.size() > kMostCrowded * faces && glued.torn_sides > kMostTorn * faces)
    refuse("not_a_surface", "Most edges are in more than two faces, as inside a volume: this is no surface.", "edge", std::move(edge_ends));
  note("flipped_face", "face", polygons_of(flipped), "turned around");
  note("non_manifold_edge", "edge", std::move(edge_ends), kCut);
  std::vector<int> twisted;
  for (const auto& e : glued.twisted_edges) twisted.insert(twisted.end(), e.begin(), e.end());
  note("twisted_edge", "edge", std::move(twisted), "the surface, which would have one side only, is cut there");
  note("non_manifold_vertex", "vertex", glued.non_manifold_vertices, "each sheet gets a vertex of its own");

  BuiltMesh built;
  built.mesh = TriangleMesh(std::move(glued.positions), std::move(glued.faces), std::move(glued.opposite));
  built.input_vertex = std::move(glued.source_vertex);
  built.input_face = polygon_;
  return built;
}

/// The same surface gives the same mesh, in whatever order its file has it, and however it lies in space.
void put_in_order(BuiltMesh& built, const RunContext& context) {
  const CanonicalOrder order = canonical_order(built.mesh, context);
  context.checkpoint();
  std::vector<int> input_vertex, input_face;
  for (const int v : order.vertex) input_vertex.push_back(built.input_vertex[v]);
  for (std::size_t h = 0; h < order.halfedge.size(); h += 3) input_face.push_back(built.input_face[order.halfedge[h] / 3]);
  built.mesh = reordered(built.mesh, order, context);
  built.input_vertex = std::move(input_vertex);
  built.input_face = std::move(input_face);
}

/// Flips and collapses faces without area away, one after the other.
void resolve_faces(BuiltMesh& built, const RunContext& context) {
  if (faces_without_area(built.mesh).empty()) return;
  ResolvedMesh resolved = resolve_faces_without_area(built.mesh);
  for (int& v : resolved.vertex_source) v = built.input_vertex[v];
  for (int& f : resolved.face_source) f = built.input_face[f];
  built.input_vertex = std::move(resolved.vertex_source);
  built.input_face = std::move(resolved.face_source);
  built.mesh = std::move(resolved.mesh);
  put_in_order(built, context);
}

/// Drops components without area, and those so small that their quads would have none.
void MeshBuilder::drop_negligible_components(BuiltMesh& built) {
  const std::vector<Weight> weight = weight_of_faces(built.mesh);
  const auto polygons_of = [&](Weight of) {
    std::vector<int> list;
    for (std::size_t f = 0; f < weight.size(); ++f)
      if (weight[f] == of) list.push_back(built.input_face[f]);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  };
  const auto counting = std::count(weight.begin(), weight.end(), Weight::kCounts);
  if (counting == built.mesh.face_count()) return;
  std::vector<int> thin = polygons_of(Weight::kThin);
  if (counting == 0 && !thin.empty()) {
    // A spike makes any part as thin as a hair; of a hair no vertex lies far from all others.
    std::vector<int> far = far_vertices(built);
    if (!far.empty())
      refuse("coordinate_outlier", "Vertices lie so far from all others that the mesh is as thin as a hair.", "vertex", std::move(far));
  }
  if (counting == 0 && !thin.empty())
    refuse("thin_component", "The mesh is as thin as a hair: hundreds of thousands of times as long as wide.", "face", std::move(thin));
  if (counting == 0) refuse("no_area", "No face of the mesh has an area.", "", {});
  note("thin_component", "face", std::move(thin), "left out: hundreds of thousands of times as long as wide");
  note("tiny_component", "face", polygons_of(Weight::kTiny), "left out: too small beside the rest for quads with an area");
  CountingFaces kept = faces_that_count(built.mesh, weight);
  for (int& v : kept.vertex) v = built.input_vertex[v];
  for (int& f : kept.face) f = built.input_face[f];
  built.mesh = std::move(kept.mesh);
  built.input_vertex = std::move(kept.vertex);
  built.input_face = std::move(kept.face);
}

/// Of faces without area, those that could not go are not said to have gone.
void MeshBuilder::tell_of_remaining_faces(const BuiltMesh& built) {
  const std::vector<int> faces = faces_without_area(built.mesh);
  if (faces.empty()) return;
  std::vector<int> left;
  for (const int f : faces) left.push_back(built.input_face[f]);
  left = as_given("face", std::move(left));
  std::sort(left.begin(), left.end());
  left.erase(std::unique(left.begin(), left.end()), left.end());
  const auto noted = std::find_if(defects.begin(), defects.end(), [](const Defect& d) { return d.code == "zero_area_face"; });
  if (noted != defects.end()) {
    std::vector<int>& gone = noted->elements;
    gone.erase(std::remove_if(gone.begin(), gone.end(), [&](int f) { return std::binary_search(left.begin(), left.end(), f); }), gone.end());
    if (gone.empty()) defects.erase(noted);
  }
  defects.push_back({"zero_area_face", "face", std::move(left), true, true, "stays: without it the surface would have another topology"});
}

/// Vertices where the input has them.
void MeshBuilder::put_back(BuiltMesh& built) const {
  std::vector<Vector3> given;
  given.reserve(built.input_vertex.size());
  for (const int v : built.input_vertex) given.push_back(ordered_.soup.positions[v]);
  built.mesh = std::move(built.mesh).with_positions(std::move(given));
}

BuiltMesh MeshBuilder::build(const RunContext& context) {
  check_faces();
  find_references();
  check_positions();
  context.checkpoint();
  order(context);
  normalize_positions();
  context.checkpoint();
  make_triangles(context);
  context.checkpoint();
  drop_copied_parts();
  context.checkpoint();
  weld();
  context.checkpoint();
  drop_duplicates();
  context.checkpoint();
  drop(whiskers(positions_, triangles_));
  if (triangles_.empty()) refuse("no_area", "No face of the mesh has an area.", "", {});
  std::vector<int> split_at;
  if (!is_closed_ || !copies_.empty()) split_at = split_at_t_junctions(positions_, kCrackWidth, triangles_, polygon_);
  // Their parts may lie exactly on other open edges, as the whole ones did not.
  if (!split_at.empty()) weld_exactly();
  note("unwelded_vertex", "vertex", std::move(welded_), "merged with the vertex at the same place");
  note("t_junction", "vertex", std::move(split_at), "the edge beside it is split, which closes the crack");
  context.checkpoint();
  if (!is_closed_) close_pinholes();
  context.checkpoint();
  BuiltMesh built = glue(context);
  context.checkpoint();
  put_in_order(built, context);
  context.checkpoint();
  resolve_faces(built, context);
  context.checkpoint();
  drop_negligible_components(built);
  context.checkpoint();
  tell_of_remaining_faces(built);
  put_back(built);
  context.checkpoint();
  check_digits(built.mesh);
  for (int& v : built.input_vertex) v = ordered_.given_vertex[v];
  for (int& f : built.input_face) f = ordered_.given_face[f];
  built.welded_into.resize(given_.positions.size());
  std::iota(built.welded_into.begin(), built.welded_into.end(), 0);
  for (std::size_t v = 0; v < target_.size(); ++v) built.welded_into[ordered_.given_vertex[v]] = ordered_.given_vertex[target_[v]];
  return built;
}

}  // namespace

BuiltMesh build_mesh(const PolygonSoup& soup, std::vector<Defect>& defects) {
  MeshBuilder builder(soup);
  try {
    BuiltMesh built = builder.build({});
    defects = std::move(builder.defects);
    return built;
  } catch (const InputError&) {
    defects = std::move(builder.defects);
    throw;
  }
}

BuiltMesh build_mesh(const PolygonSoup& soup, const RunContext& context) {
  MeshBuilder builder(soup);
  BuiltMesh built = builder.build(context);
  built.defects = std::move(builder.defects);
  context.checkpoint();
  note_touching_vertices(built, built.defects);
  context.checkpoint();
  return built;
}

}  // namespace hybrid_quad
