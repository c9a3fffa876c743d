#include "core/inputs/skeleton.h"

#include <Eigen/SVD>
#include <cmath>
#include <set>
#include <string>

#include "core/error.h"

namespace geoprior {

int Skeleton::index_of(std::string_view name) const {
  std::string names;
  for (int j = 0; j < std::ssize(joints); ++j) {
    if (joints[j].name == name) return j;
    names += (j == 0 ? "" : ", ") + joints[j].name;
  }
  throw Error("no joint '" + std::string(name) + "'", "skeleton", names);
}

std::vector<std::vector<int>> Skeleton::children() const {
  std::vector<std::vector<int>> result(joints.size());
  for (int j = 0; j < std::ssize(joints); ++j) {
    if (joints[j].parent >= 0) result[joints[j].parent].push_back(j);
  }
  return result;
}

void validate(const Skeleton& skeleton) {
  std::set<std::string_view> names;
  for (int j = 0; j < std::ssize(skeleton.joints); ++j) {
    const Joint& joint = skeleton.joints[j];
    const std::string where = "joint '" + joint.name + "'";
    if (!names.insert(joint.name).second) throw Error("two joints of this name", where);
    if (joint.parent < -1 || joint.parent >= j) {
      throw Error("its parent does not come before it", where);
    }
    if (!joint.head.allFinite() || (joint.tail && !joint.tail->allFinite())) {
      throw Error("head or tail is not finite", where);
    }
    if (joint.tail && (*joint.tail - joint.head).norm() == 0)
      throw Error("a bone of no length", where);
    for (const auto& [name, axis] : joint.axes) {
      if (!(std::abs(axis.norm() - 1) < 1e-6))
        throw Error("axis '" + name + "' is not a unit vector", where);
    }
  }
}

Pose rest_pose(int joint_count) { return Pose(joint_count, Eigen::Affine3d::Identity()); }

Pose pose_from_rotations(const Skeleton& skeleton, const std::vector<JointRotation>& rotations,
                         const Eigen::Vector3d& root_translation) {
  const std::size_t n = skeleton.size();
  std::vector<Eigen::Quaterniond> local(n, Eigen::Quaterniond::Identity());
  for (const JointRotation& r : rotations) {
    auto& q = local.at(r.joint);
    q = q * r.rotation.normalized();
  }
  Pose pose(n);
  for (std::size_t j = 0; j < n; ++j) {
    const Joint& joint = skeleton.joints[j];
    Eigen::Affine3d about_head = Eigen::Affine3d::Identity();
    about_head.linear() = local[j].toRotationMatrix();
    about_head.translation() = joint.head - about_head.linear() * joint.head;
    pose[j] = joint.parent >= 0 ? pose[joint.parent] * about_head
                                : Eigen::Translation3d(root_translation) * about_head;
  }
  return pose;
}

Eigen::Isometry3d rigid_part(const Eigen::Affine3d& transform) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(transform.linear(),
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) = -u.col(2);
  Eigen::Isometry3d rigid = Eigen::Isometry3d::Identity();
  rigid.linear() = u * svd.matrixV().transpose();
  rigid.translation() = transform.translation();
  return rigid;
}

}  // namespace geoprior
