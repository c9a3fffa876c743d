#pragma once

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "core/geometry/topology.h"
#include "core/mesh.h"
#include "models/details/surface_walk.h"

namespace geoprior::details::drawing_checks {

inline std::vector<Eigen::Vector3d> points_of(const TriMesh& mesh) {
  std::vector<Eigen::Vector3d> x(mesh.V.rows());
  for (std::size_t v = 0; v < x.size(); ++v) x[v] = mesh.V.row(v);
  return x;
}

/// No edge with three triangles or two of one direction, and one fan of triangles at every vertex.
inline bool manifold(const TriMesh& mesh) {
  if (!non_manifold_edges(mesh.F).empty()) return false;
  const SurfaceTopology topology(mesh);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const auto faces = topology.corners.count(v);
    if (faces == 0 || topology.fan_of(v) != faces) return false;
  }
  return true;
}

inline int euler(const TriMesh& mesh) { return SurfaceTopology(mesh).euler; }

/// Number of border loops: every border vertex of a manifold has one edge that leaves it.
inline int border_loops(const TriMesh& mesh) {
  std::vector<int> next(mesh.V.rows(), -1);
  for (const Edge& e : boundary_edges(mesh.F)) next[e[0]] = e[1];
  int loops = 0;
  for (std::size_t v = 0; v < next.size(); ++v) {
    if (next[v] < 0) continue;
    ++loops;
    for (auto w = v; next[w] >= 0;) w = std::exchange(next[w], -1);
  }
  return loops;
}

}  // namespace geoprior::details::drawing_checks
