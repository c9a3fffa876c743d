#include <iomanip>
#include <sstream>

#include "baselines/torus/integration/integration.h"
#include "baselines/torus/random_bumps.h"
#include "baselines/torus/revolution.h"
#include "baselines/torus/single_corrugation.h"
#include "experiments/torus/scene/scene.h"
#include "experiments/torus/topic.h"
#include "models/torus/sampling.h"
#include "solvers/torus/exact/exact.h"
#include "solvers/torus/grid/grid.h"

namespace geoprior::torus {

namespace {

/// Points a period that a grid needs, so that its differences of fourth order are those of the
/// surface within a percent.
constexpr int kPointsPerPeriod = 16;

/// A warning where a grid of n x n points is too coarse for the finest corrugation.
std::vector<std::string> grid_warnings(const TorusScene& scene, int n) {
  const int count = static_cast<int>(scene.input.corrugations.size());
  const double periods = finest_periods(scene.input, count);
  if (count == 0 || n >= kPointsPerPeriod * periods) return {};
  std::ostringstream text;
  text << "a grid of " << n << " points has " << std::setprecision(3) << n / periods
       << " a period of the finest corrugation: what it says of the metric is not that of the "
          "surface (needed: "
       << std::setprecision(12) << kPointsPerPeriod * periods << " points)";
  return {text.str()};
}

template <class Options>
MethodEntry on_grid(MethodEntry entry) {
  return with_warnings<TorusScene, Options>(std::move(entry),
                                            [](const TorusScene& scene, const Options& options) {
                                              return grid_warnings(scene, options.points);
                                            });
}

}  // namespace

std::vector<MethodEntry> methods() {
  using S = TorusScene;
  return {
      method_entry<S, ExactOptions>(
          "exact", false, "corrugations point by point: Taylor polynomials, no grid, any depth",
          "thesis 4; Borrelli et al. 2012; Theillière 2022",
          [](const S& scene, const ExactOptions& options, RunContext&) {
            return make_exact_torus(scene.input, options);
          }),
      on_grid<GridOptions>(method_entry<S, GridOptions>(
          "grid", false, "corrugations on a grid, whose derivatives are differences",
          "thesis 4; Borrelli et al. 2012; Theillière 2022",
          [](const S& scene, const GridOptions& options, RunContext&) {
            return make_grid_torus(scene.input, options);
          })),
      on_grid<IntegrationOptions>(method_entry<S, IntegrationOptions>(
          "integration", true, "convex integration along integral curves, glued and resampled",
          "thesis 4; Borrelli et al. 2012",
          [](const S& scene, const IntegrationOptions& options, RunContext&) {
            return make_integration_torus(scene.input, options);
          })),
      method_entry<S, RevolutionOptions>(
          "revolution", true, "the torus of revolution, without corrugations", "closed form",
          [](const S& scene, const RevolutionOptions& options, RunContext&) {
            return make_revolution_torus(scene.input, options);
          }),
      method_entry<S, SingleCorrugationOptions>(
          "single-corrugation", true, "one wave around the tube, of the amplitude of all of them",
          "a bump map of a sine",
          [](const S& scene, const SingleCorrugationOptions& options, RunContext&) {
            return make_single_corrugation(scene.input, options);
          }),
      method_entry<S, RandomBumpsOptions>(
          "random-bumps", true, "a random bump map of the amplitude of all corrugations",
          "waves of random direction and phase",
          [](const S& scene, const RandomBumpsOptions& options, RunContext&) {
            return make_random_bumps(scene.input, options);
          }),
  };
}

std::vector<DiagnosticEntry> diagnostics() {
  DiagnosticTable table;
  table.measured("default_mean",
                 {"tangent_default", "1",
                  "mean of |Id - f* < , >| at the windows, from the method's own derivatives"});
  return table.rows();
}

}  // namespace geoprior::torus
