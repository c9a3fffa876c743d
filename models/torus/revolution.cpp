#include "models/torus/revolution.h"

#include <cmath>
#include <numbers>

namespace geoprior::torus {

Eigen::Vector3d revolution_point(const Radii& radii, const Eigen::Vector2d& at) {
  const Eigen::Vector2d angle = 2 * std::numbers::pi * at;
  const double ring = radii.ring + radii.tube * std::cos(angle.x());
  return Eigen::Vector3d(ring * std::cos(angle.y()), ring * std::sin(angle.y()),
                         radii.tube * std::sin(angle.x())) /
         (2 * std::numbers::pi);
}

Eigen::Vector3d revolution_normal(const Eigen::Vector2d& at) {
  const Eigen::Vector2d angle = 2 * std::numbers::pi * at;
  return {std::cos(angle.x()) * std::cos(angle.y()), std::cos(angle.x()) * std::sin(angle.y()),
          std::sin(angle.x())};
}

}  // namespace geoprior::torus
