#pragma once

#include "baselines/fluid/liquid/grid/mac_grid.h"

namespace geoprior::fluid {

/// The density of particles (ParticleToGrid: 1 in full liquid) says where the liquid is and where
/// its particles stand too close. Numbers sit at cell centres.
///
/// A trilinear kernel beside a flat surface along the grid counts
///   rho = (1 - s)^2 / 2 outside, 1 - (1 + s)^2 / 2 inside,   s = distance / h in [-1, 1],
/// whatever the jitter of the particles. That is solved for s: the surface is where half of the
/// kernel is full, so that the liquid of the pressure has the volume of its particles; distances
/// to the nearest particle put it too high by the radius they are given. Drops and sheets thinner
/// than about half a cell count as air and fall freely.

/// Density that full liquid would have beside solids: the part of the kernel that is free. Near
/// walls of the domain it is 1 (the transfer folds the kernel there).
ScalarGrid rest_density(const SolidFractions& solids, const GridShape& shape);

/// Distance to the surface (m), within one cell of it; ±h beyond. A cell with liquid on at least
/// five sides (walls count) is liquid: a hole between particles is no bubble.
/// @param rest  or null: 1 everywhere
void liquid_distance(const ScalarGrid& density, const ScalarGrid* rest, const GridShape& shape,
                     ScalarGrid& distance);

/// Divergence of a displacement that brings the density back (1): `strength` times the deviation,
/// bounded by ±`bound`. A lack of particles counts only in cells whose 26 neighbours are liquid:
/// elsewhere it may be the surface.
/// Source: Kugelstadt et al. 2019 (positions corrected, momentum untouched); the clamp is ours.
void density_target(const ScalarGrid& density, const ScalarGrid* rest, const ScalarGrid& distance,
                    double strength, double bound, ScalarGrid& target);

/// Volume of the liquid that a distance describes: cells count by the fraction of them on the
/// liquid side of a plane at that distance (m^3).
double liquid_volume(const ScalarGrid& distance, const GridShape& shape);

}  // namespace geoprior::fluid
