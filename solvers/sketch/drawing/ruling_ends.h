#pragma once

#include <array>

#include "models/sketch/drawing/drawing.h"
#include "solvers/sketch/drawing/curve_net.h"

namespace geoprior::sketch {

/// How far from borders the ends of rulings may lie, which are drawn onto them by hand (m).
double reach_of_rulings(const CurveNet& net);

/// Places of the two ends of a ruling on two different borders of the panel that it names, or of
/// any, with the least sum of distances.
/// @return a place without a curve for an end that lies on no border; two places on one curve when
///         there is no other border for either end
std::array<CurvePoint, 2> ruling_ends(const CurveNet& net, const Stroke& ruling);

}  // namespace geoprior::sketch
