#include "hybrid_quad/improve/mend.h"

#include <algorithm>
#include <functional>
#include <limits>

#include "hybrid_quad/improve/flaw_measure.h"
#include "hybrid_quad/improve/place_search.h"
#include "hybrid_quad/improve/requadrangulate.h"
#include "hybrid_quad/improve/sequence_search.h"
#include "hybrid_quad/improve/trial.h"

namespace hybrid_quad {

namespace {

class Mender {
 public:
  Mender(Workpiece& piece, Smoother& smoother, const SurfaceIndex& whole, const Agreement& agreement)
      : piece_(piece), smoother_(smoother), measure_(piece, whole, agreement), search_(piece.mesh, kEffort) {}

  void look_at_all(const RunContext& context) const { measure_.look_at_all(context); }
  bool is_flawed(int q) const { return measure_.is_flawed(q); }

  /// \returns whether fewer quads around q are flawed now
  bool mend(int q) {
    for (const int rings : {0, 1, 2})
      if (move_vertices(q, rings)) return true;
    return find_places(q) || change_neighbours(q, kLikely) || change_neighbours(q, kFar) || fill_anew(q);
  }

  bool is_poor(int q) const { return measure_.lacks_shape(q) > 0; }

  bool find_places(int q) {
    for (int i = 0; i < kTrialsOfPlaces; ++i) search_.count_trial();
    return search_places(piece_, smoother_, measure_, q);
  }

  bool exhausted() const { return search_.exhausted(); }

 private:
  static constexpr int kEffort = 100, kTrialsOfPlaces = 5;
  static constexpr double kFewer = 0.5;
  static constexpr SearchLimits kLikely{1, 30, -30, 400, 1, 40}, kFar{2, 30, -30, 4000, 12, 120};

  bool keep(Trial& trial) {
    search_.count_trial();
    return trial.keep(std::numeric_limits<double>::infinity(), kFewer);
  }

  /// Spreads the vertices of q and of some rings around it evenly over whatever part of the surface is nearest.
  bool move_vertices(int q, int rings) {
    constexpr int kSweeps = 10;
    std::vector<int> inside(piece_.mesh.quad(q).begin(), piece_.mesh.quad(q).end());
    for (int ring = 0; ring < rings; ++ring) {
      const std::vector<int> core = inside;
      for (const int v : core)
        for (const int other : piece_.mesh.quads_at(v))
          inside.insert(inside.end(), piece_.mesh.quad(other).begin(), piece_.mesh.quad(other).end());
      std::sort(inside.begin(), inside.end());
      inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
    }
    Trial trial(piece_, smoother_, inside, std::cref(measure_));
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (const int v : inside)
        if (piece_.mesh.is_free(v) && !piece_.mesh.is_pinned(v)) {
          piece_.mesh.positions[v] = mean_of_neighbours(v);
          piece_.bind_free(v, Vector3::Zero());
        }
    return keep(trial);
  }

  bool fill_anew(int q) {
    const EditMesh::Quad around = piece_.mesh.quad(q);
    for (const int v : around) {
      search_.count_trial();
      if (requadrangulate_around(piece_, smoother_, v, std::cref(measure_), kFewer)) return true;
    }
    return false;
  }

  Vector3 mean_of_neighbours(int v) const {
    Vector3 sum = Vector3::Zero();
    for (const int q : piece_.mesh.quads_at(v)) {
      const int i = piece_.mesh.corner_of(q, v);
      sum += piece_.mesh.positions[piece_.mesh.quad(q)[(i + 1) & 3]] + piece_.mesh.positions[piece_.mesh.quad(q)[(i + 3) & 3]];
    }
    return sum / (2.0 * piece_.mesh.valence(v));
  }

  bool change_neighbours(int q, const SearchLimits& limits) {
    const EditMesh::Quad seeds = piece_.mesh.quad(q);
    const std::vector<Sequence> sequences = search_.run({seeds.begin(), seeds.end()}, limits);
    for (const Sequence& sequence : sequences) {
      Trial trial(piece_, smoother_, touched_by(piece_, sequence), std::cref(measure_));
      make_sequence(piece_, sequence);
      if (keep(trial)) return true;
    }
    return false;
  }

  Workpiece& piece_;
  Smoother& smoother_;
  FlawMeasure measure_;
  SequenceSearch search_;
};

/// Changes some quads, or all (null), in rounds until one changes nothing.
template <class Change>
int in_rounds(const Workpiece& piece, const Mender& mender, const RunContext& context, const std::vector<int>* quads, const Change& change) {
  constexpr int kRounds = 3;
  int changes = 0;
  for (int round = 0, last = -1; round < kRounds && changes != last; ++round) {
    last = changes;
    for (int i = 0; i < (quads ? static_cast<int>(quads->size()) : piece.mesh.quad_count()) && !mender.exhausted(); ++i) {
      if (quads || (i & 255) == 0) context.checkpoint();
      const int q = quads ? (*quads)[i] : i;
      if (piece.mesh.alive(q)) changes += change(q);
    }
  }
  return changes;
}

int mend_in_rounds(Workpiece& piece, Mender& mender, const RunContext& context, const std::vector<int>* quads, FutileMending& futile) {
  return in_rounds(piece, mender, context, quads, [&](int q) {
    if (!mender.is_flawed(q) || futile.knows(piece, q)) return false;
    const bool mended = mender.mend(q);
    if (!mended && !mender.exhausted()) futile.remember(piece, q);
    return mended;
  });
}

}  // namespace

MendReport mend_flawed(Workpiece& piece, Smoother& smoother, const SurfaceIndex& whole, const Agreement& agreement,
                       const RunContext& context) {
  Mender mender(piece, smoother, whole, agreement);
  mender.look_at_all(context);
  FutileMending futile(piece.h);
  MendReport report;
  report.mended = mend_in_rounds(piece, mender, context, nullptr, futile);
  FutileMending without_better_places(piece.h);
  report.placed = in_rounds(piece, mender, context, nullptr, [&](int q) {
    if (!mender.is_poor(q) || without_better_places.knows(piece, q)) return false;
    const bool placed = mender.find_places(q);
    if (!placed) without_better_places.remember(piece, q);
    return placed;
  });
  return report;
}

int mend_listed(Workpiece& piece, Smoother& smoother, const SurfaceIndex& whole, const Agreement& agreement, const RunContext& context,
                const std::vector<int>& quads, FutileMending& futile) {
  Mender mender(piece, smoother, whole, agreement);
  return mend_in_rounds(piece, mender, context, &quads, futile);
}

}  // namespace hybrid_quad
