#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "hybrid_quad/mesh/complex_editor.h"
#include "hybrid_quad/mesh/polychords.h"
#include "hybrid_quad/mesh/quad_complex.h"
#include "support/patches.h"
#include "support/quad_complexes.h"

namespace hybrid_quad {
namespace {

using namespace test;

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (std::size_t i = 0; i < lines.size() && i < 8; ++i) all += lines[i] + "; ";
  return all;
}

/// Edges and vertices of odd degree of every curve, corners: what repairs must keep, but for the number of
/// edges, which may grow.
struct Features {
  std::map<int, int> edges;
  std::map<int, int> ends;
  std::vector<int> corners;
};

Features features_of(const QuadComplex& c) {
  Features f;
  std::map<std::pair<int, int>, int> degree;
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d) {
    if (c.curve[d] < 0 || (c.opposite[d] >= 0 && c.opposite[d] < d)) continue;
    ++f.edges[c.curve[d]];
    ++degree[{c.curve[d], c.from(d)}];
    ++degree[{c.curve[d], c.to(d)}];
  }
  for (const auto& [key, count] : degree) f.ends[key.first] += count % 2;
  for (std::size_t v = 0; v < c.kind.size(); ++v)
    if (c.kind[v] == VertexKind::kCorner) f.corners.push_back(c.anchor[v]);
  std::sort(f.corners.begin(), f.corners.end());
  return f;
}

void expect_repaired(QuadComplex c, const std::string& name) {
  ASSERT_TRUE(violations_of(c).empty()) << name << joined(violations_of(c));
  const int chi = euler_characteristic(c);
  const std::size_t borders = border_loop_lengths(c).size();
  const Features before = features_of(c);
  repair_complex(c);
  EXPECT_TRUE(violations_of(c).empty()) << name << joined(violations_of(c));
  EXPECT_TRUE(violations_of(to_quad_mesh(c)).empty()) << name << joined(violations_of(to_quad_mesh(c)));
  EXPECT_EQ(euler_characteristic(c), chi) << name;
  EXPECT_EQ(border_loop_lengths(c).size(), borders) << name;
  for (const int length : border_loop_lengths(c)) EXPECT_GE(length, 4) << name;
  const Features after = features_of(c);
  EXPECT_EQ(after.corners, before.corners) << name;
  EXPECT_EQ(after.ends, before.ends) << name;
  for (const auto& [curve, edges] : before.edges) {
    ASSERT_TRUE(after.edges.count(curve)) << name;
    EXPECT_GE(after.edges.at(curve), edges) << name;
  }
}

/// Makes every side whose middle the test accepts a feature, its ends curve vertices.
template <typename Test>
void mark_features(QuadComplex& c, int curve, Test&& accepts) {
  for (int d = 0; d < static_cast<int>(c.opposite.size()); ++d)
    if (accepts(d) || (c.opposite[d] >= 0 && accepts(c.opposite[d]))) {
      c.curve[d] = curve;
      for (const int v : {c.from(d), c.to(d)}) {
        c.kind[v] = VertexKind::kCurve;
        c.anchor[v] = curve;
      }
    }
}

TEST(RepairComplex, ThinTubesToriAndPillows) {
  for (int n = 1; n <= 4; ++n)
    for (int m = 1; m <= 4; ++m) {
      const std::string size = std::to_string(n) + " x " + std::to_string(m) + ": ";
      expect_repaired(quad_tube(n, m), "tube " + size);
      expect_repaired(quad_torus(n, m), "torus " + size);
    }
  expect_repaired(pillow(), "pillow: ");
}

TEST(RepairComplex, FeaturesOnThinTubesTorAndPillowsStay) {
  for (int n = 1; n <= 4; ++n)
    for (int m = 1; m <= 4; ++m) {
      QuadComplex ring = quad_tube(n, m), line = quad_tube(n, m), torus = quad_torus(n, m);
      mark_features(ring, 5, [&](int d) { return d < 4 * n && d % 4 == 2; });
      mark_features(line, 6, [&](int d) { return d % (4 * n) == 1; });
      mark_features(torus, 7, [&](int d) { return d % 4 == 0; });
      expect_repaired(ring, "ring ");
      expect_repaired(line, "line ");
      expect_repaired(torus, "torus ");
    }
  QuadComplex seam = pillow();
  mark_features(seam, 1, [](int d) { return d < 4; });
  expect_repaired(seam, "seam ");
  for (VertexKind& k : seam.kind) k = VertexKind::kCorner;
  for (std::size_t v = 0; v < seam.anchor.size(); ++v) seam.anchor[v] = 10 + static_cast<int>(v);
  expect_repaired(seam, "corners ");
}

TEST(RepairComplex, WhateverMorseSmaleComplexesLeave) {
  constexpr Values kAllValues[] = {Values::kRandom, Values::kConstant, Values::kWave, Values::kFew,
                                   Values::kWild};
  for (int seed = 0; seed < 600; ++seed) {
    std::mt19937 random(4000 + seed);
    const TriangleMesh mesh = random_surface(seed % kSurfaceFamilies, random);
    const PatchSurface patch = random_patch(mesh, kAllValues[(seed / kSurfaceFamilies) % 5], random);
    const PatchQuads quads = morse_smale_quads(patch, seed % 2 ? 0.3 : 0.0, RunContext{});
    if (quads.quads.empty()) continue;
    QuadComplex c;
    c.opposite = quads.opposite;
    c.curve = quads.arc;
    c.positions = quads.positions;
    for (const auto& q : quads.quads) c.vertex.insert(c.vertex.end(), q.begin(), q.end());
    for (std::size_t v = 0; v < quads.node.size(); ++v) {
      c.kind.push_back(quads.node[v] >= 0 ? VertexKind::kCorner : VertexKind::kFree);
      c.anchor.push_back(quads.node[v] >= 0 ? quads.node[v] : 0);
      c.near_face.push_back(-1);
    }
    // Some inner sides are features too.
    mark_features(c, 1000, [&](int d) { return c.opposite[d] > d && d % 7 == seed % 7 && seed % 3 == 0; });
    for (std::size_t v = 0; v < quads.node.size(); ++v)
      if (quads.node[v] >= 0) {
        c.kind[v] = VertexKind::kCorner;
        c.anchor[v] = quads.node[v];
      }
    expect_repaired(c, "seed " + std::to_string(seed) + ": ");
  }
}

TEST(RepairComplex, LeavesGoodComplexesAlone) {
  for (QuadComplex c :
       {quad_box(2, 3, 2), quad_grid(1, 1), quad_grid(5, 4), quad_torus(5, 5), quad_box(1, 1, 1)}) {
    const QuadComplex before = c;
    const ComplexRepairReport report = repair_complex(c);
    EXPECT_EQ(c.vertex, before.vertex);
    EXPECT_EQ(c.opposite, before.opposite);
    EXPECT_EQ(report.split_polychords + report.restarred_edges + report.inset_quads + report.merged_doublets,
              0);
  }
}

TEST(RepairComplex, AnyLocalChangeKeepsTheSurface) {
  for (int seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    QuadComplex c = seed % 4 == 0   ? quad_box(2, 3, 2)
                    : seed % 4 == 1 ? quad_grid(5, 4)
                    : seed % 4 == 2 ? quad_torus(3, 4)
                                    : quad_tube(3, 3);
    const int chi = euler_characteristic(c);
    const std::size_t borders = border_loop_lengths(c).size();
    if (seed % 3 == 0) mark_features(c, 8, [&](int d) { return d % 5 == 0; });
    const Features features = features_of(c);
    ComplexEditor editor(c);
    for (int k = 0; k < 60; ++k) {
      const int d = static_cast<int>(random() % c.opposite.size());
      if (!editor.alive(d / 4)) continue;
      switch (random() % 3) {
        case 0:
          if (editor.can_collapse(d)) editor.collapse(d);
          break;
        case 1:
          if (editor.can_restar(d)) {
            const int spared = c.to(d);
            editor.restar(d, 0);
            EXPECT_GE(editor.corner_count(spared), editor.on_border(spared) ? 1 : 3);
          }
          break;
        default:
          if (k % 10 == 0) editor.inset(d / 4, 0);
      }
    }
    editor.compact();
    ASSERT_TRUE(violations_of(c).empty()) << seed << joined(violations_of(c));
    EXPECT_EQ(euler_characteristic(c), chi);
    EXPECT_EQ(border_loop_lengths(c).size(), borders);
    EXPECT_EQ(features_of(c).edges, features.edges);
    EXPECT_EQ(features_of(c).ends, features.ends);
    const ComplexEditor fresh(c);
    for (std::size_t v = 0; v < c.positions.size(); ++v) {
      EXPECT_EQ(editor.corner_count(static_cast<int>(v)), fresh.corner_count(static_cast<int>(v)));
      EXPECT_EQ(editor.on_border(static_cast<int>(v)), fresh.on_border(static_cast<int>(v)));
    }
    expect_repaired(c, "seed " + std::to_string(seed) + ": ");
  }
}

TEST(Polychords, SplittingAllRefinesEveryQuadIntoFour) {
  for (const QuadComplex& c :
       {quad_box(1, 2, 1), quad_tube(1, 1), quad_torus(1, 1), pillow(), quad_grid(2, 3)}) {
    const Polychords p = trace_polychords(c);
    int crossings = 0;
    for (const int l : p.length) crossings += l;
    EXPECT_EQ(crossings, 2 * c.quad_count());
    const QuadComplex fine = split_polychords(c, p, std::vector<char>(p.length.size(), 1));
    EXPECT_TRUE(violations_of(fine).empty()) << joined(violations_of(fine));
    EXPECT_EQ(fine.quad_count(), 4 * c.quad_count());
    EXPECT_EQ(euler_characteristic(fine), euler_characteristic(c));
  }
}

TEST(Polychords, SplittingOneAddsItsLength) {
  const QuadComplex c = quad_grid(5, 3);
  const Polychords p = trace_polychords(c);
  for (std::size_t k = 0; k < p.length.size(); ++k) {
    std::vector<char> chosen(p.length.size(), 0);
    chosen[k] = 1;
    const QuadComplex fine = split_polychords(c, p, chosen);
    EXPECT_EQ(fine.quad_count(), c.quad_count() + p.length[k]);
    EXPECT_TRUE(violations_of(to_quad_mesh(fine)).empty());
  }
}

}  // namespace
}  // namespace hybrid_quad
