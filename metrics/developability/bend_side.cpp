#include "metrics/developability/bend_side.h"

#include <Eigen/Geometry>
#include <limits>

namespace geoprior {
namespace {

constexpr double kLeastAcross = 0.2;  // sine of the angle between the bend axis and a bone

std::size_t nearest_hinge(const JointRegion& region, const Eigen::Vector3d& x) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t h = 0; h < region.hinges.size(); ++h) {
    const double distance = (x - region.hinges[h].head).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    nearest = h;
  }
  return nearest;
}

}  // namespace

std::optional<BendSides> bend_sides(const JointRegion::Hinge& hinge, const Pose& pose) {
  const Eigen::Vector3d across_distal = hinge.bend_axis.cross(hinge.distal);
  const Eigen::Vector3d across_proximal = hinge.bend_axis.cross(hinge.proximal);
  if (across_distal.norm() <= kLeastAcross || across_proximal.norm() <= kLeastAcross) return {};
  const Eigen::Matrix3d turn =
      pose[hinge.proximal_joint].linear().transpose() * pose[hinge.joint].linear();
  const Eigen::Quaterniond q(turn);
  BendSides sides;
  sides.sign = q.vec().dot(hinge.bend_axis) * q.w() < 0 ? -1 : 1;
  sides.distal = -sides.sign * across_distal.normalized();
  sides.proximal = sides.sign * across_proximal.normalized();
  return sides;
}

std::vector<int> outer_vertices(const JointRegion& region, const Eigen::MatrixX3i& F,
                                const Eigen::MatrixX3d& rest, const Pose& pose) {
  std::vector<std::optional<BendSides>> sides;
  for (const JointRegion::Hinge& hinge : region.hinges) sides.push_back(bend_sides(hinge, pose));
  std::vector<int> outer;
  for (const int v : region_vertices(region, F)) {
    const Eigen::Vector3d x = rest.row(v).transpose();
    const std::size_t h = nearest_hinge(region, x);
    if (!sides[h]) continue;
    const JointRegion::Hinge& hinge = region.hinges[h];
    const bool is_distal = chain_coordinate(hinge, x) >= 0;
    const Eigen::Vector3d& out = is_distal ? sides[h]->distal : sides[h]->proximal;
    if ((x - hinge.head).dot(out) > 0) outer.push_back(v);
  }
  return outer;
}

}  // namespace geoprior
