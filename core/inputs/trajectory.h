#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace geoprior {

/// Position and orientation of a body at a time, relative to where it starts.
struct Keyframe {
  double time = 0;                                           ///< s
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();           ///< m
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  ///< about the body's centre
};

/// Keyframes with strictly increasing times. Between two keys cubic in time (Hermite; the velocity
/// at a key is the finite difference of its neighbours, limited so that a coordinate never
/// overshoots two keys, and zero at the first and last); rotations likewise in the log of the turn
/// between two keys. Constant before the first and after the last.
struct Trajectory {
  std::vector<Keyframe> keys;
  [[nodiscard]] Keyframe at(double time) const;
};

}  // namespace geoprior
