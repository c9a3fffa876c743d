#pragma once

#include <cstdint>
#include <span>

#include "baselines/fluid/liquid/grid/mac_grid.h"
#include "baselines/fluid/liquid/particles/particles.h"
#include "baselines/fluid/liquid/tank/tank.h"

namespace geoprior::fluid {

/// Where and how particles are put into cells.
struct SeedRule {
  int particles_per_cell = 8;
  std::uint64_t seed = 1;
  /// Number of the step: random numbers depend on seed, cell and step, not on what came before.
  std::uint64_t step = 0;
  bool affine = false;  ///< particles carry a velocity gradient (0 at first)
};

/// Fills a shape with jittered particles: a cell is cut into n^3 boxes, n^3 >= particles_per_cell;
/// as many boxes as particles, chosen at random when there are more, get one each. Particles
/// outside the shape, the domain or in a solid are left out.
/// @param solids  distances at nodes, or null
/// @param only_empty  skips cells that hold particles, which must be sorted by cell
/// @return  number of particles appended
std::size_t fill_shape(const GridShape& shape, const ShapeDistance& body,
                       const Eigen::Vector3d& velocity, const ScalarGrid* solids, bool only_empty,
                       const SeedRule& rule, LiquidParticles& particles);

/// Gives particles inside a shape its velocity: liquid of a source comes out at that speed.
void set_velocity_inside(const GridShape& shape, const ShapeDistance& body,
                         const Eigen::Vector3d& velocity, LiquidParticles& particles);

/// Keeps the number of particles in full cells between 3 and twice particles_per_cell: removes the
/// surplus, adds particles with the grid's velocity to sparse cells that liquid surrounds.
/// Particles must be sorted; afterwards they are not when true is returned.
///
/// Particles are volume, so what was added and removed must come to nothing: while more were added,
/// cells are thinned sooner, while more were removed, filled sooner.
/// @param distance  of the liquid at cell centres (m)
/// @param balance  particles added minus removed since the start
bool reseed(const MacGrid& velocity, const ScalarGrid& distance, const SeedRule& rule,
            std::int64_t& balance, LiquidParticles& particles);

}  // namespace geoprior::fluid
