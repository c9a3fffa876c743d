#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/connectivity.h"
#include "core/mesh.h"
#include "models/sketch/surface/cut_surface.h"
#include "tests/core/geometry/shapes.h"

namespace geoprior::sketch::flats {

/// Grid of `columns` x `rows` cells whose vertex (i, j), number j (columns + 1) + i, is at
/// `at(i, j)`; in the plane it faces +z.
inline TriMesh grid(int columns, int rows, const std::function<Eigen::Vector3d(int, int)>& at) {
  TriMesh mesh;
  mesh.V.resize((columns + 1) * (rows + 1), 3);
  mesh.F.resize(2 * columns * rows, 3);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) mesh.V.row(j * (columns + 1) + i) = at(i, j).transpose();
  }
  Eigen::Index t = 0;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + 1, d = a + columns + 1, c = d + 1;
      mesh.F.row(t++) << a, b, c;
      mesh.F.row(t++) << a, c, d;
    }
  }
  return mesh;
}

/// Frustum of a pyramid over a regular polygon, about y, from radius r0 at y = 0 to r1 at y = h;
/// `segments` facets all around, closed in itself. Outside is out. Vertex (i, j) of ring j is
/// j * segments + i.
inline TriMesh tube(double r0, double r1, double h, int segments, int rows) {
  TriMesh mesh;
  mesh.V.resize(segments * (rows + 1), 3);
  mesh.F.resize(2 * segments * rows, 3);
  for (int j = 0; j <= rows; ++j) {
    const double s = static_cast<double>(j) / rows, r = r0 + s * (r1 - r0);
    for (int i = 0; i < segments; ++i) {
      const double angle = 2 * std::numbers::pi * i / segments;
      mesh.V.row(j * segments + i) << r * std::cos(angle), s * h, -r * std::sin(angle);
    }
  }
  Eigen::Index t = 0;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < segments; ++i) {
      const int a = j * segments + i, b = j * segments + (i + 1) % segments;
      mesh.F.row(t++) << a, b, b + segments;
      mesh.F.row(t++) << a, b + segments, a + segments;
    }
  }
  return mesh;
}

/// The edges of a path of vertices, as one seam.
inline std::vector<SeamEdge> seam_along(const std::vector<int>& path, int seam) {
  std::vector<SeamEdge> edges;
  for (std::size_t i = 1; i < path.size(); ++i) edges.push_back({{path[i - 1], path[i]}, seam});
  return edges;
}

/// Edges of a mesh of the sphere whose two ends have the coordinate 0 on an axis.
inline std::vector<SeamEdge> great_circle(const TriMesh& mesh, int axis, int seam) {
  std::vector<SeamEdge> edges;
  const EdgeConnectivity connectivity(mesh.F);
  for (const Edge& edge : connectivity.edges()) {
    if (std::abs(mesh.V(edge[0], axis)) < 1e-12 && std::abs(mesh.V(edge[1], axis)) < 1e-12)
      edges.push_back({edge, seam});
  }
  return edges;
}

/// The seam up the tube at its first column.
inline std::vector<SeamEdge> tube_seam(int segments, int rows) {
  std::vector<int> path;
  for (int j = 0; j <= rows; ++j) path.push_back(j * segments);
  return seam_along(path, 0);
}

/// The triangles whose centres are kept, without loose vertices.
inline TriMesh part(const TriMesh& mesh, const std::function<bool(const Eigen::Vector3d&)>& keep) {
  TriMesh result;
  std::vector<int> number(mesh.vertex_count(), -1), vertices;
  std::vector<Eigen::Vector3i> triangles;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::Vector3d centre =
        (mesh.V.row(mesh.F(t, 0)) + mesh.V.row(mesh.F(t, 1)) + mesh.V.row(mesh.F(t, 2)))
            .transpose() /
        3;
    if (!keep(centre)) continue;
    Eigen::Vector3i& triangle = triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      int& n = number[mesh.F(t, k)];
      if (n < 0) {
        n = static_cast<int>(vertices.size());
        vertices.push_back(mesh.F(t, k));
      }
      triangle(k) = n;
    }
  }
  result.V = mesh.V(vertices, Eigen::all);
  result.F.resize(triangles.size(), 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) result.F.row(t) = triangles[t].transpose();
  return result;
}

/// Half of the unit sphere of `geoprior::shapes::sphere`, z >= 0.
inline TriMesh hemisphere(int levels) {
  return part(geoprior::shapes::sphere(levels), [](const Eigen::Vector3d& c) { return c.z() > 0; });
}

/// Largest relative change of the length of an edge from space to the plane.
inline double worst_edge(const TriMesh& mesh, const Eigen::MatrixX2d& points) {
  double worst = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.F(t, k), b = mesh.F(t, (k + 1) % 3);
      const double length = (mesh.V.row(a) - mesh.V.row(b)).norm();
      worst = std::max(worst, std::abs((points.row(a) - points.row(b)).norm() / length - 1));
    }
  }
  return worst;
}

}  // namespace geoprior::sketch::flats
