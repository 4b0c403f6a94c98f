#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/mesh/surface_index.h"
#include "support/meshes.h"

namespace hybrid_quad {
namespace {

std::vector<std::vector<int>> polygons_of(const PolygonSoup& soup) {
  std::vector<std::vector<int>> polygons;
  auto corner = soup.face_vertices.begin();
  for (const int size : soup.face_sizes) {
    polygons.emplace_back(corner, corner + size);
    corner += size;
  }
  return polygons;
}

PolygonSoup soup_of_polygons(std::vector<Vector3> positions, const std::vector<std::vector<int>>& polygons) {
  PolygonSoup soup;
  soup.positions = std::move(positions);
  for (const auto& p : polygons) {
    soup.face_sizes.push_back(static_cast<int>(p.size()));
    soup.face_vertices.insert(soup.face_vertices.end(), p.begin(), p.end());
  }
  return soup;
}

struct Shuffled {
  PolygonSoup soup;
  std::vector<int> place;  ///< of each vertex of the usual soup
};

Shuffled shuffled(const PolygonSoup& soup, unsigned seed) {
  std::mt19937 random(seed);
  Shuffled out;
  out.place.resize(soup.positions.size());
  std::iota(out.place.begin(), out.place.end(), 0);
  std::shuffle(out.place.begin(), out.place.end(), random);
  std::vector<Vector3> positions(soup.positions.size());
  for (std::size_t v = 0; v < positions.size(); ++v) positions[out.place[v]] = soup.positions[v];
  std::vector<std::vector<int>> polygons = polygons_of(soup);
  for (auto& p : polygons) {
    for (int& v : p) v = out.place[v];
    std::rotate(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(random() % p.size()), p.end());
  }
  std::shuffle(polygons.begin(), polygons.end(), random);
  out.soup = soup_of_polygons(std::move(positions), polygons);
  return out;
}

Eigen::Matrix3d random_rotation(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const double w = normal(random), x = normal(random), y = normal(random), z = normal(random);
  return Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
}

PolygonSoup moved(PolygonSoup soup, const Eigen::Matrix3d& turn, const Vector3& shift) {
  for (Vector3& p : soup.positions) p = turn * p + shift;
  return soup;
}

/// A box of quads and an ellipsoid beside it, and on them much of what files can have wrong.
PolygonSoup dirty_soup() {
  PolygonSoup soup = test::soup_of(test::icosphere(2, 0.4));
  std::vector<std::vector<int>> polygons = polygons_of(soup);
  std::vector<Vector3> positions = soup.positions;
  for (Vector3& p : positions) p = p.cwiseProduct(Vector3(1, 1.3, 0.8)) + Vector3(2, 0.1, 0.3);
  polygons.push_back({polygons[3][0], polygons[3][2], polygons[3][1]});  // a copy, the other way round
  std::swap(polygons[10][0], polygons[10][1]);
  std::swap(polygons[11][0], polygons[11][1]);
  // A grid of quads, of which one is cut so that its half has a vertex in the middle of a side, and one has its corners in a line.
  const int first = static_cast<int>(positions.size()), n = 5;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) positions.push_back(Vector3(0.21 * i, 0.17 * j, 0));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = first + j * (n + 1) + i;
      if (i == 2 && j == 2) continue;
      polygons.push_back({a, a + 1, a + n + 2, a + n + 1});
    }
  const int a = first + 2 * (n + 1) + 2, middle = static_cast<int>(positions.size());
  positions.push_back(0.5 * (positions[a] + positions[a + 1]));
  polygons.push_back({a, middle, a + n + 1});
  polygons.push_back({middle, a + 1, a + n + 2});
  polygons.push_back({middle, a + n + 2, a + n + 1});
  polygons.push_back({a, a + 1, middle});
  positions.push_back(Vector3(9, 9, 9));  // no face has it
  return soup_of_polygons(std::move(positions), polygons);
}

TEST(FileOrder, DirtyFilesGiveTheSameMesh) {
  const PolygonSoup soup = dirty_soup();
  const BuiltMesh usual = build_mesh(soup);
  EXPECT_GE(usual.defects.size(), 4u);
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    const Shuffled other = shuffled(soup, seed);
    const BuiltMesh built = build_mesh(other.soup);
    EXPECT_EQ(built.mesh.faces(), usual.mesh.faces());
    EXPECT_EQ(built.mesh.positions(), usual.mesh.positions());
    for (int v = 0; v < built.mesh.vertex_count(); ++v) EXPECT_EQ(built.input_vertex[v], other.place[usual.input_vertex[v]]);
    ASSERT_EQ(built.defects.size(), usual.defects.size());
    for (std::size_t i = 0; i < usual.defects.size(); ++i) {
      EXPECT_EQ(built.defects[i].code, usual.defects[i].code);
      EXPECT_EQ(built.defects[i].elements.size(), usual.defects[i].elements.size());
      if (usual.defects[i].element_kind != "vertex") continue;
      std::vector<int> expected = usual.defects[i].elements;
      for (int& v : expected) v = other.place[v];
      std::sort(expected.begin(), expected.end());
      EXPECT_EQ(built.defects[i].elements, expected) << usual.defects[i].code;
    }
  }
}

/// Two parts, each of which is its own mirror image but for where its vertices' numbers are: longest edges come in pairs.
PolygonSoup mirrored_parts() {
  const auto part = [](double size, const Vector3& at, std::vector<Vector3>& positions, std::vector<std::vector<int>>& polygons) {
    const int first = static_cast<int>(positions.size()), n = 8;
    for (int j = 0; j <= n; ++j)
      for (int i = -n; i <= n; ++i) {
        const double x = i / 8.0, y = j / 8.0;
        positions.push_back(at + size * Vector3(x + 0.1 * x * x * x, y + 0.07 * x * x + 0.05 * y * y, 0.3 * std::sin(3 * y) * x * x));
      }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < 2 * n; ++i) {
        const int a = first + j * (2 * n + 1) + i, b = a + 2 * n + 1;
        const bool is_left = i < n;
        polygons.push_back(is_left ? std::vector<int>{a, a + 1, b} : std::vector<int>{a, a + 1, b + 1});
        polygons.push_back(is_left ? std::vector<int>{a + 1, b + 1, b} : std::vector<int>{a, b + 1, b});
      }
  };
  std::vector<Vector3> positions;
  std::vector<std::vector<int>> polygons;
  part(1, Vector3::Zero(), positions, polygons);
  part(1, Vector3(0.4, 0.9, 2), positions, polygons);
  return soup_of_polygons(std::move(positions), polygons);
}

TEST(FileOrder, MotionsOfAMirrorImageGiveTheSameMesh) {
  const PolygonSoup soup = mirrored_parts();
  const BuiltMesh usual = build_mesh(soup);
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
    const Vector3 shift(3.1, -0.7 * seed, 0.2);
    const Eigen::Matrix3d turn = random_rotation(seed);
    const BuiltMesh built = build_mesh(shuffled(moved(soup, turn, shift), seed).soup);
    ASSERT_EQ(built.mesh.faces(), usual.mesh.faces());
    for (int v = 0; v < built.mesh.vertex_count(); ++v)
      EXPECT_LT((built.mesh.position(v) - turn * usual.mesh.position(v) - shift).norm(), 1e-12);
  }
}

TEST(FileOrder, ParallelogramsAreCutAlikeHoweverTheyLie) {
  std::vector<Vector3> positions;
  std::vector<std::vector<int>> polygons;
  const int n = 6;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) positions.push_back(Vector3(i + 0.3 * j, 1.7 * j, 0));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i + (j == 3) < n; ++i) {  // a notch, so that no motion maps it to itself
      const int a = j * (n + 1) + i;
      polygons.push_back({a, a + 1, a + n + 2, a + n + 1});
    }
  const PolygonSoup soup = soup_of_polygons(positions, polygons);
  const BuiltMesh usual = build_mesh(soup);
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    const BuiltMesh built = build_mesh(shuffled(moved(soup, random_rotation(seed), Vector3(1, 2, 3)), seed).soup);
    EXPECT_EQ(built.mesh.faces(), usual.mesh.faces());
  }
}

TEST(FileOrder, APointOnAnEdgeIsOfTheSameFaceHoweverItRounds) {
  const TriangleMesh mesh = test::wedge(4, 90);
  const SurfaceIndex index(mesh, {});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0.1, 0.9), noise(-1e-15, 1e-15);
  for (int h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_boundary(h)) continue;
    const Vector3 on_edge = mesh.position(mesh.from(h)) + part(random) * mesh.edge_vector(h);
    const int expected = std::min(h, mesh.opposite(h)) / 3;
    for (const Vector3& p : {on_edge, mesh.position(mesh.from(h))}) {
      const int first = index.walk(p, h / 3).face;
      if (p == on_edge) {
        EXPECT_EQ(first, expected);
      }
      for (int i = 0; i < 6; ++i) {
        const Vector3 rounded = p + Vector3(noise(random), noise(random), noise(random));
        EXPECT_EQ(index.walk(rounded, h / 3).face, first);
        EXPECT_EQ(index.walk(rounded, mesh.opposite(h) / 3).face, first);
      }
    }
  }
}

}  // namespace
}  // namespace hybrid_quad
