// libFuzzer: any polygons in, an oriented manifold or an InputError out, and check_mesh() of the same opinion.
#include <cstdint>
#include <limits>
#include <string>

#include "fail.h"
#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/mesh_builder.h"

namespace {

using hybrid_quad::PolygonSoup;

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), end_(data + size) {}
  bool any() const { return data_ < end_; }
  int next() { return any() ? *data_++ : 0; }

 private:
  const std::uint8_t *data_, *end_;
};

/// Mostly small integers, so that vertices meet and faces are flat; now and then what no mesh should have.
double coordinate(int byte) {
  constexpr double kOdd[] = {1e-9, 1e-4, 1e6, 1e30, -1e-300, 0.5 + 1e-10, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()};
  return byte < 248 ? byte % 16 - 8 : kOdd[byte - 248];
}

PolygonSoup soup_of(Bytes bytes) {
  PolygonSoup soup;
  const int vertices = bytes.next() % 64;
  for (int v = 0; v < vertices; ++v) {
    const double x = coordinate(bytes.next()), y = coordinate(bytes.next()), z = coordinate(bytes.next());
    soup.positions.emplace_back(x, y, z);
  }
  const bool is_wrong = bytes.next() == 255;  // sizes and indices as they come
  while (bytes.any()) {
    const int first = bytes.next();
    const int size = is_wrong ? first % 11 - 2 : first < 200 ? 3 + first % 2 : first % 9;
    soup.face_sizes.push_back(size);
    for (int i = 0; i < size; ++i) soup.face_vertices.push_back(is_wrong ? bytes.next() - 8 : vertices > 0 ? bytes.next() % vertices : 0);
  }
  return soup;
}

void check_promises(const hybrid_quad::BuiltMesh& built, const PolygonSoup& soup) {
  const hybrid_quad::TriangleMesh& mesh = built.mesh;
  if (mesh.face_count() == 0) fail("an empty mesh is no result");
  if (static_cast<int>(built.input_vertex.size()) != mesh.vertex_count()) fail("vertices without origin");
  if (static_cast<int>(built.input_face.size()) != mesh.face_count()) fail("faces without origin");
  for (const int v : built.input_vertex)
    if (v < 0 || v >= static_cast<int>(soup.positions.size())) fail("a vertex comes from nowhere");
  for (const int f : built.input_face)
    if (f < 0 || f >= static_cast<int>(soup.face_sizes.size())) fail("a face comes from nowhere");
  // Once more from the triangles: nothing is left to repair but what vertices cannot say.
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    const int o = mesh.opposite(h);
    if (o >= 0 && (mesh.opposite(o) != h || mesh.from(o) != mesh.to(h) || mesh.to(o) != mesh.from(h))) fail("faces are not glued");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const PolygonSoup soup = soup_of(Bytes(data, size));
  bool is_refused = false;
  try {
    check_promises(hybrid_quad::build_mesh(soup), soup);
  } catch (const hybrid_quad::InputError& error) {
    is_refused = true;
    if (std::string(error.what()).empty()) fail("a refusal without a sentence");
  }
  bool is_unrepairable = false;
  for (const hybrid_quad::Defect& defect : hybrid_quad::check_mesh(soup)) is_unrepairable |= !defect.repairable;
  if (is_refused != is_unrepairable) fail("check_mesh and build_mesh disagree");
  return 0;
}
