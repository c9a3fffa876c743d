#include "metrics/developability/quadric_fit.h"

#include <Eigen/Dense>
#include <numbers>

namespace geoprior {
namespace {

using Quadratics = Eigen::MatrixX3d;  // columns: uu, sqrt2 uv, vv; the norm is that of the matrix

constexpr double kThinnest = 1e-9;  // points of one line: breadth over length, squared

Eigen::RowVector3d half_squares(const Eigen::RowVector2d& p) {
  return {p.x() * p.x() / 2, p.x() * p.y() / std::numbers::sqrt2, p.y() * p.y() / 2};
}

Eigen::Matrix2d as_matrix(const Eigen::Vector3d& c) {
  const double uv = c[1] / std::numbers::sqrt2;
  return (Eigen::Matrix2d() << c[0], uv, uv, c[2]).finished();
}

/// Centred coordinates of unit covariance, p = mean + axes q.
struct Frame2 {
  Eigen::RowVector2d mean;
  Eigen::Matrix2d axes, inverse;
};

std::optional<Frame2> own_frame(const Eigen::MatrixX2d& points) {
  if (points.rows() < 3) return std::nullopt;
  const Eigen::RowVector2d mean = points.colwise().mean();
  const Eigen::MatrixX2d centred = points.rowwise() - mean;
  const Eigen::Matrix2d covariance =
      centred.transpose() * centred / static_cast<double>(points.rows());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(covariance);
  const Eigen::Vector2d size = solver.eigenvalues();
  if (!(size[0] > kThinnest * size[1])) return std::nullopt;
  const Eigen::Matrix2d axes = solver.eigenvectors() * size.cwiseSqrt().asDiagonal();
  return Frame2{mean, axes, axes.inverse()};
}

/// Weights of the values in C (3 x n), by the quadratics less their affine parts.
Eigen::Matrix3Xd second_order(const Eigen::MatrixX2d& q, const Quadratics& squares,
                              const Frame2& frame, QuadricFit* fit) {
  const double n = static_cast<double>(q.rows());
  const Quadratics pure =
      (squares - q * (q.transpose() * squares / n)).rowwise() - squares.colwise().mean();
  const Eigen::Matrix3d gram = pure.transpose() * pure;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(gram);
  Eigen::Vector3d inverse = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    if (solver.eigenvalues()[k] > kLeastObserved * solver.eigenvalues()[2]) {
      inverse[k] = 1 / solver.eigenvalues()[k];
      continue;
    }
    ++fit->unobserved;
    const Eigen::Matrix2d conic =
        frame.inverse.transpose() * as_matrix(solver.eigenvectors().col(k)) * frame.inverse;
    fit->conic << conic(0, 0), conic(0, 1), conic(1, 1);
  }
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose() *
         pure.transpose();
}

}  // namespace

std::optional<QuadricFit> fit_quadric(const Eigen::MatrixX2d& points) {
  const std::optional<Frame2> frame = own_frame(points);
  if (!frame) return std::nullopt;
  const Eigen::Index n = points.rows();
  const Eigen::MatrixX2d q = (points.rowwise() - frame->mean) * frame->inverse.transpose();
  Quadratics squares(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) squares.row(i) = half_squares(q.row(i));

  QuadricFit fit;
  fit.weights.resize(n, 6);
  const Eigen::Matrix3Xd second = second_order(q, squares, *frame, &fit);
  const Eigen::RowVector2d origin = -frame->mean * frame->inverse.transpose();
  const Eigen::RowVector3d mean_squares = squares.colwise().mean();
  const Eigen::Matrix<double, 2, 3> first_squares =
      q.transpose() * squares / static_cast<double>(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d c = second.col(i);
    const Eigen::Vector2d b = q.row(i).transpose() / static_cast<double>(n) - first_squares * c;
    const Eigen::Matrix2d C = as_matrix(c);
    const double value =
        1.0 / static_cast<double>(n) - mean_squares * c + origin.dot(b) + half_squares(origin) * c;
    const Eigen::Vector2d gradient = frame->inverse.transpose() * (b + C * origin.transpose());
    const Eigen::Matrix2d hessian = frame->inverse.transpose() * C * frame->inverse;
    fit.weights.row(i) << value, gradient.x(), gradient.y(), hessian(0, 0), hessian(0, 1),
        hessian(1, 1);
  }
  return fit;
}

}  // namespace geoprior
