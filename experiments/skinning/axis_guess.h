#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "core/skeleton.h"

namespace geoprior::skinning {

/// A unit axis in rest coordinates, and in words where it comes from.
struct GuessedAxis {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  std::string reason;
};

/// What the rest pose says about how a joint turns.
struct JointAxes {
  GuessedAxis flexion;
  Eigen::Vector3d twist = Eigen::Vector3d::Zero();  ///< along the bone
  std::vector<GuessedAxis> alternatives;            ///< to flexion
};

/// Guesses the axes of every joint from the rest pose alone: heads, tails, parents and frames.
///
/// The body stands along +y. Its sides are those of x or z across which more joints have a mirror
/// image; its front is where the lowest bones (feet) point, else +z (glTF's convention). With d the
/// bone, u that of its parent, the flexion axis of
///
///     a joint in the plane of symmetry       up x front       the trunk bends forward
///     a straight limb                        d x t            turns the bone towards t:
///         forward for hips and arms, backward below the hip, and for fingers (beyond a joint with
///         three or more children) the palm's side: down, or the body's middle where they hang
///     a limb bent by >= 3 degrees at rest    u x d            bends further; below 20 degrees only
///         within 25 degrees of the straight limb's axis, as knees are bent to their sides too
///
/// Riggers put a hinge on an axis of the joint's own: the nearest of the frame's axes is taken when
/// it is within 10 degrees of the guess, and the others across the bone are the alternatives. A joint without tail
/// (a leaf) has the direction of its parent's bone.
///
/// @return one for each joint; what cannot be told (a single point) gets unit axes all the same
std::vector<JointAxes> guess_axes(const Skeleton& skeleton);

}  // namespace geoprior::skinning
