#include "solvers/sketch/pattern/conformal_scale.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "models/sketch/surface/cotangent_weights.h"
#include "models/sketch/surface/position_cholesky.h"

namespace geoprior::sketch {

Eigen::VectorXd angle_defects(const TriMesh& piece) {
  const std::vector<bool> border = boundary_vertices(piece.F, piece.vertex_count());
  Eigen::VectorXd defect = Eigen::VectorXd::Constant(piece.vertex_count(), 2 * std::numbers::pi);
  for (int t = 0; t < piece.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d at = piece.V.row(piece.F(t, k)).transpose();
      const Eigen::Vector3d next = piece.V.row(piece.F(t, (k + 1) % 3)).transpose() - at;
      const Eigen::Vector3d last = piece.V.row(piece.F(t, (k + 2) % 3)).transpose() - at;
      defect(piece.F(t, k)) -= std::atan2(next.cross(last).norm(), next.dot(last));
    }
  }
  for (int v = 0; v < piece.vertex_count(); ++v) {
    if (border[v]) defect(v) = 0;
  }
  return defect;
}

Eigen::VectorXd conformal_scale(const TriMesh& piece) {
  const int n = piece.vertex_count();
  const std::vector<bool> border = boundary_vertices(piece.F, n);
  if (boundary_edges(piece.F).empty())
    throw Error("has no border at which its scale is known", "conformal scale", "a piece with one");
  // The stiffness is that of the sum of cot |x_b - x_c|^2 / 2, twice the Dirichlet energy.
  Eigen::SparseMatrix<double> L = cotangent_stiffness(piece.F, corner_cotangents(piece) / 2, n);
  L.prune(
      [&](Eigen::Index i, Eigen::Index j, double) { return i == j || (!border[i] && !border[j]); });
  for (int v = 0; v < n; ++v) {
    if (border[v]) L.coeffRef(v, v) = 1;
  }
  Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(n, 3);
  u.col(0) = angle_defects(piece);
  PositionCholesky(L, "conformal scale").solve(u);
  return u.col(0);
}

}  // namespace geoprior::sketch
