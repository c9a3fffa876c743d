#include "metrics/contact/pose_return.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace geoprior {
namespace {

/// Of the entries of two transforms of one pose.
constexpr double kSamePose = 1e-12;

bool same_pose(const Pose& a, const Pose& b) {
  for (std::size_t j = 0; j < a.size(); ++j)
    if ((a[j].matrix() - b[j].matrix()).cwiseAbs().maxCoeff() > kSamePose) return false;
  return true;
}

}  // namespace

Eigen::MatrixX3d in_bone_frame(const SkinWeights& weights, const Pose& pose,
                               const Eigen::MatrixX3d& posed) {
  std::vector<Eigen::Affine3d> back;
  back.reserve(pose.size());
  for (const Eigen::Affine3d& T : pose) back.push_back(T.inverse());
  Eigen::MatrixX3d local(posed.rows(), 3);
  for (int v = 0; v < local.rows(); ++v) {
    Eigen::Index dominant = 0;
    double largest = -1;
    for (SkinWeights::InnerIterator it(weights, v); it; ++it) {
      if (it.value() <= largest) continue;
      largest = it.value();
      dominant = it.col();
    }
    const Eigen::Vector3d x = posed.row(v).transpose();
    local.row(v) = (back[dominant] * x).transpose();
  }
  return local;
}

std::optional<double> pose_return(const std::vector<Eigen::MatrixX3d>& positions,
                                  const std::vector<Pose>& poses, const Eigen::VectorXd& radius) {
  if (positions.size() != poses.size()) {
    throw Error("as many poses as frames are needed", "pose return",
                std::to_string(positions.size()));
  }
  std::optional<double> largest;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!same_pose(poses[i], poses[j])) continue;
      if (positions[i].rows() != radius.size() || positions[j].rows() != radius.size())
        throw Error("frames differ in their vertices", "pose return", "one skin");
      if (!largest) largest = 0;
      for (Eigen::Index v = 0; v < radius.size(); ++v) {
        if (!(radius(v) > 0)) continue;
        const double distance = (positions[i].row(v) - positions[j].row(v)).norm();
        largest = std::max(*largest, distance / radius(v));
      }
    }
  }
  return largest;
}

}  // namespace geoprior
