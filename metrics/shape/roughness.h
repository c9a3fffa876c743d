#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/connectivity.h"
#include "core/geometry/topology.h"
#include "core/mesh.h"

namespace geoprior {

/// Facets, creases and lumps that a deformation puts into a surface, against its shape at rest.
///
/// Two local measures, both invariant under rigid motion, and both small where a finely meshed
/// surface bends smoothly (edges of length h, change of curvature k):
///  - fold: change of the signed dihedral angle of an edge. Smooth bending: h k. A crease of angle
///  g
///    gives g at any resolution. A change is not taken modulo a turn: from a ridge folded flat to a
///    valley folded flat it is a whole one.
///  - lump: d_v = n_v . (mean of the neighbours of v - v), the normal component of the umbrella
///    vector, is about h^2 times the mean curvature; its change from rest is c_v, and the lump is
///    c_v - mean of c over the neighbours of v: what one ring of vertices does unlike the next.
///    Smooth bending: h^4, on irregular meshes h^2 k times the spread of h. One vertex of six
///    neighbours pulled out by b: 7/6 b. A crease of angle g along a regular mesh:
///    2 h sin(g/2) / sqrt(27).
/// So both compare surfaces on one mesh; between meshes only creases compare, by their folds. A
/// bump wider than a few edges is no lump: it shows in sections and distances.
class Roughness {
 public:
  /// @param rest  manifold; edges and vertices at a border, and edges beside a triangle that has no
  ///              area at rest, have neither measure
  explicit Roughness(const TriMesh& rest);

  /// |change of the dihedral angle| of every edge (rad); NaN where there is none. Pi where a
  /// triangle beside the edge has lost its area, and with it its normal.
  /// @throws Error  unless there are as many vertices as at rest
  [[nodiscard]] Eigen::VectorXd folds(const Eigen::MatrixX3d& posed) const;

  /// |lump| of every vertex (m); NaN where there is none.
  /// @throws Error  unless there are as many vertices as at rest
  [[nodiscard]] Eigen::VectorXd lumps(const Eigen::MatrixX3d& posed) const;

  [[nodiscard]] const EdgeConnectivity& edges() const { return edges_; }
  [[nodiscard]] int vertex_count() const { return static_cast<int>(vertex_area_.size()); }
  /// A third of the rest area of the triangles at an edge or vertex (m^2).
  [[nodiscard]] const Eigen::VectorXd& edge_area() const { return edge_area_; }
  [[nodiscard]] const Eigen::VectorXd& vertex_area() const { return vertex_area_; }

 private:
  [[nodiscard]] Eigen::VectorXd dihedral_angles(const Eigen::MatrixX3d& V) const;
  [[nodiscard]] Eigen::VectorXd umbrella_heights(const Eigen::MatrixX3d& V) const;
  void require_vertices(const Eigen::MatrixX3d& posed) const;

  Eigen::MatrixX3i F_;
  EdgeConnectivity edges_;
  VertexGraph rings_;
  std::vector<bool> at_border_;
  Eigen::VectorXd rest_angles_;
  Eigen::VectorXd rest_heights_;
  Eigen::VectorXd edge_area_;
  Eigen::VectorXd vertex_area_;
};

/// Folds (rad) and lumps (m) over a part of a surface; percentiles and means by rest area.
struct RoughnessSummary {
  double fold_p50 = 0, fold_p95 = 0, fold_p99 = 0, fold_max = 0;
  double lump_rms = 0, lump_p95 = 0, lump_max = 0;
};

/// Over the given vertices and the edges between them; empty: all. Absent where none of them has a
/// fold and a lump.
std::optional<RoughnessSummary> summarize(const Roughness& surface, const Eigen::VectorXd& folds,
                                          const Eigen::VectorXd& lumps,
                                          const std::vector<int>& vertices = {});

}  // namespace geoprior
