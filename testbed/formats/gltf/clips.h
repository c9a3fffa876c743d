#pragma once

#include <string>
#include <vector>

#include "testbed/formats/gltf/character.h"
#include "testbed/formats/gltf/model.h"

namespace geoprior::gltf {

/// Clips of the file on nodes renumbered by `node_of_model`.
std::vector<GltfClip> read_clips(const Model& model, const std::vector<int>& node_of_model,
                                 std::vector<std::string>& ignored);

}  // namespace geoprior::gltf
