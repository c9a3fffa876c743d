#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/inputs/skeleton.h"

namespace geoprior::skinning {

/// A hand, or a foot with toes: the joint from which fingers leave.
struct Hand {
  int joint = 0;
  Eigen::Vector3d direction;  ///< unit, to where the fingers point but the thumb
  Eigen::Vector3d knuckles;   ///< unit, the line that the fingers' first joints lie along
  double reach = 0;           ///< of the longest finger
  /// Unit, about which the fingers are bent at rest: `knuckles` or its opposite. Absent: straight.
  std::optional<Eigen::Vector3d> closing;
};

/// The hand that a joint is. It has three or more children, each the first of a chain without
/// branches; all of them but one (a thumb) point within 50 degrees of their mean, none backwards;
/// they lie side by side, along a line across that, and not behind one another, as joints that
/// twist an arm do. So a pelvis, a chest and a root with four legs are none.
///
/// Fingers are bent when their bends about the line of the knuckles come to 4 degrees each, and no
/// third of it to the other side.
/// @param bone  unit, of the joint
std::optional<Hand> find_hand(const Skeleton& skeleton,
                              const std::vector<std::vector<int>>& children, int joint,
                              const Eigen::Vector3d& bone);

/// Whether a finger points so far aside from the others (more than 25 degrees) that it is a thumb.
/// @param chain  the finger's joints from the hand outwards
bool is_thumb(const Hand& hand, const Skeleton& skeleton, const std::vector<int>& chain);

/// Joints from one on outwards, as long as each has one child; the last has none, or several.
std::vector<int> chain_from(int joint, const std::vector<std::vector<int>>& children);

}  // namespace geoprior::skinning
