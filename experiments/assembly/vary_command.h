#pragma once

#include <optional>
#include <string>

#include "core/options.h"
#include "testbed/topic.h"

namespace geoprior::assembly {

struct VaryOptions {
  std::string out = "variations";
  int count = 16;
  int boundary = 3;
  int generations = 2;
  std::string keep;
  std::optional<double> gap_m;
};
void describe(OptionVisitor& v, VaryOptions& options);

/// `geoprior vary <scene>`: new assemblies of the parts of a file, each written as a glTF scene; of
/// a glTF scene with its own meshes and materials.
///
/// What is not said is taken from the file: joints may be as far off as the worst of its own, parts
/// that always stand on the floor (the lowest height of the scene) go on standing there, and parts
/// that are not joined may not meet where none of the file's do.
TopicCommand vary_command();

}  // namespace geoprior::assembly
