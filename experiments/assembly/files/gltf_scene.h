#pragma once

#include <Eigen/Core>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/assembly/files/read_result.h"
#include "models/assembly/graph/ported_graph.h"
#include "testbed/formats/gltf/model.h"

namespace geoprior::assembly {

/// The nodes of the source that show one kind of part.
struct GltfTypeNodes {
  std::string label;
  std::vector<int> nodes;  ///< the part's own first, parents before children
  /// Of the part's node in the scene, along its own axes (glTF's): poses of parts are rigid.
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

/// A glTF document whose buffers and images all lie in one binary chunk, and which of its nodes
/// stand for which part. What only moves or looks at the scene (animations, skins, cameras) is
/// gone; meshes, materials, textures, samplers, lights and their extensions are as they were.
struct GltfScene {
  std::string file;  ///< for messages
  std::shared_ptr<const nlohmann::json> document;
  std::string binary;
  std::vector<GltfTypeNodes> types;  ///< by the numbers of the catalogue
};

/// Carries vectors of glTF's world (y up) to ours (z up): (x, y, z) to (x, -z, y). Blender's
/// exporter does the inverse, so that our world is that of Blender.
Eigen::Matrix3d z_up_of_gltf();

/// Gathers a document: every buffer and every image, whether a data URI or a file beside it, goes
/// into the one chunk. `types` stays empty.
///
/// Extensions of nodes and of the document are kept where they refer to no node (lights, material
/// variants, metadata), and left out otherwise (levels of detail; instancing, too, as its copies
/// are not read): nodes are renumbered when a scene is written. Extensions of buffers and their
/// views are left out, as they say how the data are compressed, and what is gathered is the plain
/// fallback.
///
/// @param document  the JSON that `model` was parsed from
/// @param read      gets warnings of what is left out, and the images' files
/// @throws Error  naming file and JSON pointer: an image of an unknown kind, one that is not there,
///                or is another file where `other_files_allowed` is false
GltfScene gather_gltf(const nlohmann::json& document, const gltf::Model& model,
                      bool other_files_allowed, ReadAssemblies& read);

/// The bytes of a .glb. @throws Error  naming `name`, over 4 GB
std::string glb_bytes(const nlohmann::json& document, std::string_view binary,
                      const std::string& name);

/// The bytes of a .glb that shows an assembly with the meshes and materials of the source: the
/// nodes of each part are copies of those of its type, the part's own with the matrix of the
/// part's pose and named "<label>", "<label>.001" and on, as Blender names copies. Ports are
/// written, too, so that the file is read again as the same graph.
///
/// @throws Error  naming source and part: no parts, a type that the source has not, a pose that is
///                not finite; over 4 GB
std::string assembly_glb(const GltfScene& scene, const Assembly& assembly);

}  // namespace geoprior::assembly
