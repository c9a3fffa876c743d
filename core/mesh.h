#pragma once

#include <Eigen/Core>

namespace geoprior {

/// Indexed triangle mesh: `V` one row per vertex (metres), `F` one row of vertex indices per
/// triangle, counter-clockwise seen from outside. A value; whether it is closed or manifold is
/// asked of core/geometry/topology.h.
struct TriMesh {
  Eigen::MatrixX3d V;
  Eigen::MatrixX3i F;

  [[nodiscard]] int vertex_count() const { return static_cast<int>(V.rows()); }
  [[nodiscard]] int triangle_count() const { return static_cast<int>(F.rows()); }
};

/// Whether two lists name the same vertices, triangle by triangle and corner by corner. Lists of
/// different lengths differ; Eigen's own comparison would read past the shorter one.
bool same_triangles(const Eigen::MatrixX3i& a, const Eigen::MatrixX3i& b);

/// Length of the diagonal of the axis-aligned bounding box of the rows of `V`; 0 for no rows.
double bounding_box_diagonal(const Eigen::MatrixX3d& V);

/// Volume enclosed by a closed, outward oriented mesh: (1/6) sum v0.(v1 x v2), about the box centre
/// for round-off.
double signed_volume(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F);

/// Unit normals of the triangles (rows; zero for a degenerate triangle).
Eigen::MatrixX3d triangle_normals(const TriMesh& mesh);

/// Unit vertex normals, angle weighted (Thürmer and Wüthrich 1998); zero for a vertex without
/// triangles.
Eigen::MatrixX3d vertex_normals(const TriMesh& mesh);

/// Areas of the triangles (m^2).
Eigen::VectorXd triangle_areas(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F);

}  // namespace geoprior
