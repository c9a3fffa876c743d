#pragma once

#include <array>
#include <vector>

#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/drawing/curve_net.h"

namespace geoprior::sketch {

/// How far from borders the ends of rulings may lie, which are drawn onto them by hand (m).
double reach_of_rulings(const CurveNet& net);

/// The two different borders on which the ends of a stroke lie within reach, with the least sum of
/// distances: one that is nearest to both ends belongs to one of them.
/// @param from_first   distance of each border from the first end; `from_second` of the second
/// @return without two such borders the nearest one for each end, -1 for none within reach
std::array<int, 2> two_borders(const std::vector<double>& from_first,
                               const std::vector<double>& from_second, double reach);

/// Places of the two ends of a ruling on two different borders of the panel that it names, or of
/// any, with the least sum of distances.
/// @return a place without a curve for an end that lies on no border; two places on one curve when
///         there is no other border for either end
std::array<CurvePoint, 2> ruling_ends(const CurveNet& net, const Stroke& ruling);

}  // namespace geoprior::sketch
