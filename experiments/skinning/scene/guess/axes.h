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
  std::optional<std::string> doubt;                 ///< why flexion may be wrong
};

/// Guesses the axes of every joint from the rest pose alone: heads, tails, parents and frames.
///
/// Where the body stands, its sides and its front are found as in body.h, hands as in hand.h. With
/// d the bone, u that of its parent, the flexion axis of
///
///     a joint in the plane of symmetry   up x front: the trunk bends forward
///     a straight limb                    d x t: the bone turns towards t, forward for hips and
///                                        arms, backward for knees (a quarter to 0.85 down the
///                                        leg), up where it points forward
///     a hand and its fingers, toes       the line of the knuckles: closes to the palm's side, down
///                                        when stretched out, inwards when hanging; without a body
///                                        to the side that the fingers are bent to
///     a limb bent by >= 3 degrees        u x d: bends further; below 20 degrees only within 25 of
///                                        the axis above, as knees are bent to their sides too
///
/// A doubt says what of this the joints do not show: the front without feet, all of it without
/// mirror images (a limb that is clearly bent is sure even so), the side that a straight leg of an
/// animal bends to, a bone without an end, thumbs, ears and pads, joints that all hang on the root,
/// and a bend of 8 degrees or more that the guess for a straight limb contradicts by over 45.
///
/// Riggers put a hinge on an axis of the joint's own: the nearest of the frame's axes is taken when
/// it is within 10 degrees of the guess, and the others across the bone are the alternatives. A
/// joint without tail (a leaf) has the direction of its parent's bone.
///
/// @return one for each joint; what cannot be told (a single point) gets unit axes all the same
std::vector<JointAxes> guess_axes(const Skeleton& skeleton);

}  // namespace geoprior::skinning
