#include "solvers/skinning/field/hrbf.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior::skinning {
namespace {

// Closer than this (in scaled units) the terms of a centre vanish: l^3 and l are far below
// round-off of the sum, and the direction delta / l is undefined.
constexpr double kSameCentre = 1e-9;

Eigen::MatrixXd hermite_matrix(const Eigen::MatrixX3d& centres) {
  const Eigen::Index n = centres.rows();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(4 * n, 4 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j) {
      if (i == j) continue;
      const Eigen::Vector3d delta = centres.row(i) - centres.row(j);
      const double l = delta.norm();
      if (l < kSameCentre) {
        throw Error("two samples coincide",
                    "samples " + std::to_string(i) + " and " + std::to_string(j));
      }
      auto block = matrix.block<4, 4>(4 * i, 4 * j);
      block(0, 0) = l * l * l;
      block.block<1, 3>(0, 1) = 3 * l * delta.transpose();
      block.block<3, 1>(1, 0) = 3 * l * delta;
      block.block<3, 3>(1, 1) =
          3 * l * Eigen::Matrix3d::Identity() + (3 / l) * delta * delta.transpose();
    }
  }
  return matrix;
}

}  // namespace

Hrbf::Hrbf(const Eigen::MatrixX3d& points, const Eigen::MatrixX3d& normals, double scale)
    : centres_(points / scale), scale_(scale) {
  if (points.rows() != normals.rows() || points.rows() < 2 || !(scale > 0)) {
    throw Error("cannot fit a field to " + std::to_string(points.rows()) + " points and " +
                    std::to_string(normals.rows()) + " normals",
                "HRBF", "two points or more, as many normals, positive scale");
  }
  const Eigen::Index n = points.rows();
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(4 * n);
  for (Eigen::Index i = 0; i < n; ++i) rhs.segment<3>(4 * i + 1) = normals.row(i);
  const Eigen::MatrixXd matrix = hermite_matrix(centres_);
  const Eigen::PartialPivLU<Eigen::MatrixXd> lu(matrix);
  Eigen::VectorXd x = lu.solve(rhs);
  x += lu.solve(rhs - matrix * x);  // one refinement: the condition reaches 1e6
  if (!x.allFinite()) throw Error("the samples' system has no solution", "HRBF");
  coefficients_ =
      Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>>(x.data(), n, 4);
}

Hrbf::Value Hrbf::operator()(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d scaled = p / scale_;
  Value result;
  for (Eigen::Index k = 0; k < centres_.rows(); ++k) {
    const Eigen::Vector3d delta = scaled - centres_.row(k).transpose();
    const double l = delta.norm();
    if (l < kSameCentre) continue;
    const double alpha = coefficients_(k, 0);
    const Eigen::Vector3d beta = coefficients_.row(k).tail<3>();
    const double along = beta.dot(delta);
    result.value += l * (alpha * l * l + 3 * along);
    result.gradient += 3 * ((alpha * l + along / l) * delta + l * beta);
  }
  return result;
}

void Hrbf::evaluate(const Eigen::MatrixX3d& points, Eigen::MatrixX4d& gradient_and_value) const {
  const Eigen::Index n = points.rows();
  gradient_and_value.setZero(n, 4);
  const Eigen::MatrixX3d scaled = points / scale_;
  const double* x = scaled.col(0).data();
  const double* y = scaled.col(1).data();
  const double* z = scaled.col(2).data();
  double* gx = gradient_and_value.col(0).data();
  double* gy = gradient_and_value.col(1).data();
  double* gz = gradient_and_value.col(2).data();
  double* value = gradient_and_value.col(3).data();
  for (Eigen::Index k = 0; k < centres_.rows(); ++k) {
    const double cx = centres_(k, 0), cy = centres_(k, 1), cz = centres_(k, 2);
    const double alpha = coefficients_(k, 0), bx = coefficients_(k, 1);
    const double by = coefficients_(k, 2), bz = coefficients_(k, 3);
    for (Eigen::Index i = 0; i < n; ++i) {  // independent points: the compiler vectorises this
      const double dx = x[i] - cx, dy = y[i] - cy, dz = z[i] - cz;
      const double l = std::sqrt(dx * dx + dy * dy + dz * dz + kSameCentre * kSameCentre);
      const double along = bx * dx + by * dy + bz * dz;
      const double radial = 3 * (alpha * l + along / l);
      value[i] += l * (alpha * l * l + 3 * along);
      gx[i] += radial * dx + 3 * l * bx;
      gy[i] += radial * dy + 3 * l * by;
      gz[i] += radial * dz + 3 * l * bz;
    }
  }
}

}  // namespace geoprior::skinning
