#pragma once

#include <optional>
#include <vector>

#include "core/inputs/rig.h"
#include "experiments/skinning/scene/motion.h"
#include "metrics/contact/joint_region.h"
#include "testbed/figure_view.h"

namespace geoprior::skinning {

/// The camera that shows how a ramp bends a character's first turned joint, in the last pose: along
/// the axis, from the outside of the body, so that the bending plane is the picture's; two thirds
/// of the bones beside the joint fill it. About a bone's own axis (a twist) the eye is at the
/// bone's side.
///
/// @return absent where the motion is no ramp, or the joint turns about several axes
std::optional<Camera> bending_camera(const RiggedMesh& rig, const Motion& motion,
                                     const std::vector<JointRegion>& regions);

}  // namespace geoprior::skinning
