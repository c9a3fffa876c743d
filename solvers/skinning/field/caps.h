#pragma once

#include <Eigen/Core>
#include <vector>

namespace geoprior::skinning {

/// Points with unit outward normals that close a bone's field beyond one of its joints.
struct CapSamples {
  std::vector<Eigen::Vector3d> points;
  std::vector<Eigen::Vector3d> normals;
};

/// The end of a bone: where it stops, and the unit direction that leads out of it.
struct BoneEnd {
  Eigen::Vector3d joint;
  Eigen::Vector3d outward;
};

/// One sample on the axis, `distance` from the joint.
CapSamples point_cap(const BoneEnd& end, double distance);

/// A dome about the joint that continues the skin: at the joint's plane it has the skin's radius
/// rho(psi), a Fourier series of order two fitted to the skin near the plane, on the axis the
/// radius `pole`, between them rho(psi) cos^2(latitude) + pole sin^2(latitude). When the joint
/// bends, the outer side is an arc of the two domes.
///
/// @param skin  points of the skin, of which those near the joint's plane count; a point cap
/// results when they do not
///              surround the axis (a hip, a shoulder)
/// @param pole  distance of the dome from the joint on the axis (m)
CapSamples dome_cap(const BoneEnd& end, const std::vector<Eigen::Vector3d>& skin, double pole);

}  // namespace geoprior::skinning
