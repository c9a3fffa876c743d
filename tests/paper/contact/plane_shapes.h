#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/geometry/planar.h"
#include "models/paper/sheet/pattern.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper::plane_shapes {

/// An L of two squares of 0.1 m and one between: a pattern with an inward corner.
inline Pattern ell_pattern() {
  return {{{0, 0}, {0.2, 0}, {0.2, 0.1}, {0.1, 0.1}, {0.1, 0.2}, {0, 0.2}}};
}

/// A square of 4 with holes: a square of 1 about (1, 1) and a triangle about (-1, -1).
inline Pattern pierced_square() {
  return {
      {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}},
      {{{0.5, 0.5}, {0.5, 1.5}, {1.5, 1.5}, {1.5, 0.5}}, {{-1.5, -1.5}, {-1, -0.5}, {-0.5, -1.5}}}};
}

/// A disc of 0.1 m with a round hole of 0.03 m off its centre.
inline Pattern ring_pattern() {
  Pattern ring = disc_pattern(0.1, 40);
  std::vector<Eigen::Vector2d> hole = disc_pattern(0.03, 20).border;
  for (Eigen::Vector2d& p : hole) p += Eigen::Vector2d(0.02, 0.01);
  ring.holes = {{hole.rbegin(), hole.rend()}};
  return ring;
}

inline double twice_area(const ShellMesh& mesh, int f) {
  const Eigen::Vector2d a = mesh.pattern.row(mesh.triangles(f, 0)),
                        b = mesh.pattern.row(mesh.triangles(f, 1)),
                        c = mesh.pattern.row(mesh.triangles(f, 2));
  return cross(b - a, c - a);
}

inline double total_area(const ShellMesh& mesh) {
  double twice = 0;
  for (int f = 0; f < mesh.triangle_count(); ++f) twice += twice_area(mesh, f);
  return twice / 2;
}

inline double least_area(const ShellMesh& mesh) {
  double least = twice_area(mesh, 0) / 2;
  for (int f = 1; f < mesh.triangle_count(); ++f) least = std::min(least, twice_area(mesh, f) / 2);
  return least;
}

/// Directed edges, each with how many triangles have it: all 1 on an oriented manifold.
inline std::map<std::pair<int, int>, int> directed_edges(const ShellMesh& mesh) {
  std::map<std::pair<int, int>, int> count;
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    for (int k = 0; k < 3; ++k) ++count[{mesh.triangles(f, k), mesh.triangles(f, (k + 1) % 3)}];
  }
  return count;
}

inline std::vector<std::pair<int, int>> border_edges(const ShellMesh& mesh) {
  const auto directed = directed_edges(mesh);
  std::vector<std::pair<int, int>> border;
  for (const auto& [edge, count] : directed) {
    if (!directed.contains({edge.second, edge.first})) border.push_back(edge);
  }
  return border;
}

/// Vertices - edges + triangles: 1 for a disc. Vertices without a triangle count, so that a lost
/// one shows.
inline int euler_characteristic(const ShellMesh& mesh) {
  std::set<std::pair<int, int>> edges;
  for (const auto& [edge, count] : directed_edges(mesh)) {
    edges.insert(std::minmax(edge.first, edge.second));
  }
  return mesh.vertex_count() - static_cast<int>(edges.size()) + mesh.triangle_count();
}

/// Distance of the nearest vertex (m).
inline double distance_to_vertices(const ShellMesh& mesh, const Eigen::Vector2d& p) {
  return (mesh.pattern.rowwise() - p.transpose()).rowwise().norm().minCoeff();
}

/// Exactly once: areas, orientation, topology, borders and corners are those of the pattern.
inline void expect_covers(const ShellMesh& mesh, const Pattern& pattern) {
  const double area = signed_area(pattern);
  EXPECT_NEAR(total_area(mesh), area, 1e-12 * area);
  EXPECT_GT(least_area(mesh), 0);
  EXPECT_EQ(euler_characteristic(mesh), 1 - static_cast<int>(pattern.holes.size()));
  for (const auto& [edge, count] : directed_edges(mesh)) EXPECT_EQ(count, 1);
  for (const auto& [a, b] : border_edges(mesh)) {
    EXPECT_LT(nearest_on_border(pattern, mesh.pattern.row(a)).distance, 1e-15);
  }
  for (const Eigen::Vector2d& corner : corners(pattern)) {
    EXPECT_EQ(distance_to_vertices(mesh, corner), 0);
  }
}

}  // namespace geoprior::paper::plane_shapes
