#include "patches.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "meshes.h"

namespace hybrid_quad::test {

namespace {

int pick(std::mt19937& random, int count) {
  return static_cast<int>(random() % static_cast<unsigned>(count));
}
double uniform(std::mt19937& random, double a, double b) { return a + (b - a) * (random() / 4294967296.0); }

TriangleMesh without_unused(const std::vector<Vector3>& positions,
                            const std::vector<std::array<int, 3>>& faces) {
  std::vector<int> number(positions.size(), -1);
  std::vector<Vector3> kept;
  std::vector<std::array<int, 3>> renamed;
  for (std::array<int, 3> t : faces) {
    for (int& v : t) {
      if (number[v] < 0) {
        number[v] = static_cast<int>(kept.size());
        kept.push_back(positions[v]);
      }
      v = number[v];
    }
    renamed.push_back(t);
  }
  return TriangleMesh(kept, renamed);
}

}  // namespace

TriangleMesh punctured(const TriangleMesh& mesh, int holes, std::mt19937& random) {
  std::vector<char> taken(mesh.vertex_count(), 0), gone(mesh.vertex_count(), 0);
  for (int k = 0; k < holes; ++k) {
    const int v = pick(random, mesh.vertex_count());
    bool free = mesh.outgoing(v) >= 0 && !mesh.is_boundary_vertex(v) && !taken[v];
    std::vector<int> ring;
    for (int h = mesh.outgoing(v); free;) {
      ring.push_back(mesh.to(h));
      free = !taken[ring.back()] && !mesh.is_boundary_vertex(ring.back());
      h = mesh.rotate_ccw(h);
      if (h == mesh.outgoing(v)) break;
    }
    if (!free || ring.size() < 4) continue;
    gone[v] = 1;
    for (const int w : ring) taken[w] = 1;
  }
  std::vector<std::array<int, 3>> faces;
  for (const auto& t : mesh.faces())
    if (!gone[t[0]] && !gone[t[1]] && !gone[t[2]]) faces.push_back(t);
  return without_unused(mesh.positions(), faces);
}

TriangleMesh shuffled(const TriangleMesh& mesh, int flips, std::mt19937& random) {
  TriangleMesh current = mesh;
  std::vector<std::array<int, 3>> faces = mesh.faces();
  std::map<std::pair<int, int>, int> face_of;  // directed edge to face
  std::vector<int> valence(mesh.vertex_count(), 0);
  const auto add = [&](int f) {
    for (int i = 0; i < 3; ++i) face_of[{faces[f][i], faces[f][(i + 1) % 3]}] = f;
  };
  for (int f = 0; f < mesh.face_count(); ++f) {
    add(f);
    for (const int v : faces[f]) ++valence[v];
  }
  for (int k = 0; k < flips; ++k) {
    const int f = pick(random, static_cast<int>(faces.size())), i = pick(random, 3);
    const int a = faces[f][i], b = faces[f][(i + 1) % 3], c = faces[f][(i + 2) % 3];
    const auto other = face_of.find({b, a});
    if (other == face_of.end()) continue;
    const int g = other->second;
    const int d = faces[g][0] + faces[g][1] + faces[g][2] - a - b;
    if (c == d || face_of.count({c, d}) || face_of.count({d, c}) || valence[a] < 4 || valence[b] < 4)
      continue;
    face_of.erase({a, b});
    face_of.erase({b, a});
    faces[f] = {c, a, d};
    faces[g] = {d, b, c};
    add(f);
    add(g);
    --valence[a];
    --valence[b];
    ++valence[c];
    ++valence[d];
  }
  return TriangleMesh(mesh.positions(), faces);
}

TriangleMesh double_torus(int n) {
  const auto filled = [](int x, int y, int z) {
    return x >= 0 && x < 5 && y >= 0 && y < 3 && z == 0 && !(y == 1 && (x == 1 || x == 3));
  };
  std::map<std::array<int, 3>, int> id;
  std::vector<Vector3> positions;
  std::vector<std::array<int, 3>> faces;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [at, added] = id.insert({p, static_cast<int>(positions.size())});
    if (added) positions.push_back(Vector3(p[0], p[1], p[2]) / n);
    return at->second;
  };
  for (int x = 0; x < 5; ++x)
    for (int y = 0; y < 3; ++y)
      for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
          std::array<int, 3> cell{x, y, 0}, beside = cell;
          beside[axis] += side ? 1 : -1;
          if (!filled(x, y, 0) || filled(beside[0], beside[1], beside[2])) continue;
          const int a = (axis + 1) % 3, b = (axis + 2) % 3;
          for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
              const auto corner = [&](int di, int dj) {
                std::array<int, 3> p{n * cell[0], n * cell[1], n * cell[2]};
                p[axis] += side * n;
                p[a] += i + di;
                p[b] += j + dj;
                return vertex(p);
              };
              const int q[4] = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
              if (side) {
                faces.push_back({q[0], q[1], q[2]});
                faces.push_back({q[0], q[2], q[3]});
              } else {
                faces.push_back({q[0], q[2], q[1]});
                faces.push_back({q[0], q[3], q[2]});
              }
            }
        }
  return TriangleMesh(positions, faces);
}

PatchSurface random_patch(const TriangleMesh& mesh, Values values, std::mt19937& random) {
  PatchSurface patch;
  patch.mesh = mesh;
  patch.node.assign(mesh.vertex_count(), -1);
  patch.boundary_arc.assign(mesh.halfedge_count(), -1);
  patch.target_length = 4 * mesh.mean_edge_length();
  const double fx = uniform(random, 3, 20), fy = uniform(random, 3, 20), fz = uniform(random, 3, 20);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vector3& p = mesh.position(v);
    double value = 0;
    switch (values) {
      case Values::kRandom:
        value = uniform(random, -1, 1);
        break;
      case Values::kConstant:
        value = 0.25;
        break;
      case Values::kWave:
        value = std::cos(fx * p.x()) * std::cos(fy * p.y()) * std::cos(fz * p.z());
        break;
      case Values::kFew:
        value = 0.5 * (pick(random, 3) - 1);
        break;
      case Values::kWild:
        value = uniform(random, -3, 3);
        break;
    }
    patch.morse.push_back(value);
  }
  std::vector<char> seen(mesh.halfedge_count(), 0);
  int nodes = 0, arcs = 0;
  for (int seed = 0; seed < mesh.halfedge_count(); ++seed) {
    if (!mesh.is_boundary(seed) || seen[seed]) continue;
    std::vector<int> loop;
    for (int h = seed; !seen[h]; h = mesh.outgoing(mesh.to(h))) {
      seen[h] = 1;
      loop.push_back(h);
    }
    const int length = static_cast<int>(loop.size());
    const int count = 4 + 2 * pick(random, (length - 4) / 2 + 1);
    std::set<int> at;
    while (static_cast<int>(at.size()) < count) at.insert(pick(random, length));
    const std::vector<int> ends(at.begin(), at.end());
    for (int k = 0; k < count; ++k, ++arcs) {
      const int first = ends[k], steps = (ends[(k + 1) % count] - first + length) % length;
      const double begin = k % 2 ? 1.01 : -1.01;
      patch.node[mesh.from(loop[first])] = 100 + nodes++;
      for (int s = 0; s < steps; ++s) {
        const int h = loop[(first + s) % length];
        patch.boundary_arc[h] = arcs;
        patch.morse[mesh.from(h)] = begin * (1 - 2.0 * s / steps);
      }
    }
  }
  return patch;
}

TriangleMesh random_surface(int family, std::mt19937& random) {
  const int n = 4 + pick(random, 12), m = 4 + pick(random, 12);
  TriangleMesh mesh;
  switch (family) {
    case 0:
      mesh = flat_grid(n, m);
      break;
    case 1:
      mesh = flat_grid(1 + pick(random, 2), 1 + pick(random, 3));
      break;
    case 2:
      mesh = icosphere(2 + pick(random, 2));
      break;
    case 3:
      mesh = torus(n, m);
      break;
    case 4:
      mesh = open_cylinder(n, m);
      break;
    case 5:
      mesh = double_torus(1 + pick(random, 4));
      break;
    case 6:
      mesh = punctured(flat_grid(n, m), 6, random);
      break;
    case 7:
      mesh = punctured(icosphere(2 + pick(random, 2)), 4, random);
      break;
    case 8:
      mesh = punctured(torus(n, m), 5, random);
      break;
    default:
      mesh = punctured(double_torus(2 + pick(random, 3)), 6, random);
      break;
  }
  return pick(random, 2) ? shuffled(mesh, 2 * mesh.face_count(), random) : mesh;
}

}  // namespace hybrid_quad::test
