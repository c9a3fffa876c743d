#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/inputs/skeleton.h"
#include "core/options.h"
#include "testbed/topic.h"

namespace geoprior::skinning {

struct RigOptions {
  std::optional<std::string> mesh;
  std::optional<double> unit_m;
};
void describe(OptionVisitor& v, RigOptions& options);

/// The skeleton as a skeleton file: every joint with guessed axes, and in comments where they come
/// from and what else they could be. Positions have seven digits.
/// @param title  of the comment at the top
std::string skeleton_file_text(const Skeleton& skeleton, const std::string& title);

/// `geoprior rig <character>`: the skeleton of a skinned glTF file as a skeleton file.
TopicCommand rig_command();

}  // namespace geoprior::skinning
