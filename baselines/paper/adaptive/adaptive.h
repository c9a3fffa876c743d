#pragma once

#include <memory>

#include "baselines/paper/adaptive/sizing_options.h"
#include "models/paper/sheet/process.h"
#include "models/paper/sheet/settle.h"
#include "models/paper/tear/growth.h"

namespace geoprior::paper {

/// Baseline: anisotropic adaptive remeshing in the pattern (Narain, Samii, O'Brien 2012; Narain,
/// Pfaff, O'Brien 2013): docs of the parts in sizing.h, remesh.h and pop_filter.h. After a change
/// the sheet settles (models/paper/sheet/settle.h): a split puts a vertex on the chord of a bend,
/// where it is too short.
struct AdaptiveOptions : SizingOptions {
  bool pop_filter = false;  ///< relaxes what remeshing changed (pop_filter.h)
  SettleOptions settle;
  TearOptions tearing;
  StepperOptions stepper;
};
void describe(OptionVisitor& v, AdaptiveOptions& options);

std::unique_ptr<Process> make_adaptive_sheet(const Sheet& sheet, const AdaptiveOptions& options);

}  // namespace geoprior::paper
