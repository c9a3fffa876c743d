#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/options.h"

namespace geoprior::sketch {

/// Part of a border in the picture, from a known ruling on.
struct BorderRun {
  std::vector<Eigen::Vector2d> points;
  std::vector<Eigen::Vector2d> tangents;  ///< unit, in the direction of the run; smoothed
};

/// Which of two runs need not be used up.
enum class WarpEnd { both_end, second_open, first_open };

struct RulingWarpOptions {
  double collinearity = 0.1;
  double smoothness = 1e-3;  ///< of the map between the runs, in its refinement (rad^2)
};
void describe(OptionVisitor& v, RulingWarpOptions& options);

/// Rulings between two runs, from the drawn one on.
struct RulingPath {
  /// Nodes of first and second run that are joined, in monotone order, from (0, 0).
  std::vector<std::array<int, 2>> cells;
  /// For node i of the first run, the place on the second, between nodes; rising with i. As many as
  /// the nodes of the first run that the path reaches.
  std::vector<double> image;
};

/// Rulings by time warping (thesis 2.1.3; Keogh and Pazzani 2001): the monotone path of steps
/// (1, 0), (0, 1), (1, 1) through pairs (i, j) that minimises the sum over its steps of
///
///     (steps) (angle at C1(i) - angle at C2(j))^2 + collinearity angle(r_ij, r_before)^2,
///
/// where r_ij = C2(j) - C1(i), the angles are those between r and the tangents, and a diagonal step
/// counts as two. The cost of a step depends on the two pairs that it joins and on nothing before,
/// so that the pair alone is the state of the dynamic program. Rulings do not cross on the borders:
/// the path is monotone.
///
/// The path is then refined between nodes by Gauss-Newton on the difference of the end angles with
/// a smooth map (second differences), since one node more or less turns a ruling by spacing over
/// length, a degree or two.
///
/// @param end  with an open run, the path ends where the mean cost of a step is least, once the
///             other run is used up
/// @throws Error  when a run has less than two nodes
RulingPath warp_rulings(const BorderRun& first, const BorderRun& second, WarpEnd end,
                        const RulingWarpOptions& options);

}  // namespace geoprior::sketch
