#pragma once

#include <memory>
#include <vector>

#include "baselines/fluid/liquid/pressure/system.h"

namespace geoprior::fluid {

/// z = M r with M symmetric positive definite and near the inverse of the system.
class PressureApproximation {
 public:
  virtual ~PressureApproximation() = default;
  /// Takes a system that outlives the calls of `apply`; keeps its memory for the next one.
  virtual void build(const PressureSystem& system) = 0;
  virtual void apply(const std::vector<double>& r, std::vector<double>& z) = 0;
};

}  // namespace geoprior::fluid
