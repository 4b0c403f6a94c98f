#pragma once

#include <string>
#include <vector>

#include "hybrid_quad/mesh/mesh_builder.h"
#include "hybrid_quad/mesh/quad_mesh.h"
#include "hybrid_quad/mesh/triangle_mesh.h"

namespace hybrid_quad::test {

/// The rectangle [0, width] x [0, height] in n x m cells of two triangles, normal +z.
TriangleMesh flat_grid(int n, int m, double width = 1, double height = 1);
/// The square [0, n] x [0, n] in unit quads, row by row; all vertices free, in a region.
QuadMesh even_quads(int n, int region);
/// The box [0, size] with n x n cells on every side, normals outwards.
TriangleMesh box(int n, const Vector3& size = Vector3(1, 1, 1));
/// Icosahedron subdivided `levels` times, vertices on the sphere about the origin.
TriangleMesh icosphere(int levels, double radius = 1);
/// Torus about the z axis, n cells around the axis and m around the tube.
TriangleMesh torus(int n, int m, double major = 1, double minor = 0.4);
/// Cylinder about the z axis without caps, n cells around and m along.
TriangleMesh open_cylinder(int n, int m, double radius = 1, double height = 2);
/// Two flat squares of n x n cells that meet along the y axis at the given dihedral (180 = flat).
TriangleMesh wedge(int n, double dihedral_degrees);
/// Cylinder with flat caps: each cap a fan from one vertex (needles for large n).
TriangleMesh capped_cylinder(int n, int m, double radius = 1, double height = 2);

/// The same surface with the faces as loose polygons.
PolygonSoup soup_of(const TriangleMesh& mesh);

/// Positions and polygons of a Wavefront OBJ file; negative indices and "a/b/c" corners are understood.
/// \throws std::runtime_error if the file cannot be read
PolygonSoup read_obj(const std::string& path);

/// The folder of test models, from HQ_MODELS or found next to the repository; "" where there is none.
std::string models_folder();
/// The models of that folder, sorted by name; empty where there is none.
std::vector<std::string> model_files();

}  // namespace hybrid_quad::test
