#include "experiments/skinning/scene/motion.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

#include "core/error.h"
#include "core/limits.h"
#include "testbed/runner/number_text.h"

namespace geoprior::skinning {
namespace {

double at_fraction(double from, double to, int i, int count) {
  return count == 1 ? to : from + (to - from) * i / (count - 1);
}

std::vector<JointRamp> ramps_of(const MotionOptions& options) {
  std::vector<JointRamp> ramps = options.joints;
  if (options.joint) {
    ramps.insert(ramps.begin(), {*options.joint, options.axis, options.from_deg, options.to_deg});
  }
  if (ramps.empty()) {
    throw Error("the motion turns no joint", "scene.motion", "joint = \"…\" or joints = [{ … }]");
  }
  if (ramps[0].from_deg == ramps[0].to_deg && options.frames > 1) {
    throw Error("the first joint's angle is the parameter and does not change", "scene.motion",
                "from_deg and to_deg that differ");
  }
  return ramps;
}

/// Poses of all frames are made at once.
void require_poses(int frames, int joints) {
  const double bytes = static_cast<double>(frames) * joints * sizeof(Pose::value_type);
  require_memory(bytes, frames, "poses of " + std::to_string(joints) + " joints",
                 "scene.motion.frames");
}

Motion make_ramp(const MotionOptions& options, const Skeleton& skeleton) {
  require_poses(options.frames, skeleton.size());
  const std::vector<JointRamp> ramps = ramps_of(options);
  Motion motion;
  for (const JointRamp& ramp : ramps) {
    const int joint = skeleton.index_of(ramp.joint);
    const Eigen::Vector3d axis = joint_axis(skeleton, ramp.joint, ramp.axis);
    const auto known = std::find(motion.turned_joints.begin(), motion.turned_joints.end(), joint);
    if (known == motion.turned_joints.end()) {
      motion.turned_joints.push_back(joint);
      motion.turned_axes.push_back(axis);
    } else {
      motion.turned_axes[known - motion.turned_joints.begin()].setZero();
    }
  }
  for (int i = 0; i < options.frames; ++i) {
    std::vector<JointRotation> rotations;
    for (const JointRamp& ramp : ramps) {
      const double angle = at_fraction(ramp.from_deg, ramp.to_deg, i, options.frames);
      rotations.push_back(joint_rotation(skeleton, {ramp.joint, ramp.axis, angle}));
    }
    motion.parameters.push_back(at_fraction(ramps[0].from_deg, ramps[0].to_deg, i, options.frames));
    motion.poses.push_back(pose_from_rotations(skeleton, rotations));
  }
  return motion;
}

/// A ramp, and back to where it began: 2 frames - 1 poses.
Motion make_loop(const MotionOptions& options, const Skeleton& skeleton) {
  require_poses(2 * options.frames - 1, skeleton.size());
  Motion motion = make_ramp(options, skeleton);
  for (std::size_t i = motion.poses.size() - 1; i-- > 0;) motion.poses.push_back(motion.poses[i]);
  motion.parameters.resize(motion.poses.size());
  std::iota(motion.parameters.begin(), motion.parameters.end(), 0.0);
  motion.parameter_name = "step";
  motion.parameter_unit = "1";
  return motion;
}

std::filesystem::path required_file(const MotionOptions& options,
                                    const std::filesystem::path& folder) {
  if (!options.file) throw Error("the motion names no file", "scene.motion", "file = \"…\"");
  return find_input(*options.file, folder);
}

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

Motion make_poses(const MotionOptions& options, const Skeleton& skeleton,
                  const std::filesystem::path& folder) {
  const std::filesystem::path file = required_file(options, folder);
  const std::vector<NamedPose> poses = read_pose_file(file);
  std::vector<std::string> known;
  for (const NamedPose& pose : poses) known.push_back(pose.name);
  const std::vector<std::string>& wanted = options.names.empty() ? known : options.names;
  Motion motion;
  motion.parameter_name = "pose";
  motion.parameter_unit = "1";
  motion.files.push_back(file);
  for (const std::string& name : wanted) {
    const auto it = std::find(known.begin(), known.end(), name);
    if (it == known.end()) throw Error("no pose '" + name + "'", file.string(), list_of(known));
    std::vector<JointRotation> rotations;
    for (const JointAngle& angle : poses[it - known.begin()].angles) {
      try {
        rotations.push_back(joint_rotation(skeleton, angle));
      } catch (const Error& e) {
        throw Error(e.what(), file.string() + ": pose '" + name + "'");
      }
    }
    motion.parameters.push_back(static_cast<double>(motion.poses.size()));
    motion.poses.push_back(pose_from_rotations(skeleton, rotations));
  }
  return motion;
}

/// Transforms of the file's joints on those of the scene's skeleton: by name, in metres; a joint
/// that the file does not have follows its parent.
Pose convert_pose(const Pose& pose, const Character& character) {
  const Skeleton& from = *character.gltf->skeleton;
  const Skeleton& to = character.rig.skeleton;
  Pose result = rest_pose(to.size());
  for (std::size_t j = 0; j < result.size(); ++j) {
    const Joint& joint = to.joints[j];
    const auto it = std::find_if(from.joints.begin(), from.joints.end(),
                                 [&](const Joint& other) { return other.name == joint.name; });
    if (it != from.joints.end()) {
      result[j] = pose[it - from.joints.begin()];
      result[j].translation() *= character.unit_m;
    } else if (joint.parent >= 0) {
      result[j] = result[joint.parent];
    }
  }
  return result;
}

/// The bind pose is the rest pose; a file that shows nothing of a joint is refused all the same.
void require_joints_at_rest(const Character& character) {
  if (!character.gltf || !character.gltf->skeleton) return;
  const Pose rest = convert_pose(clip_pose(*character.gltf, {}, 0), character);
  if (const auto lost = lost_joint({rest}, character.rig))
    refuse_lost("the file's scene", *lost, character.rig.skeleton, "", character.files[0].string());
}

const GltfClip& find_clip(const MotionOptions& options, const Character& character) {
  if (!character.gltf || !character.gltf->skeleton || character.gltf->clips.empty())
    throw Error("the character's file has no skin with an animation", "scene.motion",
                "a .glb or .gltf with both");
  const std::vector<GltfClip>& clips = character.gltf->clips;
  if (!options.name) return clips[0];
  std::vector<std::string> names;
  for (const GltfClip& clip : clips) {
    if (clip.name == *options.name) return clip;
    names.push_back(clip.name);
  }
  throw Error("no clip '" + *options.name + "'", character.files[0].string(), list_of(names));
}

Motion make_clip(const MotionOptions& options, const Character& character) {
  const GltfClip& clip = find_clip(options, character);
  require_poses(options.frames, character.rig.skeleton.size());
  const double start = options.start_s.value_or(clip.start_s);
  const double end = options.end_s.value_or(clip.end_s);
  if (start < clip.start_s || end > clip.end_s || (end <= start && options.frames > 1)) {
    throw Error("the clip '" + clip.name + "' is not sampled from " + std::to_string(start) +
                    " to " + std::to_string(end) + " s",
                "scene.motion",
                "start_s < end_s within " + std::to_string(clip.start_s) + " to " +
                    std::to_string(clip.end_s));
  }
  Motion motion;
  motion.parameter_name = "time";
  motion.parameter_unit = "s";
  const auto play = [&](ClipScale scale) {
    motion.poses.clear();
    for (const double t : motion.parameters)
      motion.poses.push_back(convert_pose(clip_pose(*character.gltf, clip, t, scale), character));
  };
  for (int i = 0; i < options.frames; ++i)
    motion.parameters.push_back(at_fraction(start, end, i, options.frames));
  const std::string file = character.files[0].string();
  const auto require_joints = [&] {
    if (const auto lost = lost_joint(motion.poses, character.rig)) {
      refuse_lost("the clip '" + clip.name + "'", *lost, character.rig.skeleton,
                  " at " + rounded_text(motion.parameters[lost->frame]) + " s", file);
    }
  };
  play(ClipScale::played);
  if (options.joint_scale == JointScale::refuse) require_joints();
  const auto scaled = most_scaled_joint(motion.poses, character.rig);
  if (!scaled) {
    require_joints();
    return motion;
  }
  const std::string what = "the clip '" + clip.name + "' " +
                           scale_text(*scaled, character.rig.skeleton, motion.parameters);
  if (options.joint_scale == JointScale::refuse) refuse_scale(what, file);
  play(ClipScale::left_out);
  require_joints();
  for (Pose& pose : motion.poses) make_rigid(character.rig.skeleton, pose);
  motion.warnings.push_back(file + ": " + what +
                            "; it is played without scale (joint_scale = \"strip\")");
  return motion;
}

Motion make_bvh(const MotionOptions& options, const Character& character,
                const std::filesystem::path& folder) {
  const std::filesystem::path file = required_file(options, folder);
  if (!character.skeleton_file)
    throw Error("a motion capture file needs a skeleton file with 'bvh' names", file.string(),
                "skeleton = \"<name>.skeleton.toml\"");
  BvhMotion capture = read_bvh(file);
  const int last = options.last_frame.value_or(capture.frame_count() - 1);
  if (last >= capture.frame_count() || options.first_frame > last ||
      options.origin_frame >= capture.frame_count()) {
    throw Error(
        "frames " + std::to_string(options.first_frame) + " to " + std::to_string(last) +
            " (origin " + std::to_string(options.origin_frame) + ")",
        file.string(),
        "first_frame <= last_frame, all at most " + std::to_string(capture.frame_count() - 1));
  }
  capture = stand_up(std::move(capture), *character.skeleton_file, options.bvh_up,
                     options.origin_frame, file.string());
  capture = place_root(std::move(capture), options.bvh_root, file.string());
  const BvhRetarget retarget(capture, *character.skeleton_file, options.origin_frame);
  Motion motion;
  motion.parameter_name = "time";
  motion.parameter_unit = "s";
  motion.files.push_back(file);
  motion.warnings = capture.notes;
  for (std::int64_t next = options.first_frame; next <= last; next += options.stride) {
    const int f = static_cast<int>(next);
    motion.parameters.push_back(f * capture.frame_time_s);
    motion.poses.push_back(retarget.pose(f));
  }
  return motion;
}

void describe_ramp(OptionVisitor& v, MotionOptions& options) {
  v.value("joint", options.joint, {.doc = "joint that turns"});
  v.value(
      "axis", options.axis,
      {.doc = "axis by the name that the skeleton file gives, or \"+x\" … \"-z\" (of the mesh), "
              "\"local +x\" … (the joint's own)"});
  v.value("from_deg", options.from_deg,
          {.doc = "angle of the joint in the first frame", .unit = "deg"});
  v.value("to_deg", options.to_deg, {.doc = "angle of the joint in the last frame", .unit = "deg"});
  describe_list(v, "joints", options.joints,
                {.doc = "further joints that turn at the same time; the parameter is the angle of "
                        "the first of all"});
  v.value("frames", options.frames,
          {.doc = "number of frames, equally spaced; of a loop: on the way out",
           .min = 1,
           .max = kMostFrames});
}

}  // namespace

void describe(OptionVisitor& v, JointRamp& options) {
  v.value("joint", options.joint, {.doc = "joint that turns", .required = true});
  v.value(
      "axis", options.axis,
      {.doc = "axis by the name that the skeleton file gives, or \"+x\" … \"-z\" (of the mesh), "
              "\"local +x\" … (the joint's own)"});
  v.value("from_deg", options.from_deg,
          {.doc = "angle of the joint in the first frame", .unit = "deg"});
  v.value("to_deg", options.to_deg, {.doc = "angle of the joint in the last frame", .unit = "deg"});
}

void describe(OptionVisitor& v, MotionOptions& options) {
  static constexpr std::array<std::string_view, 5> kKinds{"ramp", "loop", "poses", "clip", "bvh"};
  static constexpr std::array<std::string_view, 4> kUps{"guess", "x", "y", "z"};
  static constexpr std::array<std::string_view, 3> kRoots{"guess", "added", "replaced"};
  static constexpr std::array<std::string_view, 2> kScales{"refuse", "strip"};
  describe_choice(
      v, "kind", options.kind, kKinds,
      {.doc = "a ramp of joint angles, a loop out and back, poses of a file, a clip of the "
              "character's file, or captured motion"});
  switch (options.kind) {
    case MotionKind::ramp:
    case MotionKind::loop:
      describe_ramp(v, options);
      break;
    case MotionKind::poses:
      v.value("file", options.file, {.doc = "pose file", .named = Named::file});
      v.value("names", options.names,
              {.doc = "names of the poses in order; empty: all of the file"});
      break;
    case MotionKind::clip:
      v.value("name", options.name,
              {.doc = "name of the animation of the file; absent: its first"});
      v.value("start_s", options.start_s,
              {.doc = "time of the first frame; absent: the clip's start", .unit = "s"});
      v.value("end_s", options.end_s,
              {.doc = "time of the last frame; absent: the clip's end", .unit = "s"});
      v.value("frames", options.frames,
              {.doc = "number of frames, equally spaced", .min = 1, .max = kMostFrames});
      describe_choice(v, "joint_scale", options.joint_scale, kScales,
                      {.doc = "what becomes of a clip that scales joints, which not every method "
                              "can follow: an error, or played without scale"});
      break;
    case MotionKind::bvh:
      v.value("file", options.file, {.doc = "motion capture file", .named = Named::file});
      v.value("first_frame", options.first_frame,
              {.doc = "first frame that is taken, counted from 0", .min = 0});
      v.value("last_frame", options.last_frame,
              {.doc = "last frame that is taken; absent: that of the file", .min = 0});
      v.value("stride", options.stride,
              {.doc = "frames from one that is taken to the next", .min = 1});
      v.value("origin_frame", options.origin_frame,
              {.doc = "frame at which the root stands over the origin", .min = 0});
      describe_choice(v, "bvh_up", options.bvh_up, kUps,
                      {.doc = "axis of the file that is up; guess: by the heights of the joints"});
      describe_choice(v, "bvh_root", options.bvh_root, kRoots,
                      {.doc = "whether position channels of the root are added to its OFFSET or "
                              "replace it; guess: by the height of the body above the ground"});
      break;
  }
}

Motion make_motion(const MotionOptions& options, const Character& character,
                   const std::filesystem::path& folder) {
  if (options.kind != MotionKind::clip) require_joints_at_rest(character);
  switch (options.kind) {
    case MotionKind::ramp:
      return make_ramp(options, character.rig.skeleton);
    case MotionKind::loop:
      return make_loop(options, character.rig.skeleton);
    case MotionKind::poses:
      return make_poses(options, character.rig.skeleton, folder);
    case MotionKind::clip:
      return make_clip(options, character);
    case MotionKind::bvh:
      return make_bvh(options, character, folder);
  }
  throw Error("unknown kind of motion", "scene.motion", "ramp, loop, poses, clip, bvh");
}

}  // namespace geoprior::skinning
