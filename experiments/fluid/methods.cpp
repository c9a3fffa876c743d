#include "baselines/fluid/liquid.h"
#include "baselines/fluid/ocean.h"
#include "experiments/fluid/scene.h"
#include "experiments/fluid/topic.h"
#include "solvers/fluid/sculpting.h"

namespace geoprior {

std::vector<MethodEntry> fluid_methods() {
  using S = FluidScene;
  return {
      method_entry<S, LiquidOptions>(
          "liquid", true,
          "full simulation: particles in cells (PIC, FLIP, APIC) with a free surface",
          "Zhu and Bridson 2005; Batty, Bertails and Bridson 2007; Jiang et al. 2015",
          [](const S& scene, const LiquidOptions& options, RunContext&) {
            const Tank& tank = scene.require_tank("the method 'liquid'");
            require_valid(tank, options.particles_per_cell, simulation_memory_limit(),
                          "scene.tank");
            return make_liquid(tank, options);
          }),
      method_entry<S, OceanOptions>(
          "ocean", true, "procedural ocean: waves of a wind spectrum by Fourier synthesis",
          "Tessendorf 2004; Horvath 2015",
          [](const S& scene, const OceanOptions& options, RunContext&) {
            return make_ocean(options, scene.sculpt.times);
          }),
      method_entry<S, ExtractOptions>(
          "extract", false, "finds the space-time features of an animation and tracks them",
          "thesis 3.3.1; Manteaux et al. 2016",
          [](const S& scene, const ExtractOptions& options, RunContext&) {
            return make_extract(scene.sculpt, options);
          }),
      method_entry<S, SculptOptions>(
          "sculpt", false,
          "lifts features out of animations, edits them, pastes them into a target",
          "thesis 3.3.2; Manteaux et al. 2016",
          [](const S& scene, const SculptOptions& options, RunContext&) {
            return make_sculpt(scene.sculpt, options);
          }),
  };
}

}  // namespace geoprior
