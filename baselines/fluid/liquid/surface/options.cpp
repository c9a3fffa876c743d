#include "baselines/fluid/liquid/surface/options.h"

#include <array>
#include <string_view>

namespace geoprior::fluid {

void describe(OptionVisitor& v, LiquidSurfaceOptions& options) {
  static constexpr std::array<std::string_view, 2> kKernels{"zhu-bridson", "anisotropic"};
  describe_choice(v, "kernel", options.kernel, kKernels, {.doc = "how particles become a field"});
  v.value(
      "cells_per_cell", options.cells_per_cell,
      {.doc = "cells of the surface's grid along a cell of the simulation", .min = 0.25, .max = 8});
  v.value("particle_radius", options.particle_radius,
          {.doc = "radius r_p of a particle in cells of the simulation", .min = 0.1, .max = 4});
  v.value("kernel_radius", options.kernel_radius,
          {.doc = "ratio of the kernel's radius R to r_p", .min = 1, .max = 16});
  v.value("smoothing", options.smoothing,
          {.doc = "passes that smooth the field", .min = 0, .max = 100});
}

}  // namespace geoprior::fluid
