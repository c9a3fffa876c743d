#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/skinning/bvh/root.h"
#include "experiments/skinning/bvh/up.h"
#include "experiments/skinning/scene/characters.h"
#include "experiments/skinning/scene/joint_scale.h"

namespace geoprior::skinning {

enum class MotionKind { ramp, loop, poses, clip, bvh };

/// One joint of a ramp of several.
struct JointRamp {
  std::string joint;
  std::string axis = "flexion";
  double from_deg = 0;
  double to_deg = 90;
};
void describe(OptionVisitor& v, JointRamp& options);

/// `motion`: what the character does. A tagged choice: `kind` selects which of the others are
/// described.
struct MotionOptions {
  MotionKind kind = MotionKind::ramp;
  // ramp: linear in the parameter, which is the first joint's angle
  // loop: a ramp and the same poses back; the parameter is the step, for angles repeat
  std::optional<std::string> joint;
  std::string axis = "flexion";
  double from_deg = 0;
  double to_deg = 90;
  std::vector<JointRamp> joints;
  int frames = 25;
  // poses, bvh
  std::optional<std::string> file;
  std::vector<std::string> names;
  // clip
  std::optional<std::string> name;
  std::optional<double> start_s;
  std::optional<double> end_s;
  JointScale joint_scale = JointScale::refuse;
  // bvh
  int first_frame = 0;
  std::optional<int> last_frame;
  int stride = 1;
  int origin_frame = 0;
  BvhUp bvh_up = BvhUp::guess;
  BvhRoot bvh_root = BvhRoot::guess;
};
void describe(OptionVisitor& v, MotionOptions& options);

/// The poses of a motion, one a parameter (strictly increasing, or decreasing for a ramp that
/// does).
struct Motion {
  std::vector<double> parameters;
  std::vector<Pose> poses;
  std::string parameter_name = "angle";
  std::string parameter_unit = "deg";
  /// Joints that a ramp turns and their rest axes (zero when one turns about several axes).
  std::vector<int> turned_joints;
  std::vector<Eigen::Vector3d> turned_axes;
  std::vector<std::filesystem::path> files;
  std::vector<std::string> warnings;
};

/// @throws Error  naming the option or file: unknown joints, axes, poses or clips, a motion that
///                needs a file and names none, a clip that scales joints
Motion make_motion(const MotionOptions& options, const Character& character,
                   const std::filesystem::path& folder);

}  // namespace geoprior::skinning
