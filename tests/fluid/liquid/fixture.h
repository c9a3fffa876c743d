#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "baselines/fluid/liquid/liquid.h"
#include "core/random.h"

namespace geoprior::fluid::tanks {

inline LiquidShape box_between(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  LiquidShape shape;
  shape.kind = LiquidShape::Kind::box;
  shape.centre = 0.5 * (low + high);
  shape.half_size = 0.5 * (high - low);
  return shape;
}

inline LiquidShape ball(const Eigen::Vector3d& centre, double radius) {
  LiquidShape shape;
  shape.kind = LiquidShape::Kind::sphere;
  shape.centre = centre;
  shape.radius = radius;
  return shape;
}

inline LiquidVolume at_rest(const LiquidShape& shape) {
  LiquidVolume volume;
  volume.name = "liquid";
  volume.shape = shape;
  return volume;
}

inline Tank tank_of(const Eigen::Vector3i& cells, double cell) {
  Tank tank;
  tank.cells = cells;
  tank.cell = cell;
  return tank;
}

inline GridShape grid_of(const Eigen::Vector3i& cells, double cell) {
  GridShape shape;
  shape.cells = cells;
  shape.cell = cell;
  return shape;
}

/// A column of a third of a unit tank, half as high as the tank.
inline Tank column_tank(int n) {
  Tank tank = tank_of({n, n / 2, n}, 1.0 / n);
  tank.volumes.push_back(at_rest(box_between({0, 0, 0}, {1.0 / 3, 0.5, 0.5})));
  return tank;
}

/// Particles anywhere between two corners.
inline LiquidParticles scattered(int count, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                                 std::uint64_t seed) {
  RandomStream random(seed, "particles");
  LiquidParticles particles;
  for (int p = 0; p < count; ++p) {
    Eigen::Vector3d x, v;
    for (int a = 0; a < 3; ++a) {
      x[a] = low[a] + (high[a] - low[a]) * random.uniform();
      v[a] = random.normal();
    }
    particles.position.push_back(x.cast<float>());
    particles.velocity.push_back(v.cast<float>());
  }
  return particles;
}

inline Eigen::Vector3d momentum(const LiquidParticles& particles) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& v : particles.velocity) sum += v.cast<double>();
  return sum;
}

inline Eigen::Vector3d centre_of(const LiquidParticles& particles) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& x : particles.position) sum += x.cast<double>();
  return sum / static_cast<double>(particles.size());
}

/// Steps up to a time.
inline void run_until(Liquid& liquid, double until, double dt_most = 1.0 / 30) {
  RunContext context;
  while (until - liquid.time() > 1e-9)
    liquid.step(std::min(dt_most, until - liquid.time()), context);
}

}  // namespace geoprior::fluid::tanks
