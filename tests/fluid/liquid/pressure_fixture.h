#pragma once

#include <Eigen/Sparse>
#include <cmath>
#include <functional>
#include <vector>

#include "baselines/fluid/liquid/pressure/pressure.h"
#include "baselines/fluid/liquid/pressure/solid_fractions.h"

namespace geoprior::fluid::pressure_test {

inline GridShape shape_of(const Tank& tank) { return {tank.cells, tank.origin, tank.cell}; }

/// Solids of a tank at a time, ready to be sampled.
struct Bodies {
  std::vector<ShapeDistance> distances;
  std::vector<PlacedSolid> placed;
  explicit Bodies(const Tank& tank, double time = 0, double dt = 1e-3) {
    for (const TankSolid& solid : tank.solids) distances.emplace_back(solid.shape, tank.cell);
    for (std::size_t s = 0; s < tank.solids.size(); ++s)
      placed.push_back(place_solid(tank.solids[s], distances[s], time, dt));
  }
};

inline SolidFractions fractions_of(const Tank& tank, double time = 0, double dt = 1e-3) {
  const Bodies bodies(tank, time, dt);
  SolidFractions result;
  solid_fractions(tank, bodies.placed, shape_of(tank), result);
  return result;
}

/// Values at cell centres.
inline ScalarGrid at_centres(const GridShape& shape,
                             const std::function<double(const Eigen::Vector3d&)>& f) {
  ScalarGrid result(shape.cells, 0);
  for (int k = 0; k < shape.cells.z(); ++k)
    for (int j = 0; j < shape.cells.y(); ++j)
      for (int i = 0; i < shape.cells.x(); ++i)
        result(i, j, k) = static_cast<float>(f(shape.cell_centre(i, j, k)));
  return result;
}

/// Largest |component| on faces marked valid (m/s).
inline double largest_speed(const MacGrid& velocity,
                            const std::array<std::vector<char>, 3>& valid) {
  double largest = 0;
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t f = 0; f < valid[a].size(); ++f)
      if (valid[a][f])
        largest = std::max(largest, std::abs(static_cast<double>(velocity.face[a].values[f])));
  return largest;
}

/// Adds an acceleration to all faces for dt.
inline void push(MacGrid& velocity, const Eigen::Vector3d& acceleration, double dt) {
  for (int a = 0; a < 3; ++a)
    for (float& u : velocity.face[a].values) u += static_cast<float>(dt * acceleration[a]);
}

}  // namespace geoprior::fluid::pressure_test
