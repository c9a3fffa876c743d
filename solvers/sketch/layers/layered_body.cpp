#include "solvers/sketch/layers/layered_body.h"

namespace geoprior::sketch {

std::vector<Eigen::Isometry3d> layer_poses(const ArticulatedLayers& layers,
                                           const std::vector<double>& angles) {
  std::vector<Eigen::Isometry3d> poses{Eigen::Isometry3d::Identity()};
  for (std::size_t j = 0; j < layers.hinges.size(); ++j)
    poses.push_back(poses.back() * hinge_turn(layers.hinges[j], angles[j]));
  return poses;
}

Eigen::Vector3d hinge_point(const ArticulatedLayers& layers, std::size_t hinge, HingeAxis axis) {
  const LayerHinge& joint = layers.hinges[hinge];
  const FrustumBand& front = layers.bands[hinge];
  const double x = front.own(joint.point).x();
  switch (axis) {
    case HingeAxis::centre:
      return front.rear + x * front.axis;
    case HingeAxis::crown:
      return front.point(x, 0);
    case HingeAxis::rivets:
      break;
  }
  return joint.point;
}

Eigen::Isometry3d hinge_turn(const LayerHinge& hinge, double angle) {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = Eigen::AngleAxisd(angle, hinge.axis).toRotationMatrix();
  turn.translation() = hinge.point - turn.linear() * hinge.point;
  return turn;
}

}  // namespace geoprior::sketch
