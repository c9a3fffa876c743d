#pragma once

#include <numbers>

namespace geoprior {

/// A degree and a turn in radians. x * kDegree and x * pi / 180 may differ in the last bit: code
/// that has been written the second way keeps it, so that its results stay.
inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr double kFullTurn = 2 * std::numbers::pi;

}  // namespace geoprior
