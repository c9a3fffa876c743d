#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/inputs/rig.h"

namespace geoprior {

/// A node of the hierarchy: local transform at rest, and the index of the parent (smaller than its
/// own, -1 for a root).
struct GltfNode {
  int parent = -1;
  std::optional<Eigen::Affine3d> matrix;  ///< when given: fixed, the next three are unused
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

/// Key frames of one property of one node.
struct GltfTrack {
  enum class Property { translation, rotation, scale };
  enum class Interpolation { linear, step, cubic_spline };
  int node = 0;
  Property property = Property::rotation;
  Interpolation interpolation = Interpolation::linear;
  Eigen::VectorXd times;  ///< s, strictly increasing
  /// One row a key (three for cubic splines: in-tangent, value, out-tangent); rotations x y z w.
  Eigen::MatrixXd values;
};

/// An animation of the file.
struct GltfClip {
  std::string name;
  double start_s = 0;  ///< first key of any track
  double end_s = 0;    ///< last key of any track
  std::vector<GltfTrack> tracks;
};

/// How the joints of a skin follow the nodes.
struct GltfBinding {
  std::vector<GltfNode> nodes;
  std::vector<int> joint_node;             ///< for each joint of the skeleton
  std::vector<Eigen::Affine3d> from_rest;  ///< rest position to joint space, a joint
};

/// What of a glTF file a rigged character is made of.
struct GltfCharacter {
  TriMesh mesh;                      ///< as the file has it, split at seams; rest pose
  std::vector<int> part_of_vertex;   ///< which of the meshes that were read, in their order
  std::optional<Skeleton> skeleton;  ///< absent: no skin
  SkinWeights weights;               ///< split vertices x joints, rows sum to 1; empty: no skin
  GltfBinding binding;
  std::vector<GltfClip> clips;
  std::vector<std::string> warnings;  ///< what was left out, by name, or repaired; a few of a kind
  std::vector<std::filesystem::path> files;  ///< the file and its buffers
  /// Where meshes of other skeletons were left out: the skin that was read, and those.
  std::string first_skin;
  std::vector<std::string> other_skins;
};

/// Whether tracks of scale are played; nodes keep their scale at rest where they are left out.
enum class ClipScale { played, left_out };

/// Skinning transforms of the file's joints at a time of a clip (clamped to its keys): identity
/// where the nodes are in the bind pose.
Pose clip_pose(const GltfCharacter& character, const GltfClip& clip, double time_s,
               ClipScale scale = ClipScale::played);

}  // namespace geoprior
