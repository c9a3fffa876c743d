#pragma once

#include <filesystem>
#include <vector>

#include "experiments/grammar/maps/gesture.h"
#include "testbed/topic.h"

namespace geoprior::grammar {

struct ReadGesture {
  Gesture gesture;
  std::vector<std::filesystem::path> files;  ///< the file itself, then the cage's meshes
};

/// A recorded gesture is a TOML file of [[stroke]] tables, a [lattice] and a [cage]:
///
///     [[stroke]]
///     kind   = "grab"            # inflate, twist, bend
///     path_x = [0, 0.2, 0.5]     # of the tool (m)
///     path_y = [0, 0, 0.1]
///     path_z = [5, 5.1, 5.1]
///     radius = 4
///
/// @throws Error  naming file, line and key, and what is allowed
ReadGesture read_gesture_file(const std::filesystem::path& file);
/// Without a cage: files beside it are refused.
Gesture parse_gesture(std::string_view text, const std::string& name);

/// The keys of such files, for `geoprior describe`.
TopicFile gesture_keys();

}  // namespace geoprior::grammar
