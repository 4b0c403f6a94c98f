#include "hybrid_quad/improve/sequence_memory.h"

#include <utility>

namespace hybrid_quad {

const SequenceMemory::Found* SequenceMemory::recall(const EditMesh& mesh, int v, int depth) {
  if (v >= static_cast<int>(known_.size())) known_.resize(mesh.vertex_count());
  const std::uint64_t quads = quads_around(mesh, v, depth);
  if (known_[v].quads == quads) return &known_[v].found;
  known_[v].quads = quads;
  return nullptr;
}

const SequenceMemory::Found& SequenceMemory::remember(int v, Found found) {
  known_[v].found = std::move(found);
  return known_[v].found;
}

/// A hash of all quads that a search can look at.
std::uint64_t SequenceMemory::quads_around(const EditMesh& mesh, int v, int depth) {
  // A move changes vertices of its quad and of the quad across an edge, two steps away, where the next begins; whether it may
  // be made depends on the quads there.
  const int rings = 2 * depth + 1;
  constexpr std::uint64_t kFnvOffset = 14695981039346656037u, kFnvPrime = 1099511628211u;
  std::uint64_t hash = kFnvOffset;
  const auto add = [&hash](int number) { hash = (hash ^ static_cast<std::uint64_t>(number)) * kFnvPrime; };
  seen_.resize(mesh.vertex_count(), 0);
  seen_[v] = ++turn_;
  ring_ = {v};
  for (int i = 0; i < rings; ++i) {
    next_.clear();
    for (const int w : ring_)
      for (const int q : mesh.quads_at(w)) {
        add(q);
        for (const int corner : mesh.quad(q)) {
          add(corner);
          if (seen_[corner] == turn_) continue;
          seen_[corner] = turn_;
          next_.push_back(corner);
        }
      }
    ring_.swap(next_);
  }
  return hash;
}

}  // namespace hybrid_quad
