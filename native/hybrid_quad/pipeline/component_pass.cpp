#include "hybrid_quad/pipeline/component_pass.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "hybrid_quad/assemble/assemble.h"
#include "hybrid_quad/assemble/feature_chains.h"
#include "hybrid_quad/mesh/quad_count.h"
#include "hybrid_quad/mesh/straight_quads.h"
#include "hybrid_quad/pipeline/attempts.h"
#include "hybrid_quad/pipeline/count_search.h"
#include "hybrid_quad/pipeline/curve_counts.h"
#include "hybrid_quad/pipeline/extraction.h"
#include "hybrid_quad/pipeline/fewest_quads.h"
#include "hybrid_quad/pipeline/finishing.h"
#include "hybrid_quad/pipeline/guide_curves_in_quads.h"
#include "hybrid_quad/pipeline/settle_count.h"
#include "hybrid_quad/pipeline/snapshots.h"
#include "hybrid_quad/pipeline/stage_cache.h"
#include "hybrid_quad/pipeline/validity.h"
#include "hybrid_quad/sizing/feature_size.h"
#include "hybrid_quad/sizing/sizing.h"
#include "hybrid_quad/symmetry/symmetry.h"

namespace hybrid_quad {

namespace {

constexpr double kShorterWhereFlawed = 0.6;
constexpr double kShareOfTolerance = 0.6;  ///< that rows of quads are fitted to: improvement takes its own
/// From the default at the middle of the scale (less gains nothing) to frames that are kept as asked.
double curl_weight_of(double size_fidelity) { return std::pow(10.0, 10 * (size_fidelity - 1)); }

}  // namespace

class ComponentPass::Stages {
 public:
  /// \param whole  the surface that the component is part of; the field needs none
  Stages(const ComponentPlan& plan, const SurfaceIndex* whole, const Wishes& wishes, const HardGuides& guides,
         const RemeshOptions& options, const PassSettings& settings)
      : plan_(plan),
        mesh_(plan.mesh),
        topology_(topology_of(plan.mesh)),
        whole_(whole),
        wishes_(wishes),
        guides_(guides),
        options_(options),
        settings_(settings),
        tries_left_(most_tries()),
        search_(plan.quads, least_to_ask()),
        choice_(choice_of_tries(tries_left_)) {}
  Stages(const Stages&) = delete;
  Stages& operator=(const Stages&) = delete;

  /// Who measures and watches what follows.
  void set_run(StageClock& clock, const RunContext& context) {
    clock_ = &clock;
    context_ = &context;
  }

  const QuadMesh& sketch() {
    begin();
    sketched_ = next_try();
    if (!options_.improve) return sketched_->mesh;
    const RunContext context = context_->in_stage("improve", 0.83, 0.97);
    sketch_ = clock_->measure("improve", [&] { return finishing().improve_once(sketched_->mesh, context); });
    return sketch_->quads;
  }

  ComponentResult complete() {
    if (!sketched_) {
      begin();
      sketched_ = next_try();
    }
    do
      settle(*std::exchange(sketched_, std::nullopt));
    while ((sketched_ = next_try()));
    take(choice_.best());
    result_.repairs.opened_flat_quads = open_flat_quads(result_.mesh, mean_edge_length(result_.mesh));
    require_valid("improve", result_.mesh, topology_);
    const Doubts doubts = finishing().doubts(result_.mesh, context_->threads);
    for (const int q : doubts.flawed) result_.flawed_places.push_back(middle_of(result_.mesh, q));
    result_.flawed_quads = static_cast<int>(result_.flawed_places.size());
    result_.features_given_way = plan_.given_way;
    result_.marks_given_way = plan_.marks_given_way;
    result_.doubtful_quads = static_cast<int>(doubts.doubtful.size());
    for (const int q : doubts.doubtful) result_.limits.push_back(shorter_at(*plan_.index, q));
    return std::move(result_);
  }

  ComponentPreview preview() {
    begin();
    if (whole_ != nullptr) {
      Extraction quads = extract_somehow(plan_.quads, plan_.quads);
      finishing().make_mirrorable(quads.mesh, context_->in_stage("assemble", 0.97, 0.97));
      quads.features = plan_.features;
      take(std::move(quads));
    } else {
      sized_ = as_large_as_asked(unit_);
    }
    return {std::move(surface_), std::move(sized_), std::move(result_)};
  }

 private:
  void begin() {
    result_.area = mesh_.total_area();
    prepare();
    unit_ = solve_field();
  }

  /// Made once, by who needs it: the field does not.
  const Finishing& finishing() {
    if (!finishing_) finishing_.emplace(plan_, *whole_, wishes_, options_);
    return *finishing_;
  }

  /// What `make` gives, or gave in an earlier run for the same lengths.
  template <class Make>
  auto recalled_for_plan(StageCache::Level level, const std::string& stage, const Make& make) const {
    return recalled(plan_.part < 0 ? nullptr : context_->cache, {level, stage, plan_.part, plan_.quads}, make);
  }

  /// Edges of the working surface have to be short beside the shorter sides of quads.
  std::vector<double> lengths_across() const {
    std::vector<double> lengths = plan_.target;
    if (plan_.thin_stretch.is_any())
      for (double& length : lengths) length = plan_.thin_stretch.across(length);
    return lengths;
  }

  void prepare() {
    if (context_->on_snapshot) context_->on_snapshot(snapshot_of(mesh_, plan_.features));
    struct Checked {
      WorkingSurface surface;
      std::vector<std::string> violations;
    };
    const WorkingSurfaceOptions surface_options = working_surface_options(wishes_, plan_.quads, !plan_.guides.empty());
    Checked checked = clock_->measure("working surface", [&] {
      return recalled_for_plan(StageCache::Level::kPlan, "working surface", [&] {
        Checked made{build_working_surface(*plan_.index, plan_.features, lengths_across(), surface_options,
                                           context_->in_stage("working surface", 0, 0.2)),
                     {}};
        if (plan_.thin_stretch.is_any())
          for (double& length : made.surface.target_length) length = plan_.thin_stretch.with_across(length);
        made.violations = violations_of(made.surface, mesh_, plan_.features);
        return made;
      });
    });
    surface_ = std::move(checked.surface);
    result_.working_faces = surface_.mesh.face_count();
    // Shapes that it did not reach may still do: what is assembled is checked against the input again.
    if (!checked.violations.empty()) {
      ++result_.repairs.broken_promises;
      result_.warnings.push_back("the working surface is not as promised: " + checked.violations.front());
    }
    if (context_->on_snapshot) context_->on_snapshot(snapshot_of(surface_));
  }

  FrameField solve_field() {
    const RunContext context = context_->in_stage("frame field", 0.2, 0.3);
    struct Solved {
      FrameField unit;
      std::vector<double> direction_weight;
      std::vector<Eigen::Matrix3d> stretch;
    };
    Solved solved = clock_->measure("frame field", [&] {
      return recalled_for_plan(StageCache::Level::kField, "frame field", [&] {
        const FrameFieldOptions o = field_options(surface_, wishes_, options_);
        Solved made{solve_frame_field(surface_, o, context), direction_weights(o), {}};
        made.stretch = stretch_of(surface_, made.unit, wishes_, options_, plan_.thin_stretch);
        return made;
      });
    });
    direction_weight_ = std::move(solved.direction_weight);
    stretch_ = std::move(solved.stretch);
    FrameField unit = std::move(solved.unit);
    result_.field_singularities = unit.singularity_count();
    result_.feature_singularities = unit.feature_cones;
    result_.field_choice = unit.choice;
    if (context_->on_snapshot) context_->on_snapshot(snapshot_of(unit, surface_, "frame field"));
    return unit;
  }

  /// Extracts quads that are worth improving. Asks for more or fewer than the last time where the number came out far from what is wanted;
  /// where that does not help at once, rows of quads are split or taken out.
  /// \returns none where no further try is to be made
  std::optional<Extraction> next_try() {
    constexpr int kTriesWithoutRows = 1;
    while (tries_left_ > 0) {
      const bool is_stuck = search_.at_least() || search_.is_stuck();
      if (choice_.any() && is_stuck && tries_made_ > kTriesWithoutRows) break;
      --tries_left_;
      if (is_stuck) tries_left_ = 0;
      const bool is_later = settings_.kind != PassKind::kFirst;
      const bool with_rows =
          settings_.kind != PassKind::kAsNeeded && (is_later || tries_left_ == 0 || tries_made_ >= kTriesWithoutRows);
      ++tries_made_;
      Extraction current = extract_somehow(search_.next(), with_rows ? choice_.lost() * plan_.quads : 0);
      result_.extracted_quads += current.count();
      result_.work += work_of(current);
      if (!choice_.is_far(current)) return current;
      search_.record(current.quads_before_rows / choice_.lost());
      choice_.set_aside(std::move(current));
      if (tries_left_ == 0 && !choice_.any()) return choice_.nearest_set_aside();
    }
    return std::nullopt;
  }

  /// Improves what a try gave, and decides whether there is to be another.
  void settle(Extraction current) {
    const double before_rows = current.quads_before_rows, extracted = current.count();
    finish(current);
    if (choice_.lacks_only_soundness(current)) split_flawed(current);
    choice_.take(std::move(current), extracted);
    if (choice_.is_done() || is_in_vain(extracted, choice_)) tries_left_ = 0;
    else search_.record(before_rows / choice_.lost());
  }

  /// In faces of the working surface, of which there are more than three for a quad, unless counted curves ask for so many quads.
  double work_of(const Extraction& extraction) const {
    constexpr double kFacesPerQuad = 3;
    return std::max<double>(result_.working_faces, kFacesPerQuad * extraction.quads_before_rows);
  }

  /// Where improvement takes out most quads, as those that counted curves squeeze, it takes out what another try has more of.
  static bool is_in_vain(double extracted, const ExtractionChoice& choice) {
    constexpr double kMostLost = 2;
    return extracted >= kFew && choice.lost() > kMostLost;
  }

  static constexpr int kFew = 1000;  ///< quads: few are quick, and off by more of their number

  int most_tries() const {
    constexpr int kOfMany = 4, kOfFew = 7;
    return plan_.quads < kFew && !settings_.is_doubtful && settings_.quads_factor == 1 && settings_.kind != PassKind::kAsNeeded
               ? kOfFew
               : kOfMany;
  }

  /// Passes after the first are there for flawed quads: there the count matters less.
  ExtractionChoice choice_of_tries(int tries) const {
    constexpr double kNearAsNeeded = 0.15, kLastResort = 2, kFar = 0.15, kRough = 0.5;
    const auto choice = [&](double tolerance, int enough_with_flaws, double far) {
      return ExtractionChoice(plan_.quads, tolerance, enough_with_flaws, far,
                              [&](const QuadMesh& quads) { return mean_distance_in_edges(quads, *plan_.index, context_->in_stage("improve", 0.97, 0.97)); });
    };
    if (settings_.is_rough) return choice(kRough, 1, kRough);
    if (settings_.kind == PassKind::kFirst) return choice(count_tolerance(), 2, kFar);
    if (settings_.kind == PassKind::kAgain) return choice(kNearAsNeeded, 2, kFar);
    return choice(kNearAsNeeded, settings_.quads_factor < kLastResort ? 1 : tries, kFar);
  }

  /// Rows that counted curves call for are not paid for by ever larger quads everywhere else.
  double least_to_ask() const {
    constexpr double kLeastBesideCounts = 0.6;
    const auto& curves = plan_.features.curves;
    const bool any = std::any_of(curves.begin(), curves.end(), [](const FeatureCurve& c) { return c.asked_count > 0; });
    return any ? kLeastBesideCounts * plan_.quads : 0;
  }

  /// Of the logarithm of the number of quads.
  double count_tolerance() const {
    constexpr double kTolerance = 0.035, kToleranceInQuads = 2;
    return std::max(kTolerance, kToleranceInQuads / plan_.quads);
  }

  void finish(Extraction& extraction) {
    if (options_.improve) improve(extraction);
    finishing().make_mirrorable(extraction.mesh, context_->in_stage("improve", 0.97, 0.97));
    extraction.missed = missed_counts(plan_.features, extraction.mesh);
    settle_hard_guides(extraction);
  }

  /// Splits a few sides rather than settling for a number farther from the one asked for.
  void split_flawed(Extraction& extraction) {
    if (!plan_.guides.empty()) return;
    const RunContext context = context_->in_stage("improve", 0.97, 0.97);
    extraction.repairs.split_sides += clock_->measure("improve", [&] { return finishing().split_flawed(extraction.mesh, context); });
    extraction.flawed = static_cast<int>(finishing().flawed(extraction.mesh, context.threads).size());
  }

  void take(Extraction best) {
    result_.dislocations_found = best.param.dislocations_found;
    result_.dislocations = best.param.dislocations_left;
    result_.patches = {best.patch_count, best.patch_count - best.combinatorial_count, best.combinatorial_count, 0};
    result_.singular_area = best.singular_area;
    result_.combinatorial_area = best.combinatorial_area;
    result_.repairs += best.repairs;
    result_.missed_counts = best.missed;
    result_.mesh = std::move(best.mesh);
    result_.rings = std::move(best.rings);
    result_.chains = std::move(best.chains);
    result_.features = plan_.guides.empty() ? plan_.features : std::move(best.features);
    result_.curve_planes = seam_planes(mesh_, result_.features, options_.symmetry.planes);
  }

  /// \param wanted  number of quads to be met by rows; 0: as many as come out
  Extraction extract_somehow(double asked, double wanted) {
    const auto extracted = [&](Attempt attempt) { return extract(asked, wanted, attempt); };
    return extract_by_any_means(extracted, result_.repairs, result_.warnings);
  }

  /// Without regard to what fits together, which is what takes its time.
  FrameField as_large_as_asked(FrameField unit) const {
    for (int f = 0; f < surface_.mesh.face_count(); ++f) {
      unit.du[f] /= surface_.target_length[f];
      unit.dv[f] /= surface_.target_length[f];
    }
    return unit;
  }

  /// Frames for a number of quads. Where that only scales them, they are solved for once.
  FrameField sized_frames(double asked) {
    return clock_->measure("sizing", [&] {
      if (!sized_.du.empty() && quads_only_scale(surface_)) {
        scale_to_quads(surface_.mesh, asked, sized_);
        return sized_;
      }
      SizingOptions o;
      constexpr double kWhereAsked = 100;  // sizes that someone asked for count more than even ones
      const bool asked_sizes = !wishes_.density.empty() || !wishes_.corner_frames.empty();
      const double fidelity = curl_weight_of(options_.size_fidelity) * (asked_sizes ? kWhereAsked : 1);
      o.curl_weight = std::max(settings_.curl_weight, fidelity);
      o.direction_weight = direction_weight_;
      o.stretch = stretch_;
      sized_ = apply_sizing(surface_, unit_, asked, o, context_->in_stage("sizing", 0.3, 0.4)).field;
      return sized_;
    });
  }

  Extraction extract(double asked, double wanted, Attempt attempt) {
    const FrameField frames = sized_frames(asked);
    if (context_->on_snapshot) context_->on_snapshot(snapshot_of(frames, surface_, "sizing"));
    const PeriodicField psi = clock_->measure("periodic field", [&] {
      PeriodicFieldOptions o;
      o.solver = options_.solver;
      o.strip_rows = options_.narrow_quads;
      return solve_periodic_field(surface_, frames, o, context_->in_stage("periodic field", 0.4, 0.55));
    });
    if (context_->on_snapshot) context_->on_snapshot(snapshot_of(psi, surface_));
    Extraction out;
    out.param = clock_->measure("spanning parameterization", [&] {
      SpanningOptions o;
      o.strip_rows = options_.narrow_quads;
      o.cancel_dislocations = attempt == Attempt::kFull;
      return build_spanning_parameterization(surface_, frames, psi, o, context_->in_stage("spanning parameterization", 0.55, 0.7));
    });
    if (attempt == Attempt::kPatchesOnly)
      std::fill(out.param.is_regular.begin(), out.param.is_regular.end(), 0);
    else
      require_sound("spanning parameterization", violations_of(out.param, surface_, frames));
    if (context_->on_snapshot) context_->on_snapshot(snapshot_of(out.param, surface_));
    RegularQuads regular = clock_->measure("regular quads", [&] {
      return extract_regular_quads(surface_, frames, out.param, context_->in_stage("regular quads", 0.7, 0.76));
    });
    require_sound("regular quads", violations_of(regular));
    SingularPatches singular = clock_->measure("singular patches", [&] {
      return fill_singular_patches(surface_, frames, out.param, regular, PatchOptions{}, context_->in_stage("singular patches", 0.76, 0.83));
    });
    if (context_->on_snapshot) context_->on_snapshot(snapshot_of(regular, singular));
    out.mesh = clock_->measure("assemble", [&] {
      QuadComplex complex = assemble_quads(surface_, regular, singular);
      require_sound("assemble", violations_of(complex));
      if (topology_of(complex) != topology_)
        throw InternalError("assemble", "the quads have another topology than the surface");
      std::vector<char> counted;
      for (const FeatureCurve& curve : plan_.features.curves) counted.push_back(curve.asked_count > 0);
      const ComplexRepairReport repair = repair_complex(complex, counted);
      out.repairs.released_quads = singular.released_cells;
      out.repairs.removed_quads = repair.cancelled_singlets + repair.merged_doublets;
      out.repairs.added_rings = repair.inset_quads + repair.restarred_edges;
      out.repairs.split_polychords = repair.split_polychords;
      out.quads_before_rows = complex.quad_count();
      if (is_in_reach(complex.quad_count(), wanted) && plan_.guides.empty() && wishes_.most_stretch <= 1)
        out.repairs.fitted_rows = fit_quad_count(complex, wanted, kShareOfTolerance * count_tolerance() * wanted, counted,
                                                 context_->in_stage("assemble", 0.83, 0.83));
      out.repairs.opened_straight_quads = open_straight_quads(complex);
      open_seams(complex, plan_.curve_planes);
      QuadMesh mesh = to_quad_mesh(complex);
      order_feature_edges(mesh, mesh_, plan_.features);
      return mesh;
    });
    require_valid("assemble", out.mesh, topology_);
    if (context_->on_snapshot) context_->on_snapshot(snapshot_of(out.mesh, "assemble"));
    out.patch_count = static_cast<int>(singular.patches.size());
    out.singular_area = singular.singular_area;
    for (const FilledPatch& p : singular.patches) {
      out.combinatorial_count += p.combinatorial;
      if (p.combinatorial) out.combinatorial_area += p.area;
    }
    return out;
  }

  /// Rows are taken out or split one after the other, a third of the quads at most: from farther off they take long, and lead nowhere.
  static bool is_in_reach(double quads, double wanted) {
    constexpr double kReach = 4;
    return wanted > 0 && quads < kReach * wanted && wanted < kReach * quads;
  }

  /// A limit below the length that was asked at quad q.
  LengthLimit shorter_at(const SurfaceIndex& index, int q) const {
    const Vector3 centre = middle_of(result_.mesh, q);
    double length = std::numeric_limits<double>::infinity();
    for (const int v : mesh_.face(index.nearest(centre).face)) length = std::min(length, plan_.target[v]);
    return {centre, kShorterWhereFlawed * length};
  }

  void improve(Extraction& extraction) {
    const RunContext context = context_->in_stage("improve", 0.83, 0.97);
    const ImproveReport report = clock_->measure("improve", [&] { return finishing().improve(extraction.mesh, context, std::exchange(sketch_, std::nullopt)); });
    extraction.repairs.mended_places += report.mended;
    extraction.repairs.poor_places += report.placed;
    extraction.repairs.released_tips += report.released_tips;
    extraction.repairs.restored_quads += report.restored_quads;
    extraction.flawed = report.flawed_after;
    if (context_->on_snapshot) context_->on_snapshot(snapshot_of(extraction.mesh, "improve"));
  }

  void settle_hard_guides(Extraction& extraction) {
    if (plan_.guides.empty()) return;
    const RunContext context = context_->in_stage("hard guides", 0.97, 0.97);
    clock_->measure("hard guides", [&] {
      GuidedQuads guided{std::move(extraction.mesh), plan_.features, {}, {}, extraction.flawed};
      settle_guides(guided, plan_, guides_, finishing().options(), options_, *whole_, context);
      extraction.mesh = std::move(guided.mesh);
      extraction.features = std::move(guided.features);
      extraction.rings = std::move(guided.rings);
      extraction.chains = std::move(guided.chains);
      extraction.flawed = guided.flawed;
    });
    require_sound("hard guides", violations_of(extraction.mesh));
    keep_clear_of_planes(extraction.mesh, options_.symmetry.planes);
  }

  const ComponentPlan& plan_;
  const TriangleMesh& mesh_;
  const Topology topology_;
  const SurfaceIndex* whole_;
  const Wishes& wishes_;
  const HardGuides& guides_;
  const RemeshOptions& options_;
  std::optional<Finishing> finishing_;
  const PassSettings settings_;
  StageClock* clock_ = nullptr;
  const RunContext* context_ = nullptr;
  int tries_left_, tries_made_ = 0;
  CountSearch search_;
  ExtractionChoice choice_;
  std::optional<Extraction> sketched_;  ///< the latest try, where it is still to be settled
  std::optional<Improved> sketch_;      ///< what improving it once made of it
  WorkingSurface surface_;
  FrameField unit_;
  FrameField sized_;  ///< of the latest try
  std::vector<double> direction_weight_;  ///< see SizingOptions
  std::vector<Eigen::Matrix3d> stretch_;
  ComponentResult result_;
};

ComponentPass::ComponentPass(const ComponentPlan& plan, const SurfaceIndex& whole, const Wishes& wishes, const HardGuides& guides,
                             const RemeshOptions& options, const PassSettings& settings)
    : stages_(std::make_unique<Stages>(plan, &whole, wishes, guides, options, settings)) {}

ComponentPass::ComponentPass(ComponentPass&&) noexcept = default;
ComponentPass& ComponentPass::operator=(ComponentPass&&) noexcept = default;
ComponentPass::~ComponentPass() = default;

const QuadMesh& ComponentPass::sketch(StageClock& clock, const RunContext& context) {
  stages_->set_run(clock, context);
  return stages_->sketch();
}

ComponentResult ComponentPass::complete(StageClock& clock, const RunContext& context) {
  stages_->set_run(clock, context);
  return stages_->complete();
}

ComponentPreview ComponentPass::preview(const ComponentPlan& plan, const SurfaceIndex* whole, const Wishes& wishes,
                                        const HardGuides& guides, const RemeshOptions& options, const PassSettings& settings,
                                        StageClock& clock, const RunContext& context) {
  Stages stages(plan, whole, wishes, guides, options, settings);
  stages.set_run(clock, context);
  return stages.preview();
}

ComponentResult run_pass(const ComponentPlan& plan, const SurfaceIndex& whole, const Wishes& wishes, const HardGuides& guides,
                         const RemeshOptions& options, const PassSettings& settings, StageClock& clock, const RunContext& context) {
  return ComponentPass(plan, whole, wishes, guides, options, settings).complete(clock, context);
}

ComponentPreview preview_pass(const ComponentPlan& plan, const SurfaceIndex* whole, const Wishes& wishes,
                              const HardGuides& guides, const RemeshOptions& options, const PassSettings& settings,
                              StageClock& clock, const RunContext& context) {
  return ComponentPass::preview(plan, whole, wishes, guides, options, settings, clock, context);
}

}  // namespace hybrid_quad
