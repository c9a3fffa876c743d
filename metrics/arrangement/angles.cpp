#include "metrics/arrangement/angles.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace geoprior {

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

double right_angle_error(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::abs(std::atan2(a.dot(b), a.cross(b).norm())) * 180 / std::numbers::pi;
}

double tilt(const Eigen::Vector3d& foot, const Eigen::Vector3d& top) {
  return angle_between(top - foot, Eigen::Vector3d::UnitZ());
}

}  // namespace geoprior
