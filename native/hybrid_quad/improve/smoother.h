#pragma once

#include <array>
#include <vector>

#include "hybrid_quad/base/run_context.h"
#include "hybrid_quad/frame_field/guide_map.h"
#include "hybrid_quad/improve/asked_areas.h"
#include "hybrid_quad/improve/corner_energy.h"
#include "hybrid_quad/improve/point_pulls.h"
#include "hybrid_quad/improve/ring_pulls.h"
#include "hybrid_quad/improve/tip_pulls.h"
#include "hybrid_quad/improve/vertex_guides.h"
#include "hybrid_quad/improve/workpiece.h"

namespace hybrid_quad {

struct SmootherOptions {
  double chord_spring = 5;       ///< pull of curve vertices to equal chord error, more where curves bend
  double aspect_power = 0.7;     ///< 0: squares; 1: rectangles of any aspect
  double area_weight = 0.05;     ///< of areas near those asked for, or else near those around, against the corners' shape
  const std::vector<double>* asked_lengths = nullptr;  ///< #V of the input, of edges; may be null
  const GuideMap* guides = nullptr;  ///< on the input, may be null
  double guide_weight = 100;     ///< of the squared angle between an edge and a guide, against the corners' shape
  const RingPulls* rings = nullptr;  ///< may be null
  const PointPulls* points = nullptr;  ///< may be null
  TipPulls* tips = nullptr;      ///< attached whenever all are smoothed; may be null
  int threads = 1;               ///< results do not depend on it
  double still = 0.005;          ///< a vertex that moves less (in edge lengths) lets its neighbours rest
};

/// Moves vertices by Newton steps on the corner energy of the quads around (Gauss-Seidel), free ones over the input
/// surface, curve ones along their curves.
class Smoother {
 public:
  Smoother(Workpiece& piece, const SmootherOptions& options);

  /// Sweeps over all vertices, by colours without a quad in common; the regularisation shrinks as the mesh untangles.
  void smooth(int sweeps, const RunContext& context);
  /// Sweeps over some vertices one at a time (ascending) with a given regularisation, everything else fixed.
  void relax(const std::vector<int>& vertices, int sweeps, double eps);

  /// Frames of all quads / of some, from the positions as they are.
  void update_frames(bool with_references);
  void update_frames(const std::vector<int>& quads, bool with_references);
  const QuadFrame& frame(int q) const { return frames_[q]; }

  /// Smallest sine over the corners of q, signed by the frame's normal: negative where q is folded against the input.
  double signed_quality(int q) const;
  Vector3 vertex_normal(int v) const;

 private:
  struct Derivatives;
  /// What a quad's reference depends on: where its middle is, and the input faces under its free corners.
  struct ReferencePlace {
    Vector3 centre = Vector3::Zero();
    std::array<int, 4> face{-1, -1, -1, -1};
    bool has_face() const { return face != std::array<int, 4>{-1, -1, -1, -1}; }
    /// Not where no corner has a face: there is more then that a reference depends on.
    bool operator==(const ReferencePlace& other) const { return has_face() && face == other.face && centre == other.centre; }
  };
  struct Reference {
    ReferencePlace place;
    Vector3 normal = Vector3(0, 0, 1);
    int face = -1;  ///< of the input, below the middle
  };
  template <class Work>
  void for_each(const std::vector<int>& list, int chunk, const Work& work) const;
  void update_reference(int q);
  Reference reference_at(const ReferencePlace& place, int q) const;
  void update_shape(int q);
  void update_area(int q);
  bool is_tangled() const;
  double energy(int v, const Vector3& at) const;
  double energy(int v, const Vector3& at, const Vector3* basis, int dimensions, Derivatives& derivatives) const;
  GuidePull pulls_at(int v, double size) const;
  GuidePull guide_pull(int v, double size) const;
  double edge_size(int v) const;
  double move(int v);
  double move_free(int v, double size);
  double move_on_curve(int v, double size);

  Workpiece& piece_;
  SmootherOptions options_;
  double eps_ = 1e-3;
  std::vector<QuadFrame> frames_;
  AskedAreas asked_areas_;
  std::vector<double> own_area_;
  std::vector<int> centre_face_;
  std::vector<std::array<Reference, 2>> references_;  ///< #Q: the latest first; a trial that fails goes back to where it began
  VertexGuides guides_;
};

}  // namespace hybrid_quad
