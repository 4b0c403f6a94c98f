#include "hybrid_quad/improve/trial.h"

#include <algorithm>
#include <utility>

namespace hybrid_quad {

Trial::Trial(Workpiece& piece, Smoother& smoother, std::vector<int> vertices, Measure measure)
    : piece_(piece),
      smoother_(smoother),
      measure_(std::move(measure)),
      mark_(piece.mesh.mark()),
      vertices_(std::move(vertices)) {
  std::sort(vertices_.begin(), vertices_.end());
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  for (const int v : vertices_) {
    positions_.push_back(piece_.mesh.positions[v]);
    faces_.push_back(piece_.face[v]);
    arcs_.push_back(piece_.arc[v]);
  }
  old_vertices_ = piece_.mesh.vertex_count();
  collect_quads(vertices_);
  before_ = measured();
}

void Trial::collect_quads(const std::vector<int>& vertices) {
  quads_.clear();
  for (const int v : vertices) quads_.insert(quads_.end(), piece_.mesh.quads_at(v).begin(), piece_.mesh.quads_at(v).end());
  std::sort(quads_.begin(), quads_.end());
  quads_.erase(std::unique(quads_.begin(), quads_.end()), quads_.end());
}

double Trial::measured() const {
  if (measure_) return measure_(quads_);
  double least = 1;
  for (const int q : quads_) least = std::min(least, smoother_.signed_quality(q));
  return least;
}

bool Trial::keep(double good_enough, double gain) {
  std::vector<int> inside;
  for (const int v : vertices_)
    if (piece_.mesh.valence(v) > 0) inside.push_back(v);
  for (int v = old_vertices_; v < piece_.mesh.vertex_count(); ++v) inside.push_back(v);
  smoother_.relax(inside, 2, 0.1);
  smoother_.relax(inside, 3, 1e-3);
  collect_quads(inside);
  if (measured() >= std::min(before_ + gain, good_enough)) {
    piece_.mesh.forget_log();
    return true;
  }
  piece_.mesh.undo_to(mark_);
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    piece_.mesh.positions[vertices_[i]] = positions_[i];
    piece_.face[vertices_[i]] = faces_[i];
    piece_.arc[vertices_[i]] = arcs_[i];
  }
  collect_quads(vertices_);
  smoother_.update_frames(quads_, true);
  return false;
}

}  // namespace hybrid_quad
