#pragma once

#include "core/options.h"
#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

/// A chain of joints, each with a rigid part from it to the next.
struct ArmOptions {
  int joints = 4;
  double length = 0.3;  ///< of a part (m)
};
void describe(OptionVisitor& v, ArmOptions& options);

/// Types "arm" (the root), "joint" (keys: its centre) and "part" (parameter length; keys: both ends
/// and two points beside them). Joints hang on one another, along x; a part hangs on its joint.
Hierarchy make_arm(const ArmOptions& options);

}  // namespace geoprior::grammar
