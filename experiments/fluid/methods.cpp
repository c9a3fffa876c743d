#include <cmath>

#include "baselines/fluid/liquid/liquid.h"
#include "baselines/fluid/liquid/process.h"
#include "baselines/fluid/ocean/ocean.h"
#include "core/limits.h"
#include "experiments/fluid/scene/extract_files.h"
#include "experiments/fluid/scene/scene.h"
#include "experiments/fluid/topic.h"
#include "solvers/fluid/extract.h"
#include "solvers/fluid/sculpt.h"

namespace geoprior::fluid {
namespace {

/// A node of the field whose contour is the surface: value, weights and a copy (B).
constexpr double kBytesPerNode = 16;

void require_surface_grid(const Tank& tank, const LiquidSurfaceOptions& options) {
  const double nodes = tank.cells.cast<double>().prod() * std::pow(options.cells_per_cell, 3);
  require_memory(nodes * kBytesPerNode, nodes, "nodes of the surface's grid",
                 "options.surface.cells_per_cell");
}

}  // namespace

std::vector<MethodEntry> methods() {
  using S = FluidScene;
  return {
      method_entry<S, LiquidOptions>(
          "liquid", true,
          "full simulation: particles in cells (PIC, FLIP, APIC) with a free surface",
          "Zhu and Bridson 2005; Batty, Bertails and Bridson 2007; Jiang et al. 2015",
          [](const S& scene, const LiquidOptions& options, RunContext&) {
            const Tank& tank = scene.require_tank("the method 'liquid'");
            require_valid(tank, options.particles_per_cell, memory_limit(), "scene.tank");
            require_surface_grid(tank, options.surface);
            return make_liquid(tank, options);
          }),
      method_entry<S, OceanOptions>(
          "ocean", true, "procedural ocean: waves of a wind spectrum by Fourier synthesis",
          "Tessendorf 2004; Horvath 2015",
          [](const S& scene, const OceanOptions& options, RunContext&) {
            require_vertices(vertices_of(options), "options.samples");
            return make_ocean(options, scene.sculpt.times);
          }),
      method_entry<S, StoredExtractOptions>(
          "extract", false,
          "finds the space-time features of an animation, tracks them and can store them",
          "thesis 3.3.1; Manteaux et al. 2016",
          [](const S& scene, const StoredExtractOptions& options, RunContext&) {
            return make_extract(scene.sculpt, options.extract, feature_files(options));
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

std::vector<DiagnosticEntry> diagnostics() {
  // Counts are exact on one machine; another compiler's round-off moves some of them.
  constexpr Tolerance kWork{0.1, 0.05};
  DiagnosticTable table;
  // Recorded by a simulation.
  table.unmeasured(
      "work of the solver, or of its cells and velocities, which are not recorded",
      {{"particles", "1", "particles of the liquid"},
       {"particle_volume", "m^3", "particles over particles_per_cell, in cells"},
       {"liquid_volume", "m^3", "volume of the liquid cells that the last substep projected"},
       {"substeps", "1", "time steps of the frame", true, kWork},
       {"cfl", "1", "cells that the fastest particle crossed in the longest of them"},
       {"pressure_iterations", "1",
        "iterations of the pressure solver, summed over the frame's substeps", true, kWork},
       {"pressure_converged", "1", "0 when a solve stopped at its largest number of iterations"},
       {"max_divergence", "1/s",
        "largest divergence of a liquid cell after a projection of the frame"},
       {"kinetic_energy", "J", "of the particles"},
       {"momentum_x", "kg m/s", "of the particles"},
       {"momentum_y", "kg m/s", "of the particles"},
       {"momentum_z", "kg m/s", "of the particles"}});
  table.measured("volume", {"surface_volume", "m^3", "volume that the recorded surface encloses"});
  table.measured("potential_energy",
                 {"potential_energy", "J", "of the particles above the origin"});
  // Recorded by an extraction.
  table.unmeasured(
      "what the method takes for features: metrics know them only where they are injected",
      {{"regions", "1", "regions of the frame"},
       {"tracks", "1", "features of the whole animation"},
       {"features", "1", "features that are there in the frame"},
       {"masked_share", "1", "share of the vertices that lie at walls and solids"}});
  // What an extraction has lifted, or a sculpting for its paste.
  table.unmeasured(
      "sizes of what the method keeps, which is not recorded",
      {{"lifted_features", "1", "features taken from their animations"},
       {"feature_bytes", "B", "memory that they take"},
       {"feature_file_bytes", "B", "files that they are stored in: the library, and pictures"},
       {"sequence_bytes", "B", "memory that positions and triangles of the animation take"}});
  // Recorded by an ocean and by a paste.
  table.unmeasured(
      "of the maps themselves: a surface does not say what moved it",
      {{"folded_triangles", "1", "triangles turned over by choppiness"},
       {"displaced_vertices", "1", "vertices of the result that a map moved"},
       {"added_volume", "m^3", "integral of the displacements along the normal"},
       {"min_jacobian", "1", "smallest det(I + grad d) of the maps: 0 or less where they fold"}});
  table.measured("triangles", {"added_triangles", "1", "triangles more than the target has"});
  table.unmeasured("of the target, which is another run",
                   {{"target_vertices", "1", "vertices of the target's frame"}});
  return table.rows();
}

}  // namespace geoprior::fluid
