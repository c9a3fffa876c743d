#pragma once

#include "core/options.h"

namespace geoprior::fluid {

enum class SurfaceKernel { zhu_bridson, anisotropic };

struct LiquidSurfaceOptions {
  SurfaceKernel kernel = SurfaceKernel::zhu_bridson;
  double cells_per_cell = 1;     ///< resolution of the surface's grid relative to the simulation's
  double particle_radius = 0.5;  ///< r_p in cells of the simulation
  double kernel_radius = 4;      ///< R = this times r_p (Zhu and Bridson)
  int smoothing = 1;             ///< passes of smoothing of the field
};
void describe(OptionVisitor& v, LiquidSurfaceOptions& options);

}  // namespace geoprior::fluid
