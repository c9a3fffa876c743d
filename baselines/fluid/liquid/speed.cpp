#include "baselines/fluid/liquid/speed.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace geoprior::fluid {

double fastest_particle(const LiquidParticles& particles, double time) {
  constexpr std::size_t kBlock = 16384;
  const std::size_t n = particles.size();
  std::vector<float> fastest((n + kBlock - 1) / kBlock, 0.0F);
  parallel_blocks(n, kBlock, [&](std::size_t begin, std::size_t end) {
    float most = 0;
    for (std::size_t p = begin; p < end; ++p) {
      const float square = particles.velocity[p].squaredNorm();
      // The comparison this way round also takes what is not a number.
      if (!(square <= most)) most = square;
      if (!(most < 1e30F)) break;
    }
    fastest[begin / kBlock] = most;
  });
  float most = 0;
  for (const float f : fastest) {
    if (!(f < 1e30F)) {
      throw Error("a velocity is no longer finite", "time " + std::to_string(time) + " s",
                  "shorter substeps (cfl), a more accurate pressure, slower solids and sources");
    }
    most = std::max(most, f);
  }
  return std::sqrt(static_cast<double>(most));
}

double fastest_point(const PlacedSolid& solid) {
  const double linear = solid.linear.norm(), angular = solid.angular.norm();
  if (angular == 0) return linear;
  const Eigen::AlignedBox3d box = solid.distance->bounds();
  const Eigen::Vector3d centre = solid.placement.inverse() * solid.centre;
  const Eigen::Vector3d reach =
      (box.max() - centre).cwiseAbs().cwiseMax((box.min() - centre).cwiseAbs());
  return linear + angular * reach.norm();
}

}  // namespace geoprior::fluid
