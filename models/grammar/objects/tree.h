#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "core/options.h"
#include "models/grammar/hierarchy/hierarchy.h"
#include "models/grammar/objects/crossing.h"

namespace geoprior::grammar {

/// A broad-leaved tree: a trunk that goes on from segment to segment, from which limbs leave, from
/// these boughs, from these twigs, each a chain of branches.
struct TreeOptions {
  double height = 8;   ///< m
  int levels = 3;      ///< above the trunk
  int branches = 300;  ///< of all levels, the most
  double spread = 1.0;
  double trunk = 0.018;
  double wobble = 0.16;  ///< by how much a chain turns from branch to branch (rad)
};
void describe(OptionVisitor& v, TreeOptions& options);

/// Numbers of the parameters of a branch.
struct BranchParameter {
  static constexpr int kLength = 0;  ///< m
  static constexpr int kRadius = 1;  ///< m, at its base and of its capsule
  static constexpr int kAttach = 2;  ///< where it hangs, as a share of the parent's length
  static constexpr int kLevel = 3;   ///< 0: trunk
  static constexpr int kMean = 4;    ///< mean length of the branches of its level at rest (m)
  static constexpr int kTaper = 5;   ///< radius at its tip over that at its base
};

/// Least and largest length of a branch over the mean of its level.
inline constexpr double kShortestBranch = 0.5, kLongestBranch = 1.5;

/// The root of a tree, "tree": its key point is its position.
ElementType tree_type();
/// "branch", with the parameters above in their order. Its frame has the origin at its base and the
/// z axis along it; key points: base, tip.
ElementType branch_type();

/// A tree that stands on the origin. Branches hang on the axis of their parent, have lengths within
/// the bounds, and their capsules do not cross.
///
/// Branches of a chain go on at attach 1 from each other; a chain leaves another one by the golden
/// angle (137.5 degrees) from the one before. The last level is thinned at random until `branches`
/// is met. Radii by the pipe model of exponent 2 (Shinozaki et al. 1964): the cross-section of a
/// branch is that of all twigs above it.
/// @throws Error  naming the option that is out of its range
Hierarchy make_tree(const TreeOptions& options, std::uint64_t seed);

/// Unit vector from the base of a branch to its tip.
Eigen::Vector3d branch_axis(const Hierarchy& hierarchy, int branch);
/// The turn nearest to `turn` whose z axis lies along a direction (of any length but 0).
Eigen::Quaterniond turned_along(const Eigen::Quaterniond& turn, const Eigen::Vector3d& direction);
/// Where something hangs at `attach` of an element: on its axis, or at the position of one that is
/// no branch.
Eigen::Vector3d attach_point(const Hierarchy& hierarchy, int element, double attach);
Capsule branch_capsule(const Hierarchy& hierarchy, int branch);
/// Whether two branches meet in a node, so that they need not keep apart: parent and child, or
/// children of one branch at the same place.
bool branches_meet(const Hierarchy& hierarchy, int first, int second);

/// A branch that crosses another one, or -1: all pairs but those that meet.
int crossing_branch(const Hierarchy& hierarchy);

}  // namespace geoprior::grammar
