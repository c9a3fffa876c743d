#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/frame.h"

namespace geoprior::sketch {

/// The two sides of every sewn stretch of a frame's pattern, as polylines in the plane whose i-th
/// points are sewn together (m): each pair once, in the order of the stretches.
///
/// @throws Error  naming what the frame lacks: table "sewn", part "pattern"
std::vector<std::array<Eigen::MatrixX2d, 2>> sewn_lines(const Frame& frame);

}  // namespace geoprior::sketch
