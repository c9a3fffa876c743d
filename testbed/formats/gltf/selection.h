#pragma once

#include <optional>
#include <string>
#include <vector>

#include "testbed/formats/gltf/model.h"

namespace geoprior::gltf {

/// A node whose mesh is read, and what it moves with.
struct ShownMesh {
  std::size_t node = 0;
  std::optional<std::size_t> skin;
  /// Of a mesh without skin in a file with one: the node of the joint that it hangs on.
  std::optional<std::size_t> joint_node;
};

/// What is read of a file.
struct Selection {
  std::vector<ShownMesh> meshes;  ///< parents before children
  std::vector<std::size_t>
      skins;  ///< of one skeleton, that of the topmost joint first; may be none
  std::vector<std::string> notes;  ///< what is left out, by name and size
  /// Of meshes that are left out because their skins are of another skeleton: "skin 1 'dog' of mesh
  /// 'dog'", one a skin.
  std::vector<std::string> other_skins;
  std::string first_skin;  ///< the same of the skin that is read with its skeleton
};

/// The meshes of the scene that is shown, or those that `mesh` names (a mesh or a node; beyond the
/// scene where the scene has none of that name). Of skinned ones: those whose skins have joints of
/// one skeleton with the first, and meshes without skin that hang on a joint of it.
///
/// Skins belong to one skeleton when they share a joint, or when their joints stand below a common
/// node of the file: a joint or not, as an armature of several skeletons.
///
/// @throws Error  naming the file when nothing is left, with the names there are
Selection select_meshes(const Model& model, const std::optional<std::string>& mesh);

/// "mesh 'hair'", or "mesh 3" of one without a name.
std::string mesh_title(const Model& model, std::size_t mesh);

}  // namespace geoprior::gltf
