#include "baselines/paper/pattern.h"

namespace geoprior {

double signed_area(const Pattern& pattern) {
  double twice = 0;
  for (std::size_t i = 0; i < pattern.border.size(); ++i) {
    const Eigen::Vector2d& p = pattern.border[i];
    const Eigen::Vector2d& q = pattern.border[(i + 1) % pattern.border.size()];
    twice += p.x() * q.y() - q.x() * p.y();
  }
  return twice / 2;
}

}  // namespace geoprior
