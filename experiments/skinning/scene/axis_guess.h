#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "core/inputs/skeleton.h"

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
/// image (a third of those off the plane, and two pairs, or it has none); its front is where the
/// lowest bones (feet) point, else +z (glTF's convention). With d the bone, u that of its parent,
/// the flexion axis of
///
///     a joint in the plane of symmetry   up x front: the trunk bends forward
///     a straight limb                    d x t: the bone turns towards t, forward for hips and
///                                        arms, backward below the hip
///     a hand (three or more children)    the line of the knuckles: closes to the palm's side, down
///         and its fingers                when stretched out, inwards when hanging
///     a limb bent by >= 3 degrees        u x d: bends further; below 20 degrees only within 25 of
///                                        the axis above, as knees are bent to their sides too
///
/// Riggers put a hinge on an axis of the joint's own: the nearest of the frame's axes is taken when
/// it is within 10 degrees of the guess, and the others across the bone are the alternatives. A
/// joint without tail (a leaf) has the direction of its parent's bone.
///
/// @return one for each joint; what cannot be told (a single point) gets unit axes all the same
std::vector<JointAxes> guess_axes(const Skeleton& skeleton);

}  // namespace geoprior::skinning
