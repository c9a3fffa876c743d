#include <array>
#include <string_view>

#include "baselines/fluid/liquid.h"

namespace geoprior {
namespace {

constexpr std::array<std::string_view, 3> kTransferNames{"pic", "flip", "apic"};
constexpr std::array<std::string_view, 2> kCorrectionNames{"none", "density"};

}  // namespace

void describe(OptionVisitor& v, LiquidOptions& o) {
  describe_choice(v, "transfer", o.transfer, kTransferNames,
                  {.doc = "what particles take from the grid: velocity, its change, or velocity "
                          "and gradient"});
  v.value("pic_fraction", o.pic_fraction,
          {.doc = "share of PIC in the FLIP update", .min = 0, .max = 1});
  v.value("particles_per_cell", o.particles_per_cell,
          {.doc = "of full cells at the start", .min = 1, .max = 64});
  v.value("cfl", o.cfl,
          {.doc = "cells that the fastest particle may cross in a substep", .min = 0.1, .max = 20});
  v.value("max_substeps", o.max_substeps,
          {.doc = "of a frame; a frame that needs more ends the run", .min = 1, .max = 1e6});
  describe_choice(v, "volume_correction", o.volume_correction, kCorrectionNames,
                  {.doc = "move particles so that their density stays even"});
  v.value(
      "volume_rate", o.volume_rate,
      {.doc = "rate at which deviations of density decay", .unit = "1/s", .min = 0, .max = 1e4});
  v.value("reseed", o.reseed, {.doc = "keep 3 to 2 x particles_per_cell particles in a full cell"});
  describe_group(v, "pressure", o.pressure, {.doc = "the projection"});
  describe_group(v, "surface", o.surface, {.doc = "the surface that is recorded"});
  v.value("record_particles", o.record_particles, {.doc = "part \"particles\" of a frame"});
}

}  // namespace geoprior
