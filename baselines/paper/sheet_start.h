#pragma once

#include <Eigen/Core>
#include <optional>

#include "baselines/paper/sheet.h"

namespace geoprior {

/// A pattern point whose place on the flat start, without imperfection, has a signed distance below
/// `distance` (m; negative is inside) to the obstacle at t = 0; absent when there is none, but for
/// spots narrower than a 512th of the pattern.
std::optional<Eigen::Vector2d> start_nearer_than(const Sheet& sheet, const Obstacle& obstacle,
                                                 double distance);

}  // namespace geoprior
