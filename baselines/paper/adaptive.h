#pragma once

#include <memory>

#include "baselines/paper/sheet_process.h"

namespace geoprior {

/// Baseline: anisotropic adaptive remeshing in the pattern (Narain, Samii, O'Brien 2012; Narain,
/// Pfaff, O'Brien 2013).
struct AdaptiveOptions {
  double size_min = 0.01;            ///< smallest edge length asked for (m)
  double size_max = 0.2;             ///< largest (m)
  double refine_angle = 0.3;         ///< change of normal along an edge (rad)
  double refine_compression = 5e-3;  ///< compressive strain along an edge
  double refine_velocity = 0.5;      ///< difference of velocity along an edge (m/s)
  double aspect_min = 0.1;           ///< smallest ratio of the two sizes at a vertex
  bool pop_filter = false;           ///< relaxes new vertices after remeshing
  StepperOptions stepper;
};
void describe(OptionVisitor& v, AdaptiveOptions& options);

std::unique_ptr<Process> make_adaptive_sheet(const Sheet& sheet, const AdaptiveOptions& options);

}  // namespace geoprior
