#pragma once

#include "experiments/skinning/bvh/motion.h"

namespace geoprior::skinning {

/// How position channels of a root go together with its OFFSET.
///
///     added      position = OFFSET + channels   (Biovision; the CMU data base)
///     replaced   position = channels            (Blender, MotionBuilder: they hold the OFFSET
///     already)
enum class BvhRoot { guess, added, replaced };

/// Settles where the root stands. `guess` looks at the height of the OFFSET, all that makes a
/// difference (the root's horizontal path is taken relative to a frame): where it is about that of
/// the root above the lowest point of the body at rest (half to one and a half times), by the
/// ground, height 0, to which the lowest point of the body comes nearer; else by whether the
/// channels stay nearer to the OFFSET than to zero (median). A guess that makes a difference is
/// noted with its reason.
///
/// @param motion  its up axis is known (up.h)
/// @param name    of the motion's file, for the note
BvhMotion place_root(BvhMotion motion, BvhRoot root, const std::string& name);

/// Settles the same for all other joints, whose position channels hold the offset where they stay
/// nearer to it than to zero, and notes those that stretch bones: only the root's are followed.
void find_held_offsets(BvhMotion& motion);

}  // namespace geoprior::skinning
