#pragma once

#include <span>

#include "baselines/fluid/mac_grid.h"
#include "baselines/fluid/particles.h"
#include "core/mesh.h"
#include "core/options.h"

namespace geoprior {

enum class SurfaceKernel { zhu_bridson, anisotropic };

struct LiquidSurfaceOptions {
  SurfaceKernel kernel = SurfaceKernel::zhu_bridson;
  double cells_per_cell = 1;     ///< resolution of the surface's grid relative to the simulation's
  double particle_radius = 0.5;  ///< r_p in cells of the simulation
  double kernel_radius = 4;      ///< R = this times r_p (Zhu and Bridson)
  int smoothing = 1;             ///< passes of smoothing of the field
};
void describe(OptionVisitor& v, LiquidSurfaceOptions& options);

/// Signed distance like field of the particles at the nodes of a grid, negative in the liquid.
/// Sources: Zhu and Bridson 2005 with the concavity fix of Solenthaler et al. 2007; Yu and Turk
/// 2013 (anisotropic).
ScalarGrid liquid_field(const GridShape& shape, const LiquidParticles& particles,
                        const LiquidSurfaceOptions& options, GridShape& field_shape);

/// Level set 0 of a field at grid nodes as a closed, outward oriented 2-manifold (marching cubes
/// whose table separates the ambiguous faces alike from both sides). The field's border counts as
/// outside, so that the surface is closed there too. Vertices in a fixed order for any thread
/// count.
/// @param origin, cell  of node (0, 0, 0) and between nodes (m)
TriMesh isosurface(const ScalarGrid& nodes, const Eigen::Vector3d& origin, double cell);

/// Velocity at points, trilinear from the (extrapolated) grid (m/s).
Eigen::MatrixX3d surface_velocity(const MacGrid& velocity, const Eigen::MatrixX3d& points);

}  // namespace geoprior
