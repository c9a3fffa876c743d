#pragma once

#include <string>
#include <vector>

#include "solvers/sketch/drawing/curve_net.h"
#include "solvers/sketch/surface/ruled_patches.h"

namespace geoprior::sketch {

/// A panel without rulings: a closed loop of borders.
struct DrawnPanel {
  std::string name;
  std::vector<int> loop;  ///< nodes in order, the first not repeated
  bool flat = false;      ///< its border lies in a plane
};

/// Panels that borders name. The rule:
///
/// 1. The name of a border says to which panels it belongs, several joined by '+'
///    ("roof + gable"). A border without a name belongs to none.
/// 2. A name that both borders of a ruled patch carry is that patch; the rulings fill it.
/// 3. The borders of every other name form one closed loop: one closed border, or borders that meet
///    end to end in junctions, two in each.
/// 4. It is flat when all its borders are straight, or when its name begins with "flat"; otherwise
///    it is filled by a fair patch, whose border needs depth from elsewhere.
///
/// @param skip_open  leaves out the panels whose borders do not form a loop
/// @throws Error  when the borders of a name do not form a loop (names the stroke at its open end)
std::vector<DrawnPanel> find_drawn_panels(const CurveNet& net, const std::vector<RuledPatch>& ruled,
                                          bool skip_open = false);

}  // namespace geoprior::sketch
