#include "metrics/isometry/distortion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "metrics/tracks/weighted_quantile.h"

namespace geoprior {
namespace {

constexpr double kSmallestSingularValue = 1e-6;

/// J^T J in an orthonormal frame of the rest triangle; its eigenvalues are the squared singular
/// values.
Eigen::Vector2d singular_values_of(const Eigen::Vector3d& rest_u, const Eigen::Vector3d& rest_v,
                                   const Eigen::Vector3d& posed_u, const Eigen::Vector3d& posed_v) {
  const double length = rest_u.norm();
  const double height = rest_u.cross(rest_v).norm() / (length > 0 ? length : 1);
  if (!(length > 0) || !(height > 0)) return {1, 1};
  const double shift = rest_u.dot(rest_v) / length;
  const Eigen::Vector3d x = posed_u / length;
  const Eigen::Vector3d y = (posed_v - shift * x) / height;
  // Sum and product of the singular values avoid the cancellation of the quadratic formula.
  const double norm2 = x.squaredNorm() + y.squaredNorm();
  const double determinant = x.cross(y).norm();
  const double sum = std::sqrt(norm2 + 2 * determinant);
  const double difference = std::sqrt(std::max(norm2 - 2 * determinant, 0.0));
  const double large = (sum + difference) / 2;
  return {large, large > 0 ? determinant / large : 0.0};
}

}  // namespace

Eigen::MatrixX2d singular_values(const Eigen::MatrixX3d& rest, const Eigen::MatrixX3d& posed,
                                 const Eigen::MatrixX3i& F, const std::vector<int>& triangles) {
  if (rest.rows() != posed.rows()) {
    throw Error(std::to_string(posed.rows()) + " posed vertices", "distortion",
                std::to_string(rest.rows()) + ", as at rest");
  }
  Eigen::MatrixX2d values(triangles.size(), 2);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const int a = F(triangles[i], 0);
    const int b = F(triangles[i], 1);
    const int c = F(triangles[i], 2);
    values.row(i) = singular_values_of((rest.row(b) - rest.row(a)).transpose(),
                                       (rest.row(c) - rest.row(a)).transpose(),
                                       (posed.row(b) - posed.row(a)).transpose(),
                                       (posed.row(c) - posed.row(a)).transpose())
                        .transpose();
  }
  return values;
}

DistortionSummary distortion(const Eigen::MatrixX3d& rest, const Eigen::MatrixX3d& posed,
                             const Eigen::MatrixX3i& F, const std::vector<int>& triangles) {
  const Eigen::MatrixX2d values = singular_values(rest, posed, F, triangles);
  Eigen::VectorXd area(values.rows());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Eigen::RowVector3d a = rest.row(F(triangles[i], 0));
    const Eigen::RowVector3d u = rest.row(F(triangles[i], 1)) - a;
    const Eigen::RowVector3d v = rest.row(F(triangles[i], 2)) - a;
    area(i) = 0.5 * u.cross(v).norm();
  }
  if (!(area.sum() > 0)) throw Error("no triangles with an area", "distortion", "at least one");
  const Eigen::VectorXd ratio = values.col(0).cwiseProduct(values.col(1));
  const Eigen::ArrayX2d clamped = values.array().max(kSmallestSingularValue);
  const Eigen::ArrayX2d energy = clamped.square() + clamped.square().inverse();
  DistortionSummary s;
  const std::vector<double> quantiles = weighted_quantiles(ratio, area, std::array{0.05, 0.95});
  s.area_ratio_p05 = quantiles[0];
  s.area_ratio_p95 = quantiles[1];
  s.area_ratio_max = ratio.maxCoeff();
  s.singular_value_max = values.col(0).maxCoeff();
  s.singular_value_min = values.col(1).minCoeff();
  s.symmetric_dirichlet = (energy.rowwise().sum() * area.array()).sum() / area.sum();
  return s;
}

}  // namespace geoprior
