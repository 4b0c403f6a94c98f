#include "hybrid_quad/pipeline/component.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "hybrid_quad/assemble/assemble.h"
#include "hybrid_quad/assemble/feature_chains.h"
#include "hybrid_quad/mesh/straight_quads.h"
#include "hybrid_quad/pipeline/snapshots.h"
#include "hybrid_quad/sizing/feature_size.h"
#include "hybrid_quad/sizing/sizing.h"

namespace hybrid_quad {

namespace {

/// How the extraction is tried when a stage's promise breaks: as designed, with integers as Psi gives them, and with no
/// regular part at all, where only the patches' guarantee is needed.
enum class Attempt { kFull, kWithoutCancellation, kPatchesOnly };

/// Settings of one whole pass over a component. The first are the defaults; the others are tried, in this order, only
/// where quads came out that fold or have no area.
struct Settings {
  double quads_factor = 1.0;
  double curl_weight = 1e-5;
  double least_length_ratio = 0.35;  ///< how far small features and thin parts may shorten edges
  double most_extra = 1.5;           ///< how many times the asked number of quads that may take
  bool for_small_parts_only = false; ///< a large component would get far too many quads
};
constexpr double kSmallPart = 300;   ///< quads
constexpr Settings kSettings[] = {
    {},
    {1.05, 1e-3, 0.35, 1.5},
    {0.96, 1e-5, 0.3, 1.5},
    {1.0, 1e-5, 0.2, 2.0},
    {1.08, 1e-4, 0.3, 1.5},
    {1.02, 1e-6, 0.4, 1.5},
    {1.5, 1e-4, 0.2, 3.0},
    {2.5, 1e-5, 0.12, 5.0, true},
    {4.0, 1e-4, 0.1, 8.0, true},
    {3.2, 1e-5, 0.1, 8.0, true},
};

struct Extraction {
  QuadMesh mesh;
  SpanningParameterization param;
  int patch_count = 0, combinatorial_count = 0;
  double singular_area = 0, combinatorial_area = 0;
  ComplexRepairReport repair;
};

template <class Violations>
void require_sound(const std::string& stage, const Violations& violations) {
  if (!violations.empty()) throw InternalError(stage, violations.front());
}

int quads_without_area(const QuadMesh& mesh) {
  // Of the squared mean edge length, as the smallest area that still counts as a face.
  constexpr double kLeastArea = 1e-10;
  double sum = 0;
  const auto point = [&](const std::array<int, 4>& q, int i) { return mesh.positions[q[i & 3]]; };
  for (const auto& q : mesh.quads)
    for (int i = 0; i < 4; ++i) sum += (point(q, i + 1) - point(q, i)).norm();
  const double mean = sum / (4.0 * static_cast<double>(mesh.quads.size()));
  int count = 0;
  for (const auto& q : mesh.quads)
    count += 0.5 * (point(q, 2) - point(q, 0)).cross(point(q, 3) - point(q, 1)).norm() <= kLeastArea * mean * mean;
  return count;
}

class ComponentRemesher {
 public:
  ComponentRemesher(const TriangleMesh& mesh, double quads_asked, double usual_length, const RemeshOptions& options, const Settings& settings,
                    StageClock& clock, const RunContext& context)
      : mesh_(mesh),
        quads_asked_(quads_asked * settings.quads_factor),
        usual_length_(usual_length),
        options_(options),
        settings_(settings),
        clock_(clock),
        context_(context) {}

  ComponentResult run(const std::vector<std::array<int, 2>>& marked) {
    result_.area = mesh_.total_area();
    length_ = std::sqrt(result_.area / quads_asked_);
    prepare(marked);
    const FrameField unit = solve_field();
    Extraction best = extract_with_count(unit);
    result_.dislocations_found = best.param.dislocations_found;
    result_.dislocations = best.param.dislocations_left;
    result_.patches = {best.patch_count, best.patch_count - best.combinatorial_count, best.combinatorial_count, 0};
    result_.singular_area = best.singular_area;
    result_.combinatorial_area = best.combinatorial_area;
    result_.mesh = std::move(best.mesh);
    constexpr double kLeastSize = 0.4, kUsualSize = 0.8;
    const SurfaceIndex index(mesh_, result_.features.face_region);
    if (options_.improve) improve(index);
    require_sound("improve", violations_of(result_.mesh));
    const int without_area = quads_without_area(result_.mesh);
    const auto inverted_below = [&](double size) {
      return static_cast<int>(inverted_quads(result_.mesh, index, size * usual_length_).size());
    };
    result_.flawed_quads = without_area + inverted_below(kLeastSize);
    result_.doubtful_quads = without_area + inverted_below(kUsualSize);
    return std::move(result_);
  }

 private:
  void prepare(const std::vector<std::array<int, 2>>& marked) {
    const RunContext context = context_.in_stage("features", 0.0, 0.03);
    context.checkpoint();
    FeatureOptions features;
    features.use_sharp_angle = options_.use_sharp_angle;
    features.sharp_angle = options_.sharp_angle;
    features.minimum_length = 3 * length_;
    features.marked_edges = marked;
    result_.features = clock_.measure("features", [&] { return detect_features(mesh_, features, context); });
    if (context_.on_snapshot) context_.on_snapshot(snapshot_of(mesh_, result_.features));
    const RunContext surface_context = context_.in_stage("working surface", 0.03, 0.2);
    surface_ = clock_.measure("working surface", [&] {
      const SurfaceIndex index(mesh_, {});
      FeatureSizeOptions sizes;
      sizes.least_ratio = settings_.least_length_ratio;
      const std::vector<double> target =
          feature_sized_lengths(index, result_.features, length_, sizes, surface_context);
      quads_asked_ = std::clamp(quads_for_lengths(mesh_, target), quads_asked_, settings_.most_extra * quads_asked_);
      return build_working_surface(mesh_, result_.features, target, WorkingSurfaceOptions{}, surface_context);
    });
    result_.working_faces = surface_.mesh.face_count();
    if (context_.on_snapshot) context_.on_snapshot(snapshot_of(surface_));
  }

  FrameField solve_field() {
    const RunContext context = context_.in_stage("frame field", 0.2, 0.3);
    FrameField unit = clock_.measure("frame field", [&] { return solve_frame_field(surface_, FrameFieldOptions{}, context); });
    result_.field_singularities = unit.cone_count();
    if (context_.on_snapshot) context_.on_snapshot(snapshot_of(unit, surface_, "frame field"));
    return unit;
  }

  /// Extracts, and asks again for more or fewer where the count came out far from what was asked.
  Extraction extract_with_count(const FrameField& unit) {
    constexpr int kTries = 3;
    constexpr double kTolerance = 0.04;
    Extraction best;
    double best_error = 0, asked = quads_asked_;
    for (int i = 0; i < kTries; ++i) {
      Extraction current = extract_by_any_means(unit, asked);
      const double got = static_cast<double>(current.mesh.quads.size());
      const double error = std::abs(std::log(got / quads_asked_));
      const bool better = i == 0 || error < best_error;
      if (better) {
        best = std::move(current);
        best_error = error;
      }
      if (best_error < kTolerance || !better || quads_asked_ < 100) break;
      asked *= std::clamp(quads_asked_ / got, 0.4, 2.5);
    }
    return best;
  }

  Extraction extract_by_any_means(const FrameField& unit, double asked) {
    for (const Attempt attempt : {Attempt::kFull, Attempt::kWithoutCancellation}) {
      try {
        return extract(unit, asked, attempt);
      } catch (const InternalError& error) {
        result_.warnings.push_back(std::string("fell back after a broken promise in ") + error.what());
      }
    }
    return extract(unit, asked, Attempt::kPatchesOnly);
  }

  Extraction extract(const FrameField& unit, double asked, Attempt attempt) {
    const SizedFrames sized = clock_.measure("sizing", [&] {
      SizingOptions o;
      o.curl_weight = settings_.curl_weight;
      return apply_sizing(surface_, unit, asked, o, context_.in_stage("sizing", 0.3, 0.4));
    });
    if (context_.on_snapshot) context_.on_snapshot(snapshot_of(sized.field, surface_, "sizing"));
    const PeriodicField psi = clock_.measure("periodic field", [&] {
      PeriodicFieldOptions o;
      o.solver = options_.solver;
      return solve_periodic_field(surface_, sized.field, o, context_.in_stage("periodic field", 0.4, 0.55));
    });
    if (context_.on_snapshot) context_.on_snapshot(snapshot_of(psi, surface_));
    Extraction out;
    out.param = clock_.measure("spanning parameterization", [&] {
      SpanningOptions o;
      o.cancel_dislocations = attempt == Attempt::kFull;
      return build_spanning_parameterization(surface_, sized.field, psi, o, context_.in_stage("spanning parameterization", 0.55, 0.7));
    });
    if (attempt == Attempt::kPatchesOnly) std::fill(out.param.is_regular.begin(), out.param.is_regular.end(), 0);
    if (context_.on_snapshot) context_.on_snapshot(snapshot_of(out.param, surface_));
    RegularQuads regular = clock_.measure("regular quads", [&] {
      return extract_regular_quads(surface_, sized.field, out.param, context_.in_stage("regular quads", 0.7, 0.76));
    });
    SingularPatches singular = clock_.measure("singular patches", [&] {
      return fill_singular_patches(surface_, sized.field, out.param, regular, PatchOptions{}, context_.in_stage("singular patches", 0.76, 0.83));
    });
    if (context_.on_snapshot) context_.on_snapshot(snapshot_of(regular, singular));
    out.mesh = clock_.measure("assemble", [&] {
      QuadComplex complex = assemble_quads(surface_, regular, singular);
      require_sound("assemble", violations_of(complex));
      if (euler_characteristic(complex) != mesh_.euler_characteristic())
        throw InternalError("assemble", "the quads have another topology than the surface");
      out.repair = repair_complex(complex);
      open_straight_quads(complex);
      QuadMesh mesh = to_quad_mesh(complex);
      order_feature_edges(mesh, mesh_, result_.features);
      return mesh;
    });
    require_sound("assemble", violations_of(out.mesh));
    if (context_.on_snapshot) context_.on_snapshot(snapshot_of(out.mesh, "assemble"));
    out.patch_count = static_cast<int>(singular.patches.size());
    out.singular_area = singular.singular_area;
    for (const FilledPatch& p : singular.patches) {
      out.combinatorial_count += p.combinatorial;
      if (p.combinatorial) out.combinatorial_area += p.area;
    }
    return out;
  }

  void improve(const SurfaceIndex& index) {
    const RunContext context = context_.in_stage("improve", 0.83, 0.97);
    clock_.measure("improve", [&] {
      ImproveOptions o;
      o.fit = options_.fit;
      o.target_length = length_;
      improve_quads(result_.mesh, mesh_, result_.features, index, o, context);
    });
    if (context_.on_snapshot) context_.on_snapshot(snapshot_of(result_.mesh, "improve"));
  }

  const TriangleMesh& mesh_;
  double quads_asked_;
  double usual_length_;
  const RemeshOptions& options_;
  const Settings& settings_;
  StageClock& clock_;
  const RunContext& context_;
  double length_ = 0;
  WorkingSurface surface_;
  ComponentResult result_;
};

}  // namespace

namespace {

/// Flawed quads, each the worse the more quads were spent; doubtful ones only where there are none.
double badness(const ComponentResult& result) {
  const double quads = static_cast<double>(result.mesh.quads.size());
  return (result.flawed_quads + 1e-6 * result.doubtful_quads) * quads;
}

}  // namespace

ComponentResult remesh_component(const TriangleMesh& mesh, double quads_asked, double usual_length,
                                 const std::vector<std::array<int, 2>>& marked, const RemeshOptions& options,
                                 StageClock& clock, const RunContext& context) {
  ComponentResult best;
  std::string broken;
  bool any = false;
  double begin = 0, end = 0.9;
  for (const Settings& settings : kSettings) {
    if (any && settings.for_small_parts_only && quads_asked > kSmallPart) break;
    try {
      const RunContext pass = context.in_stage(context.stage, begin, end);
      ComponentResult result = ComponentRemesher(mesh, quads_asked, usual_length, options, settings, clock, pass).run(marked);
      result.passes = best.passes + 1;
      if (!any || badness(result) < badness(best))
        best = std::move(result);
      else
        best.passes = result.passes;
      any = true;
      if (best.doubtful_quads == 0) break;
    } catch (const InternalError& error) {
      broken = error.what();
      ++best.passes;
    }
    begin = end;
    end += 0.5 * (1 - end);
  }
  if (!any) throw InternalError("remesh", broken);
  return best;
}

}  // namespace hybrid_quad
