#include "models/paper/tear/toughness.h"

#include <cmath>
#include <numbers>

#include "models/paper/sheet/value_noise.h"

namespace geoprior::paper {

using Eigen::Vector2d;

double Toughness::texture(const Vector2d& p) const {
  if (noise == 0) return 1;
  return 1 - noise * value_noise(p / noise_length, seed);
}

double Toughness::at(const Vector2d& p, const Vector2d& d) const {
  double share = 1;
  if (grain_deg) {
    const double grain = *grain_deg * std::numbers::pi / 180;
    const double along = d.dot(Vector2d(std::cos(grain), std::sin(grain)));
    share = along * along + across * (1 - along * along);
  }
  return energy * share * texture(p);
}

}  // namespace geoprior::paper
