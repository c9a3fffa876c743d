#include "metrics/developability/ruling_angle.h"

#include <Eigen/Geometry>
#include <cmath>

namespace geoprior {

std::optional<double> ruling_angle_rms(const std::vector<std::array<Eigen::Vector3d, 2>>& rulings,
                                       const Eigen::Vector3d& apex, const Eigen::Vector3d& shift) {
  double sum = 0;
  int count = 0;
  for (const auto& [a, b] : rulings) {
    if (a == b) continue;
    const Eigen::Vector3d middle = (a + b) / 2 + shift;
    const Eigen::Vector3d generator = apex - middle;
    const double angle = std::atan2(generator.cross(b - a).norm(), std::abs(generator.dot(b - a)));
    sum += angle * angle;
    ++count;
  }
  if (count == 0) return {};
  return std::sqrt(sum / count);
}

}  // namespace geoprior
