#pragma once

#include "core/inputs/skeleton.h"

namespace geoprior::skinning {

/// The way of a skeleton from pose to pose, in steps that are small enough to follow.
///
/// Between two poses every joint turns about its head against its parent at constant speed (slerp);
/// the heads that a pose carries away from their parents move along straight lines.
class PosePath {
 public:
  explicit PosePath(Skeleton skeleton);

  /// The next pose begins a path: it is reached from rest, moved as a whole with the first root.
  void restart() { begun_ = false; }

  /// Goes on to `pose`.
  /// @param largest_turn  of a joint against its parent in one step (radians)
  /// @return steps, at least 1
  int go_to(const Pose& pose, double largest_turn);

  /// Pose after `step` of the steps, 1 … n. The last one is the pose that was gone to, bit by bit.
  const Pose& at(int step);

 private:
  [[nodiscard]] Eigen::Isometry3d against_parent(const Pose& pose, std::size_t joint) const;

  Skeleton skeleton_;
  bool begun_ = false;
  int steps_ = 1;
  Pose from_, to_, between_;
};

}  // namespace geoprior::skinning
