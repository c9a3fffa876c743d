#include "baselines/sketch/gauss_thinning/rotation_targets.h"

#include <string>

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "core/parallel.h"
#include "models/sketch/surface/cotangent_weights.h"

namespace geoprior::sketch {
namespace {

constexpr std::size_t kVerticesOfBlock = 512;

/// Cotangents times w_t / area_t: 1, or the mean area over the triangle's own, so that both kinds
/// of weights have the unit of an area.
Eigen::MatrixX3d weighted_cotangents(const TriMesh& mesh, TriangleWeight weight) {
  Eigen::MatrixX3d cotangents = corner_cotangents(mesh);
  if (weight == TriangleWeight::area || mesh.triangle_count() == 0) return cotangents;
  const Eigen::VectorXd areas = triangle_areas(mesh.V, mesh.F);
  const double mean = areas.mean();
  for (Eigen::Index t = 0; t < areas.size(); ++t) {
    if (!(areas(t) > 0))
      throw Error("its area is zero", "triangle " + std::to_string(t),
                  "triangles of finite size, or area weights");
    cotangents.row(t) *= mean / areas(t);
  }
  return cotangents;
}

/// The stiffness with identity in the rows and columns of vertices that are held at the origin.
Eigen::SparseMatrix<double> held_at_origin(Eigen::SparseMatrix<double> stiffness,
                                           const std::vector<int>& held) {
  std::vector<bool> holds(stiffness.rows(), false);
  for (const int v : held) holds[v] = true;
  stiffness.prune(
      [&](Eigen::Index i, Eigen::Index j, double) { return i == j || (!holds[i] && !holds[j]); });
  for (const int v : held) stiffness.coeffRef(v, v) = 1;
  return stiffness;
}

}  // namespace

RotationPoisson::RotationPoisson(const TriMesh& reference, TriangleWeight weight)
    : reference_(reference) {
  const EdgeConnectivity checked(reference.F);  // refuses negative indices
  if (reference.F.size() > 0 && reference.F.maxCoeff() >= reference.vertex_count())
    throw Error("no vertex " + std::to_string(reference.F.maxCoeff()), "rotation targets",
                "0 ... " + std::to_string(reference.vertex_count() - 1));
  cotangents_ = weighted_cotangents(reference, weight);
  corners_ = VertexCorners(reference.F, reference.vertex_count());
  find_components();
  cholesky_.emplace(
      held_at_origin(cotangent_stiffness(reference.F, cotangents_, reference.vertex_count()),
                     held_),
      "rotation targets");
}

void RotationPoisson::find_components() {
  const int n = reference_.vertex_count();
  DisjointSets sets(n);
  for (Eigen::Index t = 0; t < reference_.F.rows(); ++t) {
    sets.join(reference_.F(t, 0), reference_.F(t, 1));
    sets.join(reference_.F(t, 0), reference_.F(t, 2));
  }
  component_.resize(n);
  for (int v = 0; v < n; ++v) {
    if (sets.find(v) == v) {
      component_[v] = static_cast<int>(held_.size());
      held_.push_back(v);
    } else {
      component_[v] = component_[sets.find(v)];
    }
  }
}

Eigen::MatrixX3d RotationPoisson::right_hand_side(std::span<const Eigen::Matrix3d> rotations,
                                                  const Eigen::MatrixX3d& positions) const {
  Eigen::MatrixX3d rhs(reference_.vertex_count(), 3);
  const Eigen::MatrixX3i& F = reference_.F;
  const auto sum_star = [&](int v) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int corner : corners_.of(v)) {
      const int t = corner / 3, a = corner % 3, b = (a + 1) % 3, c = (a + 2) % 3;
      const auto here = positions.row(v), next = positions.row(F(t, b)),
                 last = positions.row(F(t, c));
      sum += rotations[t] *
             (cotangents_(t, c) * (here - next) + cotangents_(t, b) * (here - last)).transpose();
    }
    rhs.row(v) = sum.transpose();
  };
  parallel_blocks(rhs.rows(), kVerticesOfBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) sum_star(static_cast<int>(v));
  });
  for (const int v : held_) rhs.row(v).setZero();
  return rhs;
}

void RotationPoisson::keep_means(const Eigen::MatrixX3d& positions, Eigen::MatrixX3d& x) const {
  Eigen::MatrixX3d shift = Eigen::MatrixX3d::Zero(held_.size(), 3);
  Eigen::VectorXd count = Eigen::VectorXd::Zero(shift.rows());
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    shift.row(component_[v]) += positions.row(v) - x.row(v);
    count(component_[v]) += 1;
  }
  for (Eigen::Index c = 0; c < shift.rows(); ++c) shift.row(c) /= count(c);
  for (Eigen::Index v = 0; v < x.rows(); ++v) x.row(v) += shift.row(component_[v]);
}

Eigen::MatrixX3d RotationPoisson::solve(std::span<const Eigen::Matrix3d> rotations) const {
  return solve(rotations, reference_.V);
}

Eigen::MatrixX3d RotationPoisson::solve(std::span<const Eigen::Matrix3d> rotations,
                                        const Eigen::MatrixX3d& positions) const {
  if (std::ssize(rotations) != reference_.F.rows() || positions.rows() != reference_.V.rows()) {
    throw Error(std::to_string(rotations.size()) + " rotations and " +
                    std::to_string(positions.rows()) + " positions",
                "rotation targets",
                std::to_string(reference_.triangle_count()) + " and " +
                    std::to_string(reference_.vertex_count()));
  }
  Eigen::MatrixX3d x = right_hand_side(rotations, positions);
  cholesky_->solve(x);
  keep_means(positions, x);
  return x;
}

double RotationPoisson::energy(std::span<const Eigen::Matrix3d> rotations,
                               const Eigen::MatrixX3d& positions, const Eigen::MatrixX3d& x) const {
  double twice = 0;
  for (Eigen::Index t = 0; t < reference_.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = reference_.F(t, (k + 1) % 3), b = reference_.F(t, (k + 2) % 3);
      const Eigen::Vector3d edge = (positions.row(a) - positions.row(b)).transpose();
      const Eigen::Vector3d found = (x.row(a) - x.row(b)).transpose();
      twice += cotangents_(t, k) * (found - rotations[t] * edge).squaredNorm();
    }
  }
  return twice / 2;
}

}  // namespace geoprior::sketch
