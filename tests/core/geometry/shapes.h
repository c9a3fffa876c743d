#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry/subdivision.h"
#include "core/inputs/rig.h"
#include "core/mesh.h"

namespace geoprior::shapes {

inline TriMesh tetrahedron() {
  TriMesh mesh;
  mesh.V.resize(4, 3);
  mesh.V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.F.resize(4, 3);
  mesh.F << 0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2;
  return mesh;
}

/// Regular octahedron with vertices on the unit sphere.
inline TriMesh octahedron() {
  TriMesh mesh;
  mesh.V.resize(6, 3);
  mesh.V << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  mesh.F.resize(8, 3);
  mesh.F << 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5;
  return mesh;
}

/// Unit square of n x n cells in the plane z = 0, facing +z.
inline TriMesh square(int n) {
  TriMesh mesh;
  mesh.V.resize((n + 1) * (n + 1), 3);
  mesh.F.resize(2 * n * n, 3);
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i)
      mesh.V.row(j * (n + 1) + i) << static_cast<double>(i) / n, static_cast<double>(j) / n, 0;
  }
  Eigen::Index t = 0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      mesh.F.row(t++) << a, b, c;
      mesh.F.row(t++) << a, c, d;
    }
  }
  return mesh;
}

/// Sphere of radius 1: the octahedron subdivided, vertices pushed onto the sphere.
inline TriMesh sphere(int levels) {
  TriMesh mesh = octahedron();
  for (int level = 0; level < levels; ++level) {
    const Subdivision step = loop_subdivision(mesh.F, mesh.vertex_count());
    mesh.V = (step.stencil * mesh.V).rowwise().normalized();
    mesh.F = step.F;
  }
  return mesh;
}

inline RiggedMesh bare_rig(const TriMesh& mesh) {
  RiggedMesh rig;
  rig.mesh = mesh;
  rig.skeleton.joints.resize(1);
  rig.skeleton.joints[0].name = "root";
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < mesh.vertex_count(); ++v) entries.emplace_back(v, 0, 1.0);
  rig.weights.resize(mesh.vertex_count(), 1);
  rig.weights.setFromTriplets(entries.begin(), entries.end());
  return rig;
}

/// V - E + F of a mesh whose edges each have two triangles (closed).
inline int euler_characteristic(const TriMesh& mesh) {
  return mesh.vertex_count() - mesh.triangle_count() * 3 / 2 + mesh.triangle_count();
}

/// Smallest angle of any triangle, in degrees.
inline double smallest_angle(const TriMesh& mesh) {
  double smallest = 180;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d a = mesh.V.row(mesh.F(t, (k + 1) % 3)) - mesh.V.row(mesh.F(t, k));
      const Eigen::Vector3d b = mesh.V.row(mesh.F(t, (k + 2) % 3)) - mesh.V.row(mesh.F(t, k));
      smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)) * 57.29577951308232);
    }
  }
  return smallest;
}

}  // namespace geoprior::shapes
