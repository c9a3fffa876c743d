#pragma once

#include <memory>

#include "core/method.h"
#include "core/options.h"
#include "models/torus/input.h"

namespace geoprior::torus {

struct RevolutionOptions {};
void describe(OptionVisitor& v, RevolutionOptions& options);

/// The torus of revolution, without any corrugation: smooth, and up to five times too short.
std::unique_ptr<Process> make_revolution_torus(const TorusInput& input, const RevolutionOptions&);

}  // namespace geoprior::torus
