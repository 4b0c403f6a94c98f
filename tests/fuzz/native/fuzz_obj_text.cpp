// libFuzzer: any text in, polygons or the line that is wrong out; what is read can be written, and made a mesh of or refused.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

#include "fail.h"
#include "hybrid_quad/base/errors.h"
#include "hybrid_quad/mesh/obj_text.h"

namespace {

using hybrid_quad::PolygonSoup;

constexpr std::size_t kSmall = 200;  // vertices and corners: the mesh builder has a fuzzer of its own

void check_refusal(const std::string& what, std::string_view text) {
  const std::string begin = "line ";
  if (what.rfind(begin, 0) != 0) fail("a refusal without a line: " + what);
  const long line = std::atol(what.c_str() + begin.size());
  const long ends = std::count_if(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; });
  if (line < 1 || line > ends + 1) fail("no such line: " + what);
  if (!std::all_of(what.begin(), what.end(), [](char c) { return c >= ' ' && c <= '~'; })) fail("a refusal that cannot be shown");
}

void check_counts(const PolygonSoup& soup) {
  std::size_t corners = 0;
  for (const int size : soup.face_sizes) {
    if (size < 0) fail("a face of fewer than no corners");
    corners += size;
  }
  if (corners != soup.face_vertices.size()) fail("corners without a face");
}

bool is_same(double a, double b) { return std::isnan(a) ? std::isnan(b) : a == b && std::signbit(a) == std::signbit(b); }

void check_writing(const PolygonSoup& soup) {
  const PolygonSoup again = hybrid_quad::parse_obj(hybrid_quad::obj_text(soup.positions, {}));
  if (again.positions.size() != soup.positions.size()) fail("vertices are lost where they are written");
  for (std::size_t v = 0; v < soup.positions.size(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      if (!is_same(again.positions[v][axis], soup.positions[v][axis])) fail("a coordinate is not read back as it was");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  PolygonSoup soup;
  try {
    soup = hybrid_quad::parse_obj(text);
  } catch (const std::invalid_argument& error) {
    check_refusal(error.what(), text);
    return 0;
  }
  check_counts(soup);
  check_writing(soup);
  if (soup.positions.size() > kSmall || soup.face_vertices.size() > kSmall) return 0;
  try {
    hybrid_quad::build_mesh(soup);
  } catch (const hybrid_quad::InputError& error) {
    if (std::string(error.what()).empty()) fail("a refusal without a sentence");
  }
  return 0;
}
