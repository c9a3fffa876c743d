#pragma once

#include "experiments/topic.h"

namespace geoprior {

/// Crumpled paper: simulations of a sheet that handles and obstacles deform (thesis 3.2).
Topic paper_topic();

/// The methods of the topic: experiments/paper/methods.cpp.
std::vector<MethodEntry> paper_methods();
/// What they alone can know of a frame.
std::vector<DiagnosticEntry> paper_diagnostics();

}  // namespace geoprior
