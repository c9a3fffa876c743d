#pragma once

#include <Eigen/Core>

namespace geoprior {

/// Angle between two directions (deg), 0 to 180: accurate to round-off at both ends too, where an
/// arc cosine is not. 0 where one of them has no length.
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// |angle between the two directions - 90| (deg): how far two walls are from orthogonal, whichever
/// way each runs.
double right_angle_error(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Angle between the way from `foot` to `top` and the vertical, +z (deg).
double tilt(const Eigen::Vector3d& foot, const Eigen::Vector3d& top);

}  // namespace geoprior
