#include "models/skinning/surface_diffusion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "core/error.h"
#include "core/numerics/sparse_ldlt.h"
#include "core/parallel.h"

namespace geoprior::skinning {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// Least conductance of an edge: positive, so that heat reaches every vertex of a component; small
/// beside the cotangent weight of a regular edge (0.58).
constexpr double kLeastConductance = 1e-5;

/// What a corner of a triangle knows of the edge opposite to it.
struct Corner {
  double twice_area;
  double cotangent;
};

Corner corner(const TriMesh& mesh, Eigen::Index t, int k) {
  const Eigen::RowVector3d apex = mesh.V.row(mesh.F(t, k));
  const Eigen::RowVector3d to_a = mesh.V.row(mesh.F(t, (k + 1) % 3)) - apex;
  const Eigen::RowVector3d to_b = mesh.V.row(mesh.F(t, (k + 2) % 3)) - apex;
  const double twice_area = to_a.cross(to_b).norm();
  // A sliver counts as one of a thousandth of its edges' rectangle: its cotangent stays finite.
  const double floor = 1e-3 * to_a.norm() * to_b.norm();
  return {twice_area, floor > 0 ? to_a.dot(to_b) / std::max(twice_area, floor) : 0};
}

/// Half the sum of the cotangents opposite to each edge, in the upper triangle, and the mean
/// conductivity of its triangles.
struct EdgeConductance {
  Sparse conductance;
  Sparse factor;
};

EdgeConductance edge_conductance(const TriMesh& mesh, const Eigen::VectorXd& conductivity) {
  std::vector<Eigen::Triplet<double>> conductances, factors;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.F(t, (k + 1) % 3), b = mesh.F(t, (k + 2) % 3);
      conductances.emplace_back(std::min(a, b), std::max(a, b),
                                0.5 * corner(mesh, t, k).cotangent * conductivity(t));
      factors.emplace_back(std::min(a, b), std::max(a, b), 0.5 * conductivity(t));
    }
  }
  const int n = mesh.vertex_count();
  EdgeConductance edges{Sparse(n, n), Sparse(n, n)};
  edges.conductance.setFromTriplets(conductances.begin(), conductances.end());
  edges.factor.setFromTriplets(factors.begin(), factors.end());
  return edges;
}

}  // namespace

Eigen::VectorXd vertex_areas(const TriMesh& mesh) {
  Eigen::VectorXd area = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) area(mesh.F(t, k)) += corner(mesh, t, k).twice_area / 6;
  }
  return area;
}

Sparse positive_cotangent_laplacian(const TriMesh& mesh, const Eigen::VectorXd& conductivity) {
  const EdgeConductance edges = edge_conductance(mesh, conductivity);
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < mesh.vertex_count(); ++v) entries.emplace_back(v, v, 0.0);
  for (int column = 0; column < edges.conductance.outerSize(); ++column) {
    Sparse::InnerIterator factor(edges.factor, column);
    for (Sparse::InnerIterator it(edges.conductance, column); it; ++it, ++factor) {
      const double w = std::max(it.value(), kLeastConductance * factor.value());
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

Sparse positive_cotangent_laplacian(const TriMesh& mesh) {
  return positive_cotangent_laplacian(mesh, Eigen::VectorXd::Ones(mesh.triangle_count()));
}

Eigen::VectorXd squared_at_triangles(const TriMesh& mesh, const Eigen::VectorXd& length) {
  Eigen::VectorXd squared(mesh.triangle_count());
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const double mean = (length(mesh.F(t, 0)) + length(mesh.F(t, 1)) + length(mesh.F(t, 2))) / 3;
    squared(t) = mean * mean;
  }
  return squared;
}

Eigen::MatrixXd solve_columns(const Sparse& system, const Eigen::MatrixXd& rhs,
                              const std::string& what) {
  const SparseLdlt factor(system);
  if (!factor.succeeded()) throw Error(what + " has no unique solution", "skin weights");
  Eigen::MatrixXd solution(rhs.rows(), rhs.cols());
  parallel_blocks(rhs.cols(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      solution.col(j) = factor.solve(rhs.col(j));
    }
  });
  return solution;
}

}  // namespace geoprior::skinning
