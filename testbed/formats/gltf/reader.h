#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "testbed/formats/gltf/character.h"

namespace geoprior {

struct GltfReadOptions {
  /// Name of the mesh, or of the node that carries it. Absent: all meshes of the scene that move
  /// with the skeleton of its first used skin; all of the scene when no skin is used.
  std::optional<std::string> mesh;
};

/// Reads a glTF 2.0 file (.glb or .gltf), with or without a skin.
///
/// What is read is the scene that the file shows. The rest pose is the bind pose of the skin,
/// placed in the scene by the transform of the skin's first root joint; without a skin, the meshes
/// placed by their nodes; morph targets are added by their default weights. Heads of joints come
/// from the inverse bind matrices, and with them the joints' own axes; the tail of a joint is the
/// mean of its children's heads; a leaf has none. The parent of a joint is its nearest ancestor
/// that is a joint of the skeleton.
///
/// Several skins share a skeleton when they have joints in common, or joints below a common node; a
/// mesh without skin that hangs on a joint is held to it with weight 1. What else there is, is left
/// out and named in the warnings (selection.h), of meshes with another skeleton also in
/// `other_skins`.
///
/// @throws Error  naming the file and the place in it: anything that is not valid, and a file
///                without triangles
/// Source: Khronos glTF 2.0 specification.
GltfCharacter read_gltf(const std::filesystem::path& file, const GltfReadOptions& options = {});

/// `read_gltf` for the bytes of a self-contained file; `name` is for messages.
GltfCharacter read_gltf_bytes(const std::vector<std::byte>& bytes,
                              const std::filesystem::path& name,
                              const GltfReadOptions& options = {});

}  // namespace geoprior
