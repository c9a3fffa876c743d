#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace geoprior::skinning {

struct BvhChannel {
  bool is_rotation = true;
  int axis = 0;  ///< 0 x, 1 y, 2 z
};

struct BvhJoint {
  std::string name;
  int parent = -1;                                   ///< smaller than the joint's own index
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< from the parent, in the file's unit
  std::vector<BvhChannel> channels;                  ///< in the order of the file
  int first_column = 0;                              ///< of its channels in `values`
  std::optional<Eigen::Vector3d> end_site;           ///< from the joint
  /// Position channels hold the offset already and replace it, instead of being added (root.h).
  bool channels_hold_offset = false;
};

/// Motion capture in the Biovision hierarchical format.
struct BvhMotion {
  std::vector<BvhJoint> joints;
  double frame_time_s = 0;
  Eigen::MatrixXd values;  ///< one row a frame; degrees, and lengths in the file's unit
  /// Turns the file's coordinates into those of the world, where y is up (up.h).
  Eigen::Quaterniond to_y_up = Eigen::Quaterniond::Identity();
  std::vector<std::string> notes;  ///< what was left out or guessed, a sentence each

  [[nodiscard]] int frame_count() const { return static_cast<int>(values.rows()); }
};

/// Rotation of every joint from the file's rest pose (all channels zero) to a frame, in world
/// coordinates, and the positions of the joints (file's unit).
struct BvhFrame {
  std::vector<Eigen::Quaterniond> rotation;
  std::vector<Eigen::Vector3d> position;
};
BvhFrame bvh_frame(const BvhMotion& motion, int frame);

/// Where the joints are in the file's rest pose, in world coordinates (file's unit).
std::vector<Eigen::Vector3d> rest_positions(const BvhMotion& motion);

}  // namespace geoprior::skinning
