#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "baselines/fluid/liquid/grid/mac_grid.h"

namespace geoprior::fluid {

/// Continues a velocity beyond the faces where it is known: layer by layer, a face beside known
/// ones gets their mean (of those of the six neighbours in its component's grid).
/// Source: Bridson, Fluid Simulation, 2015, ch. 7 (a breadth-first sweep).
class Extrapolator {
 public:
  /// @param known  1 where the velocity is given; set to 1 where it was continued
  void extrapolate(int layers, MacGrid& velocity, std::array<std::vector<char>, 3>& known);

 private:
  struct Component {
    std::vector<std::uint32_t> front, next;
    std::vector<float> values;
  };
  std::array<Component, 3> component_;
};

/// Makes the velocity on closed faces that of a solid's surface: the part normal to the solid is
/// the solid's, the rest stays (free slip).
/// @param known  faces whose velocity is used at all; others stay as they are
void constrain_to_solids(const SolidFractions& solids,
                         const std::array<std::vector<char>, 3>& known, MacGrid& velocity);

}  // namespace geoprior::fluid
