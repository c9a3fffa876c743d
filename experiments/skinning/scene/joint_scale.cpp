#include "experiments/skinning/scene/joint_scale.h"

#include <Eigen/SVD>
#include <cmath>

#include "core/error.h"
#include "testbed/runner/number_text.h"

namespace geoprior::skinning {
namespace {

constexpr double kRigid = 1e-3;  ///< scale that single precision and rounded keys leave

constexpr double kLost = 1e-6;  ///< scale that leaves nothing

double smallest_scale(const Eigen::Matrix3d& linear) {
  return Eigen::JacobiSVD<Eigen::Matrix3d>(linear).singularValues()[2];
}

std::vector<bool> joints_with_weight(const SkinWeights& weights) {
  std::vector<bool> has_weight(weights.cols(), false);
  for (int v = 0; v < weights.rows(); ++v)
    for (SkinWeights::InnerIterator it(weights, v); it; ++it)
      if (it.value() > 0) has_weight[it.col()] = true;
  return has_weight;
}

}  // namespace

std::optional<ScaledJoint> most_scaled_joint(const std::vector<Pose>& poses,
                                             const RiggedMesh& rig) {
  const std::vector<bool> has_weight = joints_with_weight(rig.weights);
  ScaledJoint most;
  for (std::size_t f = 0; f < poses.size(); ++f) {
    for (std::size_t j = 0; j < poses[f].size(); ++j) {
      if (!has_weight[j]) continue;
      const Eigen::Vector3d factors =
          Eigen::JacobiSVD<Eigen::Matrix3d>(poses[f][j].linear()).singularValues();
      for (const double factor : {factors[0], factors[2]}) {
        if (std::abs(factor - 1) > std::abs(most.factor - 1))
          most = {static_cast<int>(j), f, factor};
      }
    }
  }
  return std::abs(most.factor - 1) > kRigid ? std::optional(most) : std::nullopt;
}

std::optional<LostJoint> lost_joint(const std::vector<Pose>& poses, const RiggedMesh& rig) {
  std::vector<bool> moves_skin = joints_with_weight(rig.weights);
  for (int j = rig.skeleton.size() - 1; j > 0; --j) {  // parents come first
    const int parent = rig.skeleton.joints[j].parent;
    if (moves_skin[j] && parent >= 0) moves_skin[parent] = true;
  }
  for (std::size_t f = 0; f < poses.size(); ++f) {
    for (std::size_t j = 0; j < poses[f].size(); ++j) {
      if (!moves_skin[j]) continue;
      const bool is_finite = poses[f][j].matrix().allFinite();
      if (is_finite && smallest_scale(poses[f][j].linear()) > kLost) continue;
      return LostJoint{static_cast<int>(j), f, is_finite};
    }
  }
  return std::nullopt;
}

void refuse_lost(const std::string& what, const LostJoint& lost, const Skeleton& skeleton,
                 const std::string& when, const std::string& file) {
  throw Error(what + (lost.is_finite ? " scales joint '" : " has no finite transform of joint '") +
                  skeleton.joints[lost.joint].name + (lost.is_finite ? "' to zero" : "'") + when,
              file,
              "finite scales above zero, of nodes and in clips; joint_scale = \"strip\" plays a "
              "clip without");
}

std::string scale_text(const ScaledJoint& scaled, const Skeleton& skeleton,
                       const std::vector<double>& times_s) {
  return "scales joint '" + skeleton.joints[scaled.joint].name + "' by " +
         rounded_text(scaled.factor) + " at " + rounded_text(times_s[scaled.frame]) + " s";
}

void refuse_scale(const std::string& what, const std::string& file) {
  throw Error(what +
                  ": linear blend would scale the skin, while dual quaternions and the other "
                  "methods turn and move only, so that their numbers would not compare",
              file,
              "a clip without scale, or motion = { joint_scale = \"strip\", … }, which plays this "
              "one without");
}

void make_rigid(const Skeleton& skeleton, Pose& pose) {
  for (std::size_t j = 0; j < pose.size(); ++j) {
    const Eigen::Vector3d head = skeleton.joints[j].head;
    const Eigen::Vector3d posed = pose[j] * head;
    pose[j].linear() = rigid_part(pose[j]).linear();
    pose[j].translation() = posed - pose[j].linear() * head;
  }
}

}  // namespace geoprior::skinning
