#pragma once

#include <random>
#include <vector>

#include "hybrid_quad/singular_patches/patch_quads.h"

namespace hybrid_quad::test {

/// The mesh without some inner vertices and their faces: each leaves a hole of as many edges as it has faces.
/// Vertices whose stars would touch the border or another hole are not taken. \param holes how many to try
TriangleMesh punctured(const TriangleMesh& mesh, int holes, std::mt19937& random);

/// The mesh after random edge flips that keep it free of double edges and every vertex at three faces or
/// more.
TriangleMesh shuffled(const TriangleMesh& mesh, int flips, std::mt19937& random);

/// The surface of a 5 x 3 x 1 block with two square holes, each unit square in n x n cells: genus 2, closed.
TriangleMesh double_torus(int n);

enum class Values { kRandom, kConstant, kWave, kFew, kWild };

/// A patch with random nodes on every border loop (an even number >= 4) and values of the given sort inside;
/// a closed mesh has no nodes. kWild values leave [-1, 1].
PatchSurface random_patch(const TriangleMesh& mesh, Values values, std::mt19937& random);

/// A surface of the family's kind: sphere, torus, disk, annulus, tube, genus 2, each with or without holes.
TriangleMesh random_surface(int family, std::mt19937& random);
inline constexpr int kSurfaceFamilies = 10;

}  // namespace hybrid_quad::test
