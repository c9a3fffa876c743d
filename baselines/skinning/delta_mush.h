#pragma once

#include <Eigen/Core>

#include "baselines/skinning/linear_blend.h"
#include "core/options.h"
#include "core/rig.h"

namespace geoprior {

struct DeltaMushOptions {
  int iterations = 20;  ///< smoothing passes, at rest and posed alike
  double step = 0.5;    ///< move towards the mean of the neighbours in one pass
};
void describe(OptionVisitor& v, DeltaMushOptions& options);

/// Delta mush (Mancewicz et al. 2014).
class DeltaMush {
 public:
  DeltaMush(const RiggedMesh& rig, const DeltaMushOptions& options);
  void deform(const Pose& pose, Eigen::MatrixX3d& posed);
};

}  // namespace geoprior
