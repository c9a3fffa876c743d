#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "core/inputs/trajectory.h"
#include "core/options.h"

namespace geoprior {

/// Position and orientation at a time, as experiment files give it.
struct KeyOptions {
  double t = 0;
  std::array<double, 3> move{0, 0, 0};
  std::array<double, 3> turn_deg{0, 0, 0};
};
void describe(OptionVisitor& v, KeyOptions& options);

/// The list `keys` of something that moves.
void describe_keys(OptionVisitor& v, std::vector<KeyOptions>& keys);

Eigen::Vector3d to_vector(const std::array<double, 3>& a);
Eigen::Quaterniond to_rotation(const std::array<double, 3>& turn_deg);

/// @param where  of the keys, for messages ("scene.handles.1.keys")
/// @throws Error  for half a turn or more from key to key; times are checked by the topic
Trajectory to_trajectory(const std::vector<KeyOptions>& keys, const std::string& where);

}  // namespace geoprior
