#include "support/meshes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace hybrid_quad::test {

namespace {

constexpr double kPi = 3.14159265358979323846;

void add_quad(std::vector<std::array<int, 3>>& faces, int a, int b, int c, int d) {
  faces.push_back({a, b, c});
  faces.push_back({a, c, d});
}

}  // namespace

TriangleMesh flat_grid(int n, int m, double width, double height) {
  std::vector<Vector3> p;
  std::vector<std::array<int, 3>> f;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) p.emplace_back(width * i / n, height * j / m, 0.0);
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      add_quad(f, a, a + 1, a + n + 2, a + n + 1);
    }
  return TriangleMesh(std::move(p), std::move(f));
}

QuadMesh even_quads(int n, int region) {
  QuadMesh quads;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      quads.positions.emplace_back(i, j, 0);
      quads.kind.push_back(VertexKind::kFree);
      quads.anchor.push_back(region);
      quads.near_face.push_back(-1);
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i;
      quads.quads.push_back({a, a + 1, a + n + 2, a + n + 1});
    }
  return quads;
}

TriangleMesh box(int n, const Vector3& size) {
  std::vector<Vector3> p;
  std::vector<std::array<int, 3>> f;
  std::map<std::array<int, 3>, int> id;
  const auto vertex = [&](const std::array<int, 3>& g) {
    const auto [it, is_new] = id.emplace(g, static_cast<int>(p.size()));
    if (is_new) p.emplace_back(size[0] * g[0] / n, size[1] * g[1] / n, size[2] * g[2] / n);
    return it->second;
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> g;
            g[axis] = side * n;
            g[(axis + 1) % 3] = u;
            g[(axis + 2) % 3] = v;
            return vertex(g);
          };
          if (side) add_quad(f, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
          else add_quad(f, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
        }
  return TriangleMesh(std::move(p), std::move(f));
}

TriangleMesh icosphere(int levels, double radius) {
  const double t = 0.5 * (1 + std::sqrt(5.0));
  std::vector<Vector3> p{{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0}, {0, -1, t}, {0, 1, t},
                         {0, -1, -t}, {0, 1, -t}, {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}};
  std::vector<std::array<int, 3>> f{{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8}, {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8},
                                    {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middle;
    const auto split = [&](int a, int b) {
      const auto [it, is_new] = middle.emplace(std::minmax(a, b), static_cast<int>(p.size()));
      if (is_new) p.push_back(0.5 * (p[a] + p[b]));
      return it->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& g : f) {
      const int a = split(g[0], g[1]), b = split(g[1], g[2]), c = split(g[2], g[0]);
      finer.insert(finer.end(), {{g[0], a, c}, {g[1], b, a}, {g[2], c, b}, {a, b, c}});
    }
    f = std::move(finer);
  }
  for (Vector3& q : p) q *= radius / q.norm();
  return TriangleMesh(std::move(p), std::move(f));
}

TriangleMesh torus(int n, int m, double major, double minor) {
  std::vector<Vector3> p;
  std::vector<std::array<int, 3>> f;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const double a = 2 * kPi * i / n, b = 2 * kPi * j / m, r = major + minor * std::cos(b);
      p.emplace_back(r * std::cos(a), r * std::sin(a), minor * std::sin(b));
    }
  const auto at = [&](int i, int j) { return (i % n) * m + j % m; };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) add_quad(f, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  return TriangleMesh(std::move(p), std::move(f));
}

namespace {

void cylinder_side(int n, int m, double radius, double height, std::vector<Vector3>& p,
                   std::vector<std::array<int, 3>>& f) {
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i < n; ++i) {
      const double a = 2 * kPi * i / n;
      p.emplace_back(radius * std::cos(a), radius * std::sin(a), height * j / m);
    }
  const auto at = [&](int i, int j) { return j * n + i % n; };
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) add_quad(f, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
}

}  // namespace

TriangleMesh open_cylinder(int n, int m, double radius, double height) {
  std::vector<Vector3> p;
  std::vector<std::array<int, 3>> f;
  cylinder_side(n, m, radius, height, p, f);
  return TriangleMesh(std::move(p), std::move(f));
}

TriangleMesh capped_cylinder(int n, int m, double radius, double height) {
  std::vector<Vector3> p;
  std::vector<std::array<int, 3>> f;
  cylinder_side(n, m, radius, height, p, f);
  for (int i = 2; i < n; ++i) {
    f.push_back({0, i, i - 1});
    f.push_back({m * n, m * n + i - 1, m * n + i});
  }
  return TriangleMesh(std::move(p), std::move(f));
}

TriangleMesh wedge(int n, double dihedral_degrees) {
  const TriangleMesh flat = flat_grid(2 * n, n, 2, 1);
  std::vector<Vector3> p = flat.positions();
  const double turn = kPi * (1 - dihedral_degrees / 180);
  for (Vector3& q : p) {
    q.x() -= 1;
    if (q.x() > 0) q = Vector3(q.x() * std::cos(turn), q.y(), -q.x() * std::sin(turn));
  }
  return TriangleMesh(std::move(p), flat.faces());
}

PolygonSoup soup_of(const TriangleMesh& mesh) {
  PolygonSoup soup;
  soup.positions = mesh.positions();
  for (const auto& f : mesh.faces()) {
    soup.face_sizes.push_back(3);
    soup.face_vertices.insert(soup.face_vertices.end(), f.begin(), f.end());
  }
  return soup;
}

PolygonSoup read_obj(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path);
  PolygonSoup soup;
  std::string line;
  while (std::getline(file, line)) {
    const char* s = line.c_str();
    char* end = nullptr;
    if (s[0] == 'v' && (s[1] == ' ' || s[1] == '\t')) {
      Vector3 p = Vector3::Zero();
      ++s;
      for (int i = 0; i < 3; ++i, s = end) p[i] = std::strtod(s, &end);
      soup.positions.push_back(p);
    } else if (s[0] == 'f' && (s[1] == ' ' || s[1] == '\t')) {
      int size = 0;
      for (++s;; ++size) {
        const long id = std::strtol(s, &end, 10);
        if (end == s) break;
        soup.face_vertices.push_back(static_cast<int>(id < 0 ? id + static_cast<long>(soup.positions.size()) : id - 1));
        for (s = end; *s && *s != ' ' && *s != '\t';) ++s;
      }
      soup.face_sizes.push_back(size);
    }
  }
  return soup;
}

std::string models_folder() {
  namespace fs = std::filesystem;
  std::error_code error;
  if (const char* folder = std::getenv("HQ_MODELS")) return fs::is_directory(folder, error) ? folder : "";
  fs::path root = fs::path(__FILE__).parent_path();
  for (int i = 0; i < 3; ++i) root = root.parent_path();
  const fs::path beside = root.parent_path() / "shared" / "meshes" / "dev";
  return fs::is_directory(beside, error) ? beside.string() : "";
}

std::vector<std::string> model_files() {
  std::vector<std::string> files;
  const std::string folder = models_folder();
  if (folder.empty()) return files;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".obj") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace hybrid_quad::test
