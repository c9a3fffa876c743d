#pragma once

#include <array>
#include <vector>

#include "baselines/fluid/liquid/grid/mac_grid.h"
#include "baselines/fluid/liquid/particles/particles.h"

namespace geoprior::fluid {

/// Particles to grid and back with the trilinear kernel N, at faces clamped to the domain so that
/// the weights of a particle always sum to 1:
///   grid       m_i = sum_p N_i(x_p),  m_i u_i = sum_p N_i(x_p) (v_p + C_p (x_i - x_p))
///   particles  PIC v_p = sum_i N_i u_i;  FLIP v_p = (1 - a) (v_p + sum_i N_i du_i) + a sum_i N_i
///   u_i;
///              APIC v_p as PIC and C_p = sum_i u_i grad N_i(x_p)
/// PIC and APIC keep the momentum of the particles, APIC the angular momentum too (away from
/// walls). Sources: Harlow 1964; Zhu and Bridson 2005; Jiang et al. 2015.
class ParticleToGrid {
 public:
  explicit ParticleToGrid(const GridShape& shape);

  /// @param particles  sorted by cell; with `affine` the sums of APIC
  /// @param velocity  0 where no particle is near (m/s)
  /// @param touched  1 on faces that a particle reaches, else 0
  /// @param density  at cell centres: kernel sums over particles_per_cell, 1 in full liquid
  ///
  /// Tiles of rows write to the grid in four colours, so that no two at work are neighbours: no
  /// atomic sums, and an order that no thread count changes.
  void gather(const LiquidParticles& particles, int particles_per_cell, MacGrid& velocity,
              std::array<std::vector<char>, 3>& touched, ScalarGrid& density);

 private:
  GridShape shape_;
  std::array<std::vector<float>, 3> sums_;  ///< momentum and weight of a face side by side
};

/// v_p = keep * v_p + sum_i N_i(x_p) field_i: one field serves PIC (u, keep 0) and FLIP
/// ((1 - a) du + a u, keep 1 - a). With `affine` C_p = sum_i field_i grad N_i(x_p) as well.
void grid_to_particles(const MacGrid& field, float keep, bool affine, LiquidParticles& particles);

/// Kinetic energy of particles of unit mass (m^2/s^2): sum of v^2 / 2 and, with velocity gradients,
/// of what these carry to the grid, (1/2) sum_i N_i (C (x_i - x_p))^2.
double kinetic_energy(const GridShape& shape, const LiquidParticles& particles);

}  // namespace geoprior::fluid
