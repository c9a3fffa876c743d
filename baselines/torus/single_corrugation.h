#pragma once

#include <memory>

#include "core/method.h"
#include "core/options.h"
#include "models/torus/input.h"

namespace geoprior::torus {

struct SingleCorrugationOptions {
  int number = 12;
  double amplitude = 0.01;
};
void describe(OptionVisitor& v, SingleCorrugationOptions& options);

/// One wave along the tube, of the amplitude that all corrugations have together: what a bump map
/// of a sine gives. It lengthens one direction and leaves the other as it was.
///   f = torus + a sqrt(2) cos(2 pi N x) n
std::unique_ptr<Process> make_single_corrugation(const TorusInput& input,
                                                 const SingleCorrugationOptions& options);

}  // namespace geoprior::torus
