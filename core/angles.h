#pragma once

#include <numbers>

namespace geoprior {

/// Radians.
inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr double kFullTurn = 2 * std::numbers::pi;

}  // namespace geoprior
