#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior {

/// How poly-lines lie to a closed one in plan.
struct PlanDistance {
  double to_target = 0;    ///< m: mean over the lines of the distance to the closed line
  double from_target = 0;  ///< m: mean over the closed line of the distance to the lines
};

/// Means over length, by points at most `spacing` apart; distances are to the lines themselves.
/// @throws Error  without lines, with fewer than three corners
PlanDistance plan_distance(const std::vector<std::vector<Eigen::Vector2d>>& lines,
                           const std::vector<Eigen::Vector2d>& corners, double spacing);

/// Share of the points of a square lattice inside a polygon that are within `reach` of a line.
/// @throws Error  as above, and where no point of the lattice is inside
double plan_fill(const std::vector<std::vector<Eigen::Vector2d>>& lines,
                 const std::vector<Eigen::Vector2d>& corners, double spacing, double reach);

}  // namespace geoprior
