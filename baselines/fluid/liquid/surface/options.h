#pragma once

#include "core/options.h"

namespace geoprior::fluid {

enum class SurfaceKernel { zhu_bridson, anisotropic };

/// Source of r_p and R: Zhu and Bridson 2005.
struct LiquidSurfaceOptions {
  SurfaceKernel kernel = SurfaceKernel::zhu_bridson;
  double cells_per_cell = 1;
  double particle_radius = 0.5;
  double kernel_radius = 4;
  int smoothing = 1;
};
void describe(OptionVisitor& v, LiquidSurfaceOptions& options);

}  // namespace geoprior::fluid
