#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "experiments/skinning/scene/characters.h"

namespace geoprior::skinning::fixtures {

inline Joint joint_at(const std::string& name, int parent, const Eigen::Vector3d& head) {
  return {name, parent, head, std::nullopt, {}};
}

/// Tails at the mean of the children's heads, as a glTF file has them.
inline Skeleton with_tails(Skeleton skeleton) {
  const auto children = skeleton.children();
  for (int j = 0; j < skeleton.size(); ++j) {
    if (children[j].empty()) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int c : children[j]) mean += skeleton.joints[c].head;
    skeleton.joints[j].tail = mean / static_cast<double>(children[j].size());
  }
  return skeleton;
}

/// The body of the repository with its authored axes taken away.
inline Skeleton human_without_axes() {
  Skeleton skeleton = read_skeleton_file(find_input("human.skeleton.toml", ".")).skeleton;
  for (Joint& joint : skeleton.joints) joint.axes.clear();
  return skeleton;
}

inline double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * 180 / M_PI;
}

}  // namespace geoprior::skinning::fixtures
