#pragma once

#include <utility>
#include <vector>

#include "hybrid_quad/improve/quad_moves.h"

namespace hybrid_quad::test {

/// Every move that may be made, with what it changes.
inline std::vector<std::pair<Move, Changed>> allowed_moves(const EditMesh& mesh) {
  std::vector<std::pair<Move, Changed>> allowed;
  for (int q = 0; q < mesh.quad_count(); ++q)
    for (const auto kind : {Move::kCollapse, Move::kCollapseAndMerge, Move::kRotateBack, Move::kRotateForth})
      for (int corner = 0; corner < 4; ++corner) {
        const Move move{kind, q, corner};
        Changed changed;
        if (may_move(mesh, move, &changed)) allowed.emplace_back(move, changed);
      }
  return allowed;
}

}  // namespace hybrid_quad::test
