#include "models/skinning/cotangent_laplacian.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace geoprior::skinning {
namespace {

/// Least conductance of an edge: positive, so that heat reaches every vertex of a component; small
/// beside the cotangent weight of a regular edge (0.58).
constexpr double kLeastConductance = 1e-5;

}  // namespace

Eigen::SparseMatrix<double> positive_cotangent_laplacian(const TriMesh& mesh) {
  using Sparse = Eigen::SparseMatrix<double>;
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.F(t, (k + 1) % 3), b = mesh.F(t, (k + 2) % 3);
      const Eigen::RowVector3d to_a = mesh.V.row(a) - mesh.V.row(mesh.F(t, k));
      const Eigen::RowVector3d to_b = mesh.V.row(b) - mesh.V.row(mesh.F(t, k));
      const double twice_area = to_a.cross(to_b).norm();
      // A sliver counts as one of a thousandth of its edges' rectangle: its cotangent stays finite.
      const double floor = 1e-3 * to_a.norm() * to_b.norm();
      const double cotangent = floor > 0 ? to_a.dot(to_b) / std::max(twice_area, floor) : 0;
      entries.emplace_back(std::min(a, b), std::max(a, b), 0.5 * cotangent);
    }
  }
  Sparse edges(mesh.vertex_count(), mesh.vertex_count());
  edges.setFromTriplets(entries.begin(), entries.end());
  entries.clear();
  for (int column = 0; column < edges.outerSize(); ++column) {
    for (Sparse::InnerIterator it(edges, column); it; ++it) {
      const double w = std::max(it.value(), kLeastConductance);
      const auto a = static_cast<int>(it.row()), b = static_cast<int>(it.col());
      entries.emplace_back(a, a, w);
      entries.emplace_back(b, b, w);
      entries.emplace_back(a, b, -w);
      entries.emplace_back(b, a, -w);
    }
  }
  Sparse laplacian(mesh.vertex_count(), mesh.vertex_count());
  laplacian.setFromTriplets(entries.begin(), entries.end());
  return laplacian;
}

}  // namespace geoprior::skinning
