#include <cmath>
#include <string>
#include <utility>

#include "hybrid_quad/guide_curves/guide_curves.h"
#include "hybrid_quad/guide_curves/stroke_inserter.h"

namespace hybrid_quad {

namespace {

constexpr double kLongestEdge = 0.35;  ///< of the triangles on the way, in edge lengths: the line is straight in each
constexpr double kLeastLength = 1;     ///< of a run, in edge lengths

double length_of(const StrokeTrace::Run& run) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < run.samples.size(); ++i)
    sum += (run.samples[i + 1].position - run.samples[i].position).norm();
  return sum;
}

std::string name_of(std::size_t guide) { return "guide " + std::to_string(guide); }

}  // namespace

EmbeddedStrokes embed_strokes(const TriangleMesh& mesh, const std::vector<std::array<int, 2>>& marked_edges,
                              const std::vector<GuideStroke>& strokes, double length, const RunContext& context) {
  const SurfaceIndex index(mesh, {});
  StrokeInserter inserter(mesh, index, marked_edges);
  std::vector<StrokeTrace> traces;
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < strokes.size(); ++i) {
    context.checkpoint(static_cast<double>(i) / strokes.size());
    StrokeTrace trace = trace_stroke(strokes[i], index, length);
    std::vector<StrokeTrace::Run> kept;
    bool jumps = false;
    for (StrokeTrace::Run& run : trace.runs) {
      if (length_of(run) < kLeastLength * length) continue;
      inserter.refine(run.samples, kLongestEdge * length);
      if (inserter.insert(run, static_cast<int>(i))) kept.push_back(std::move(run));
      else jumps = true;
    }
    if (jumps)
      warnings.push_back(name_of(i) + " jumps from one part of the surface to another, and was left out: draw it nearer to it");
    else if (kept.empty())
      warnings.push_back(name_of(i) + " lies off the surface or is shorter than a quad, and was left out");
    else if (trace.is_cut)
      warnings.push_back(name_of(i) + " lies in part off the surface, which was left out");
    trace.runs = std::move(kept);
    traces.push_back(std::move(trace));
  }
  EmbeddedStrokes out = inserter.take();
  out.traces = std::move(traces);
  out.warnings = std::move(warnings);
  return out;
}

}  // namespace hybrid_quad
