#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "solvers/paper/hybrid_options.h"
#include "solvers/paper/meshing/ruling_editor.h"
#include "solvers/paper/sheet/compression.h"

namespace geoprior::paper {

/// A candidate ruling (thesis 3.2.1, Figure 3.9): from a seed along d_perp both ways.
struct Candidate {
  Eigen::Vector2d seed;
  Eigen::Vector2d direction;  ///< unit
  RulingHit forward, backward;
  /// Where it crosses rulings of other pieces in the group's area, and those rulings: each crossing
  /// reached through triangles of the group, and the first behind them.
  std::vector<Eigen::Vector2d> crossings;
  std::vector<int> crossed;
};

/// True for pattern points in triangles of the group that candidates come from.
using GroupTest = std::function<bool(const Eigen::Vector2d&)>;

/// Candidates of a group: seeds `seeding_distance` apart on the line through the group's centre
/// along d, over the group's extent.
std::vector<Candidate> propagate_candidates(const DemandGroup& group, const GroupTest& in_group,
                                            const RulingEditor& editor,
                                            const HybridOptions& options);

/// What became of the groups of one frame.
struct PropagationReport {
  int new_rulings = 0;
  int new_singular_points = 0;
  bool changed = false;
};

/// Resolves a group's candidates: border to border adds rulings (of the neighbouring cylinder's
/// direction when the two differ by less than the merge angle); at a singular point, a ruling of
/// its cone; a crossing puts a singular point at random into the convex hull of the crossings, and
/// rulings around it (`add_singular_point`), or widens the cones of a singular point so near that
/// no other fits. While a crossed ruling is younger than `settle_frames` and the compression less
/// than ten times the admissible one, nothing happens: the sheet had no time to bend along it.
///
/// @param folds  fold angles of the rulings, as far as they are in the mesh (rad)
/// @param draw   number of singular points drawn so far with this seed, counts on
PropagationReport resolve_group(const DemandGroup& group, const GroupTest& in_group,
                                const std::vector<double>& folds, double time, std::uint64_t seed,
                                std::uint64_t& draw, const HybridOptions& options,
                                RulingEditor& editor);

/// Corners of the convex hull, counter-clockwise; two for points on a line.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

/// Point of a convex polygon (or segment, or point) by three numbers in [0, 1): uniform by area.
Eigen::Vector2d point_in_hull(const std::vector<Eigen::Vector2d>& hull,
                              const Eigen::Vector3d& uniform);

}  // namespace geoprior::paper
