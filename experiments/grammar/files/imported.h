#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "models/grammar/hierarchy/hierarchy.h"

namespace geoprior::grammar {

/// A scene of another program as a hierarchy.
struct ImportedScene {
  Hierarchy hierarchy;
  std::vector<std::filesystem::path> files;  ///< the file and its buffers
  std::vector<std::string> warnings;         ///< what was left out
};

/// Reads a glTF 2.0 file (.glb or .gltf): an element a node of the scene that is shown, parents
/// first; several roots get a common root "scene". World z is up: glTF's (x, y, z) becomes
/// (x, -z, y), in the world and in the nodes' own frames, so that an upright node has no turn.
///
/// - Label: the node's name, or that of its mesh, or "node"; made different by "-2", "-3" and on.
/// - Type: the name without numbers at its end ("Bolt.003" and "Bolt" are "Bolt", "bolt_12" is
///   "bolt"), whatever the mesh. Where nodes of a type have different meshes, the parameter
///   `variant` says which one an element has.
/// - Pose: the node's frame in the world without scale and shear, which go into the mesh (a
///   mirrored mesh keeps its triangles' sides outside). Its origin is the node's where that lies
///   within the box of the mesh, else the middle of the box: parts of machines often have theirs
///   far away.
/// - Parameters `stretch_x`, `stretch_y`, `stretch_z` (0.05 … 20, at first 1) scale the mesh along
///   the axes of the frame.
/// - Key points: the 8 corners of the mesh's box, bottom counter-clockwise, then top; all at the
///   origin where a node has no mesh but others of its type have; the origin where none has.
///
/// Skins, animations, morph targets, materials and what is no surface are left out, with a
/// warning: a skinned mesh stands where its node puts it.
/// @param unit_m  of the file (m)
/// @throws Error  naming file and place: what parse_gltf refuses, no nodes, positions that are not
///                finite or beyond 1e9 m, more than 20 million vertices over all nodes
ImportedScene import_gltf(const std::filesystem::path& file, double unit_m);

/// `import_gltf` for the bytes of a self-contained file; `name` is for messages.
ImportedScene import_gltf_bytes(const std::vector<std::byte>& bytes,
                                const std::filesystem::path& name, double unit_m);

}  // namespace geoprior::grammar
