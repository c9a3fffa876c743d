#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/inputs/rig.h"
#include "core/options.h"
#include "experiments/skinning/scene/characters.h"
#include "experiments/skinning/scene/motion.h"
#include "metrics/contact/joint_region.h"
#include "testbed/topic.h"

namespace geoprior::skinning {

/// `[scene]` of a skinning experiment: a character (its members stand at the top level), a motion,
/// and the joints whose regions are measured.
struct SkinningSceneOptions {
  CharacterOptions character;
  MotionOptions motion;
  std::vector<std::string> regions;
  double region_extent = 2;
};
void describe(OptionVisitor& v, SkinningSceneOptions& options);

/// A rigged character and a motion: what every skinning method is given and every skinning metric
/// is measured on.
class SkinningScene final : public Scene {
 public:
  RiggedMesh rig;                    ///< welded, refined as asked
  int cap_triangles = 0;             ///< the last ones of `rig.mesh`, which close holes of the file
  TriMesh input_mesh;                ///< as the file had it, split at seams (refined the same way)
  std::vector<int> welded_of_input;  ///< for each vertex of `input_mesh`, its vertex in `rig.mesh`
  std::vector<double> frame_parameter;
  std::vector<Pose> frame_pose;  ///< one a parameter
  std::vector<JointRegion>
      regions;  ///< of the joints the motion turns; the first is the one metrics report
  std::string parameter_label = "angle";
  std::string parameter_unit_label = "deg";
  double unit_m = 1;  ///< metres that were taken for a unit of the character's file
  std::vector<std::filesystem::path> input_files;
  std::vector<std::string> load_warnings;
  std::optional<Camera> bending_view;

  [[nodiscard]] std::vector<double> parameters() const override { return frame_parameter; }
  [[nodiscard]] std::string parameter_name() const override { return parameter_label; }
  [[nodiscard]] std::string parameter_unit() const override { return parameter_unit_label; }
  [[nodiscard]] std::vector<std::filesystem::path> inputs() const override { return input_files; }
  [[nodiscard]] std::vector<std::string> warnings() const override { return load_warnings; }
  [[nodiscard]] std::map<std::string, double> facts() const override;
  /// Parts "surface" at rest with the array "weights" (a column a joint) and "bones" (a line a
  /// joint, with "joint" and "parent"); table "transforms": a row a frame and joint, the 3 x 4
  /// matrix that moves points from rest.
  [[nodiscard]] Frame given() const override;
  [[nodiscard]] std::vector<PartShape> frame_shape() const override;
  [[nodiscard]] std::optional<Camera> camera() const override { return bending_view; }

  /// Pose at a parameter: that of the frame whose parameter is equal; throws Error when there is
  /// none.
  [[nodiscard]] const Pose& pose_at(double parameter) const;

  /// Triangles of `rig.mesh` without the caps.
  [[nodiscard]] int skin_triangles() const { return rig.mesh.triangle_count() - cap_triangles; }
};

/// Loads the character, makes the motion's poses and chooses the regions: joints of a ramp that are
/// neighbours in the skeleton (a finger's) share a region.
/// @param folder  of the experiment file, against which relative files are tried first
/// @throws Error  naming the file or option
std::shared_ptr<SkinningScene> load_skinning_scene(const SkinningSceneOptions& options,
                                                   const std::filesystem::path& folder);

}  // namespace geoprior::skinning
