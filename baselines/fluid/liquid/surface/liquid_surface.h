#pragma once

#include <span>

#include "baselines/fluid/liquid/grid/mac_grid.h"
#include "baselines/fluid/liquid/particles/particles.h"
#include "baselines/fluid/liquid/surface/options.h"

namespace geoprior::fluid {

/// Signed distance like field of the particles at the nodes of a grid, negative in the liquid.
///
/// Zhu and Bridson: phi(x) = |x - xbar| - r_p with xbar the mean of the particles' places weighted
/// by (1 - |x - x_i|^2 / R^2)^3; r_p shrinks where the largest eigenvalue of grad xbar passes 0.4,
/// which removes the phantom liquid of concave places. Anisotropic: 1/2 - density, the density of
/// particles smeared by kernels stretched along the surface. The zero level is theirs; the values
/// beside it are mapped to what the distance to a flat surface would be (-R/2 … R), because fields
/// that level off inside draw a contour inwards.
///
/// Computed where both cells with and without particles are within the kernel's reach. On the walls
/// of the domain the field of the nodes beside them is repeated: the surface meets walls at a right
/// angle, and particles that keep off them leave no bumps.
/// @param particles  sorted by cell
/// @param field_shape  set to the grid of the field; it has cells + 1 nodes
/// Sources: Zhu and Bridson 2005 with the concavity fix of Solenthaler et al. 2007; Yu and Turk
/// 2013 (anisotropic).
ScalarGrid liquid_field(const GridShape& shape, const LiquidParticles& particles,
                        const LiquidSurfaceOptions& options, GridShape& field_shape);

/// Makes the liquid touch solids: within a cell of a solid the field takes the value one and a half
/// cells off it, along the normal, if that is more liquid; then what lies in the solid is cut away
/// (maximum with minus the distance).
/// @param solids  distances at nodes of the simulation's grid `shape`
void meet_solids(const GridShape& shape, const SolidFractions& solids, const GridShape& field_shape,
                 ScalarGrid& field);

/// Velocity at points, trilinear from the (extrapolated) grid (m/s).
Eigen::MatrixX3d surface_velocity(const MacGrid& velocity, const Eigen::MatrixX3d& points);

}  // namespace geoprior::fluid
