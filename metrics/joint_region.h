#pragma once

#include <string>
#include <vector>

#include "core/mesh.h"
#include "core/rig.h"

namespace geoprior {

/// The part of a skin around the joints that a motion turns; chosen once, in the rest pose.
///
/// One region may hold several joints (a curled finger). Its surface is closed by fans from the
/// centroid of each border loop, so that it has a volume in every pose; the loops lie where the
/// skin moves with one bone.
struct JointRegion {
  struct Hinge {
    int joint = 0;           ///< the joint that turns
    int proximal_joint = 0;  ///< whose transform moves the bone on the near side (the parent)
    Eigen::Vector3d head = Eigen::Vector3d::Zero();  ///< rest position of the joint
    Eigen::Vector3d proximal =
        Eigen::Vector3d::Zero();  ///< unit, rest, from the joint back along the parent's bone
    Eigen::Vector3d distal =
        Eigen::Vector3d::Zero();  ///< unit, rest, from the joint along its own bone
    Eigen::Vector3d bend_axis =
        Eigen::Vector3d::Zero();  ///< unit, rest; zero when the motion has no single axis
    double radius = 0;  ///< median rest distance of the skin from the bones near the joint (m)
  };
  std::string name;
  std::vector<Hinge> hinges;
  std::vector<int> triangles;  ///< of the mesh
  std::vector<std::vector<int>>
      border_loops;  ///< vertices, in the order of the region's boundary edges
};

/// @param joints     joints that turn
/// @param bend_axes  one rest axis a joint (zero vectors allowed)
/// @param extent     half length of the region along both bones, in local radii
JointRegion make_joint_region(const RiggedMesh& rig, const std::string& name,
                              const std::vector<int>& joints,
                              const std::vector<Eigen::Vector3d>& bend_axes, double extent = 2.0);

}  // namespace geoprior
