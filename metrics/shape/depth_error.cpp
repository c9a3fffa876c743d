#include "metrics/shape/depth_error.h"

#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior {
namespace {

void require_matched_points(const Eigen::MatrixX3d& points, const Eigen::MatrixX3d& truth) {
  if (points.rows() != truth.rows() || points.rows() == 0) {
    throw Error(std::to_string(points.rows()) + " and " + std::to_string(truth.rows()) + " points",
                "depth error", "equal numbers, at least one");
  }
  if (!points.allFinite() || !truth.allFinite())
    throw Error("coordinate is not finite", "depth error", "finite numbers");
}

/// Factor on `depth` that brings it nearest to `truth` when an offset is free; 1 for one depth.
double best_depth_scale(const Eigen::VectorXd& depth, const Eigen::VectorXd& truth) {
  const Eigen::VectorXd d = depth.array() - depth.mean();
  const double spread = d.squaredNorm();
  return spread > 0 ? d.dot(truth) / spread : 1.0;
}

}  // namespace

DepthError depth_error(const Eigen::MatrixX3d& points, const Eigen::MatrixX3d& truth,
                       const Eigen::Vector3d& to_eye, double length, DepthAlignment alignment) {
  require_matched_points(points, truth);
  if (!(to_eye.squaredNorm() > 0)) throw Error("view has no direction", "depth error", "not 0");
  if (!(length > 0)) throw Error("length is not positive", "depth error", "above 0 m");
  const Eigen::Vector3d view = to_eye.normalized();
  const Eigen::VectorXd depth = points * view, true_depth = truth * view;
  DepthError error;
  if (alignment == DepthAlignment::offset_and_scale)
    error.scale = best_depth_scale(depth, true_depth);
  if (alignment != DepthAlignment::none) error.offset = (true_depth - error.scale * depth).mean();
  const Eigen::ArrayXd left = (error.scale * depth - true_depth).array() + error.offset;
  const auto n = static_cast<double>(points.rows());
  error.rms = std::sqrt(left.square().sum() / n);
  error.max = left.abs().maxCoeff();
  error.share = error.rms / length;
  const Eigen::MatrixX3d off = points - truth;
  const Eigen::MatrixX3d across = off - off * view * view.transpose();
  error.in_plane_rms = std::sqrt(across.squaredNorm() / n);
  return error;
}

}  // namespace geoprior
