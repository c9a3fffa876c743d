#pragma once

#include <string>
#include <vector>

#include "core/error.h"
#include "core/mesh.h"

namespace geoprior {

struct RiggedMesh;

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
    double proximal_reach = 0;  ///< sections are taken up to here along the parent's bone (m)
    double distal_reach = 0;    ///< … and up to here along the joint's own bone (m)
  };
  std::string name;
  std::vector<Hinge> hinges;
  double extent = 2;           ///< half length along the bones, in local radii
  std::vector<int> triangles;  ///< of the mesh, ascending
  std::vector<std::vector<int>>
      border_loops;  ///< vertices, in the order of the region's boundary edges
};

/// A joint about which there is no skin.
class NoSkinAboutJoint : public Error {
 public:
  using Error::Error;
};

/// Chooses the limb's own skin around the joints, by a flood fill that starts at the triangle next
/// to each joint.
///
/// A triangle belongs to the region when one of its vertices lies within `extent` radii of a joint
/// along the bone on its side of the joint's bisector plane (the whole bone between two joints of
/// the region), and all three lie within 2.5 radii of the bones and are not held mainly (weight
/// above one half) by a sibling limb such as the next finger. Blended skin, that no rigid part of
/// the body holds by 0.95 or more, belongs to it up to twice as far and whoever holds the rest: so
/// the border loops lie where the skin moves nearly rigidly (`border_rigidity` says how nearly).
/// Islands smaller than a twentieth of the region's area are taken in, so that no border loop lies
/// in moving skin.
///
/// The radius of a joint is the median distance from its two bones of the skin that both hold with
/// weights of at least 0.1, or, when there is hardly any (rigid weights), of the skin within three
/// times the smallest distance from the joint.
///
/// @param joints     joints that turn; each must have a parent
/// @param bend_axes  one rest axis a joint (zero vectors allowed)
/// @param extent     half length of the region along both bones, in local radii
/// @throws NoSkinAboutJoint  on a joint without skin
/// @throws Error  on a joint without parent, or when the counts differ
JointRegion make_joint_region(const RiggedMesh& rig, const std::string& name,
                              const std::vector<int>& joints,
                              const std::vector<Eigen::Vector3d>& bend_axes, double extent = 2.0);

/// Smallest, over the border loops' vertices, of the largest sum of weights of joints that move
/// together in the motion (all that no hinge separates): 1 when the borders move rigidly.
double border_rigidity(const RiggedMesh& rig, const JointRegion& region);

/// Vertices of the region's triangles, ascending.
std::vector<int> region_vertices(const JointRegion& region, const Eigen::MatrixX3i& F);

/// Where a rest point lies at a hinge: positive along the joint's own bone, negative along the
/// parent's (m).
double chain_coordinate(const JointRegion::Hinge& hinge, const Eigen::Vector3d& rest_point);

}  // namespace geoprior
