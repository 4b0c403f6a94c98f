#include "hybrid_quad/regular_quads/regular_quads.h"

#include <string>

#include "hybrid_quad/base/parallel.h"

namespace hybrid_quad {

namespace {

/// Pieces joined across everything that is not an integer line or a feature, in order of their first piece.
struct CellComponents {
  std::vector<int> members;  ///< pieces, one component after the other
  std::vector<int> begin;
  std::vector<int> component_of;
};

CellComponents join_pieces(const GridOverlay& overlay) {
  CellComponents out;
  out.component_of.assign(overlay.piece_count(), -1);
  out.begin.push_back(0);
  for (int seed = 0; seed < overlay.piece_count(); ++seed) {
    if (out.component_of[seed] >= 0 || !overlay.piece_regular[seed]) continue;
    const int id = static_cast<int>(out.begin.size()) - 1;
    out.component_of[seed] = id;
    out.members.push_back(seed);
    for (std::size_t i = out.begin.back(); i < out.members.size(); ++i) {
      const int piece = out.members[i];
      for (int k = overlay.piece_begin[piece]; k < overlay.piece_begin[piece + 1]; ++k) {
        const int o = overlay.opposite[k];
        if (o < 0 || overlay.on_isoline[k]) continue;
        const int neighbour = overlay.piece_of[o];
        if (!overlay.piece_regular[neighbour] || out.component_of[neighbour] >= 0) continue;
        out.component_of[neighbour] = id;
        out.members.push_back(neighbour);
      }
    }
    out.begin.push_back(static_cast<int>(out.members.size()));
  }
  return out;
}

/// The four sides of a component if it is one whole cell of the grid.
/// \return false if it is not
bool sides_of_cell(const GridOverlay& overlay, const CellComponents& cells, int id, std::array<int, 4>& side) {
  int border = -1, border_count = 0, inner_halfedges = 0;
  for (int i = cells.begin[id]; i < cells.begin[id + 1]; ++i) {
    const int piece = cells.members[i];
    for (int k = overlay.piece_begin[piece]; k < overlay.piece_begin[piece + 1]; ++k) {
      if (overlay.on_isoline[k]) {
        ++border_count;
        if (overlay.vertices[overlay.origin[k]].grid_sign != 0) border = k;
        continue;
      }
      ++inner_halfedges;
      const int o = overlay.opposite[k];
      if (o < 0 || cells.component_of[overlay.piece_of[o]] != id) return false;
    }
  }
  if (border < 0) return false;
  const auto inside = [&](int piece) { return cells.component_of[piece] == id; };
  int corners = 0, walked = 0, sign = 0, curve = -1, k = border;
  do {
    const int s = overlay.vertices[overlay.origin[k]].grid_sign;
    if (s != 0) {
      if (corners == 4 || s == sign) return false;
      side[corners++] = k;
      sign = s;
      curve = overlay.curve[k];
    } else if (overlay.curve[k] != curve) {
      return false;
    }
    ++walked;
    k = next_border_halfedge(overlay, k, inside);
  } while (k != border && walked <= border_count);
  // One loop that sees all border half-edges, four grid points on it; without a cone inside (they are grid points) a
  // flat region with four right angles and one border is a disk.
  return corners == 4 && walked == border_count && inner_halfedges % 2 == 0;
}

bool is_border(const GridOverlay& overlay, const std::vector<int>& piece_cell, int k) {
  if (overlay.curve[k] >= 0) return true;
  const int o = overlay.opposite[k];
  return overlay.on_isoline[k] && (piece_cell[overlay.piece_of[k]] >= 0 || (o >= 0 && piece_cell[overlay.piece_of[o]] >= 0));
}

/// Overlay vertices between grid points at which more than two borders of quads and patches end: a side that touches a curve
/// where the curve's own coordinate has no integer. Seen from its two sides, the chain of a grid edge goes on differently there.
std::vector<char> find_touching(const GridOverlay& overlay, const std::vector<int>& piece_cell) {
  std::vector<int> borders(overlay.vertices.size(), 0);
  for (int k = 0; k < static_cast<int>(overlay.origin.size()); ++k) {
    if (overlay.opposite[k] > k || !is_border(overlay, piece_cell, k)) continue;
    ++borders[overlay.origin[k]];
    ++borders[overlay.target(k)];
  }
  std::vector<char> touching(borders.size(), 0);
  for (std::size_t v = 0; v < borders.size(); ++v) touching[v] = overlay.vertices[v].grid_sign == 0 && borders[v] > 2;
  return touching;
}

/// Cells with a side off the curves that touches another border. Without them only curves pass such a vertex.
std::vector<char> find_touching_cells(const GridOverlay& overlay, const std::vector<int>& piece_cell, std::size_t cell_count) {
  const std::vector<char> touching = find_touching(overlay, piece_cell);
  std::vector<char> out(cell_count, 0);
  for (int k = 0; k < static_cast<int>(overlay.origin.size()); ++k) {
    const int cell = piece_cell[overlay.piece_of[k]];
    if (cell < 0 || overlay.curve[k] >= 0 || !overlay.on_isoline[k]) continue;
    if (touching[overlay.origin[k]] || touching[overlay.target(k)]) out[cell] = 1;
  }
  return out;
}

/// Gives the marked cells to the singular region.
void release(RegularQuads& quads, const std::vector<char>& is_released) {
  std::vector<int> new_cell(is_released.size(), -1);
  int count = 0;
  for (std::size_t q = 0; q < is_released.size(); ++q) {
    if (is_released[q]) continue;
    new_cell[q] = count;
    quads.side[count++] = quads.side[q];
  }
  quads.side.resize(count);
  for (int& cell : quads.piece_cell) cell = cell < 0 ? -1 : new_cell[cell];
}

}  // namespace

RegularQuads extract_regular_quads(const WorkingSurface& surface, const FrameField& frames,
                                   const SpanningParameterization& param, const RunContext& context) {
  RegularQuads out;
  out.overlay = build_grid_overlay(surface, param, build_curve_coordinates(surface, frames, param), context);
  const GridOverlay& overlay = out.overlay;
  const CellComponents cells = join_pieces(overlay);
  out.piece_cell.assign(overlay.piece_count(), -1);
  const int count = static_cast<int>(cells.begin.size()) - 1;
  std::vector<std::array<int, 4>> side(count);
  std::vector<char> is_cell(count, 0);
  parallel_chunks(count, context, [&](int begin, int end) {
    for (int id = begin; id < end; ++id) is_cell[id] = sides_of_cell(overlay, cells, id, side[id]);
  });
  for (int id = 0; id < count; ++id) {
    if (!is_cell[id]) continue;
    for (int i = cells.begin[id]; i < cells.begin[id + 1]; ++i)
      out.piece_cell[cells.members[i]] = static_cast<int>(out.side.size());
    out.side.push_back(side[id]);
  }
  release(out, find_touching_cells(overlay, out.piece_cell, out.side.size()));
  return out;
}

std::vector<std::string> violations_of(const RegularQuads& quads) {
  std::vector<std::string> out;
  const GridOverlay& overlay = quads.overlay;
  for (std::size_t k = 0; k < overlay.origin.size(); ++k) {
    const int o = overlay.opposite[k];
    if (o >= 0 && (overlay.opposite[o] != static_cast<int>(k) || overlay.origin[o] != overlay.target(static_cast<int>(k))))
      out.push_back("overlay half-edge " + std::to_string(k) + " is not glued to its opposite");
  }
  for (std::size_t q = 0; q < quads.side.size(); ++q) {
    int sign = 0;
    for (const int k : quads.side[q]) {
      const int s = overlay.vertices[overlay.origin[k]].grid_sign;
      if (s == 0 || s == sign) out.push_back("sides of regular quad " + std::to_string(q) + " do not alternate");
      if (quads.piece_cell[overlay.piece_of[k]] != static_cast<int>(q)) out.push_back("regular quad " + std::to_string(q) + " misses its side");
      sign = s;
    }
  }
  const std::vector<char> touching = find_touching(overlay, quads.piece_cell);
  for (std::size_t v = 0; v < touching.size(); ++v)
    if (touching[v]) out.push_back("more than two borders end at overlay vertex " + std::to_string(v) + ", which is no grid point");
  return out;
}

}  // namespace hybrid_quad
