#pragma once

#include <memory>

#include "core/options.h"
#include "models/details/process.h"

namespace geoprior::details {

/// Naive stretch: details go where the surface goes, none comes, none leaves. What every other
/// method is compared with: nothing pops, and the spacing follows the stretch (a factor s along one
/// axis multiplies the edges along it by s).
struct NaiveStretchOptions {
  LengthRule lengths = LengthRule::chord;
};
void describe(OptionVisitor& v, NaiveStretchOptions& options);

/// The method frame by frame. Phase inside a step: "move". Diagnostics: flips.
std::unique_ptr<DetailMethod> make_naive_stretch(const DetailScene& scene,
                                                 const NaiveStretchOptions& options);

/// The method as a process: `make_detail_process` around it.
std::unique_ptr<Process> make_naive_stretch_process(const DetailScene& scene,
                                                    const NaiveStretchOptions& options);

}  // namespace geoprior::details
