#include "models/sketch/surface/cotangent_weights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <vector>

namespace geoprior::sketch {
namespace {

constexpr double kLowestCotangent = -2;
constexpr double kHighestCotangent = 20;

/// Raises the lowest of three cotangents until the energy of their triangle is convex.
void make_convex(Eigen::RowVector3d& cotangent) {
  int lowest = 0;
  cotangent.minCoeff(&lowest);
  const double a = cotangent((lowest + 1) % 3), b = cotangent((lowest + 2) % 3);
  const double least = a + b > 0 ? -a * b / (a + b) : 0;
  cotangent(lowest) = std::max(cotangent(lowest), least);
}

}  // namespace

Eigen::MatrixX3d corner_cotangents(const TriMesh& mesh) {
  Eigen::MatrixX3d cotangents(mesh.triangle_count(), 3);
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    Eigen::RowVector3d row;
    for (int k = 0; k < 3; ++k) {
      const Eigen::RowVector3d apex = mesh.V.row(mesh.F(t, k));
      const Eigen::RowVector3d u = mesh.V.row(mesh.F(t, (k + 1) % 3)) - apex;
      const Eigen::RowVector3d v = mesh.V.row(mesh.F(t, (k + 2) % 3)) - apex;
      const double sine = std::max(u.cross(v).norm(), std::numeric_limits<double>::min());
      row(k) = std::clamp(u.dot(v) / sine, kLowestCotangent, kHighestCotangent);
    }
    make_convex(row);
    cotangents.row(t) = row;
  }
  return cotangents;
}

Eigen::SparseMatrix<double> cotangent_stiffness(const Eigen::MatrixX3i& F,
                                                const Eigen::MatrixX3d& cotangents,
                                                int vertex_count) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(12 * F.rows() + vertex_count);
  for (int v = 0; v < vertex_count; ++v) entries.emplace_back(v, v, 0.0);
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = F(t, (k + 1) % 3), b = F(t, (k + 2) % 3);
      const double w = cotangents(t, k);
      entries.emplace_back(a, a, w);
      entries.emplace_back(b, b, w);
      entries.emplace_back(a, b, -w);
      entries.emplace_back(b, a, -w);
    }
  }
  Eigen::SparseMatrix<double> stiffness(vertex_count, vertex_count);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  return stiffness;
}

}  // namespace geoprior::sketch
