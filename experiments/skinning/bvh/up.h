#pragma once

#include "experiments/skinning/bvh/bvh.h"

namespace geoprior::skinning {

/// Which axis of a motion capture file is up.
enum class BvhUp { guess, x, y, z };

/// Turns the coordinates of a motion so that its up axis is y, the character's.
///
/// An axis makes the body stand when the heights of the character's driven joints agree by 0.3 or
/// more with those of the motion's joints (covariance over the sizes of both; the walk of
/// assimp-testmodels has 0.81, 0.01 and -0.09 for y, x and z), at its rest pose or at
/// `origin_frame` (a rest pose may be any; a capture may begin on the floor). `guess` takes y, the
/// format's custom, where it does, else the axis that agrees best. A skeleton of which fewer than
/// three joints are driven, or that lie on a line, says nothing: it is taken as it is. A guess of
/// another axis than y is noted with its reason.
///
/// @param name  of the motion's file, for messages
/// @throws Error  when the body would lie down or stand on its head, with the axes' agreements
BvhMotion stand_up(BvhMotion motion, const SkeletonFile& skeleton, BvhUp up, int origin_frame,
                   const std::string& name);

}  // namespace geoprior::skinning
