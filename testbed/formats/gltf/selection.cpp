#include "testbed/formats/gltf/selection.h"

#include <algorithm>

#include "core/disjoint_sets.h"
#include "core/error.h"

namespace geoprior::gltf {
namespace {

constexpr std::size_t kShownNames = 12;

std::string mesh_names(const Model& model) {
  std::string names;
  for (std::size_t m = 0; m < model.meshes.size(); ++m) {
    if (m == kShownNames)
      return names + " and " + std::to_string(model.meshes.size() - m) + " more";
    names += (names.empty() ? "" : ", ") + mesh_title(model, m);
  }
  return names;
}

std::size_t vertices_of(const Model& model, const Mesh& mesh) {
  std::size_t count = 0;
  for (const Primitive& primitive : mesh.primitives) {
    const auto positions = primitive.attributes.find("POSITION");
    if (positions != primitive.attributes.end()) count += model.accessors[positions->second].count;
  }
  return count;
}

/// "mesh 'hair' of skin 1, 206 vertices".
std::string left_out(const Model& model, const Node& node) {
  const std::string name = node.name.empty() || node.name == model.meshes[*node.mesh].name
                               ? std::string()
                               : " at node '" + node.name + "'";
  return mesh_title(model, *node.mesh) + name +
         (node.skin ? " of skin " + std::to_string(*node.skin) : std::string()) + ", " +
         std::to_string(vertices_of(model, model.meshes[*node.mesh])) + " vertices";
}

/// Meshes that are left out for one reason.
class LeftOut {
 public:
  explicit LeftOut(std::string reason) : reason_(std::move(reason)) {}

  void add(const Model& model, std::size_t node) {
    if (count_++ < kShownNames)
      list_ += (list_.empty() ? "" : "; ") + left_out(model, model.nodes[node]);
  }
  void note(std::vector<std::string>& notes) const {
    if (count_ == 0) return;
    const std::string more =
        count_ > kShownNames ? "; and " + std::to_string(count_ - kShownNames) + " more" : "";
    notes.push_back("left out, as " + reason_ + ": " + list_ + more);
  }

 private:
  std::string reason_;
  std::string list_;
  std::size_t count_ = 0;
};

std::string scene_title(const Model& model) {
  return model.scene.empty() ? "the file" : model.scene;
}

/// Nodes with a mesh that are shown, or that are asked for by name.
std::vector<std::size_t> candidates(const Model& model, const std::optional<std::string>& mesh,
                                    std::vector<std::string>& notes) {
  std::vector<std::size_t> shown, beyond;
  LeftOut unnamed("mesh = \"" + mesh.value_or("") + "\" names others");
  LeftOut outside(scene_title(model) + " does not show them (mesh = \"…\" reads one all the same)");
  for (const std::size_t i : model.node_order) {
    const Node& node = model.nodes[i];
    if (!node.mesh) continue;
    const bool named = !mesh || node.name == *mesh || model.meshes[*node.mesh].name == *mesh;
    if (!named) {
      unnamed.add(model, i);
    } else {
      (node.in_scene ? shown : beyond).push_back(i);
    }
  }
  if (shown.empty() && beyond.empty() && mesh)
    throw Error("no mesh '" + *mesh + "'", model.file.string(), mesh_names(model));
  if (shown.empty() && beyond.empty()) throw Error("no node has a mesh", model.file.string());
  if (shown.empty() && !mesh) {
    throw Error("no node of " + scene_title(model) + " has a mesh", model.file.string(),
                "mesh = \"…\" for one beyond it: " + mesh_names(model));
  }
  unnamed.note(notes);
  if (shown.empty()) {
    notes.push_back(mesh_title(model, *model.nodes[beyond[0]].mesh) +
                    " is read as it is asked for, though " + scene_title(model) +
                    " does not show it");
    return beyond;
  }
  for (const std::size_t i : beyond) outside.add(model, i);
  outside.note(notes);
  return shown;
}

/// The node without parent above each node.
std::vector<std::size_t> roots_of(const Model& model) {
  std::vector<std::size_t> roots(model.nodes.size());
  for (const std::size_t i : model.node_order) {
    const auto& parent = model.nodes[i].parent;
    roots[i] = parent ? roots[*parent] : i;
  }
  return roots;
}

/// Which skins share a joint, or have a joint below one of the other.
DisjointSets related_skins(const Model& model) {
  std::vector<std::vector<int>> skins_of_node(model.nodes.size());
  for (std::size_t s = 0; s < model.skins.size(); ++s) {
    for (const std::size_t joint : model.skins[s].joints)
      skins_of_node[joint].push_back(static_cast<int>(s));
  }
  DisjointSets sets(static_cast<int>(model.skins.size()));
  std::vector<int> above(model.nodes.size(), -1);  // skin of the nearest joint at or above a node
  for (const std::size_t i : model.node_order) {
    const Node& node = model.nodes[i];
    if (node.parent) above[i] = above[*node.parent];
    for (const int skin : skins_of_node[i])
      above[i] = above[i] < 0 ? skin : sets.join(skin, above[i]);
  }
  return sets;
}

/// Notes skins that are one skeleton by a common node alone: they may be two characters.
void note_unrelated(const Model& model, const std::vector<std::size_t>& skins,
                    std::vector<std::string>& notes) {
  DisjointSets related = related_skins(model);
  const auto first = static_cast<int>(skins[0]);
  std::string others;
  for (const std::size_t skin : skins) {
    if (related.find(static_cast<int>(skin)) != related.find(first))
      others += " and " + std::to_string(skin);
  }
  if (others.empty()) return;
  notes.push_back("skins " + std::to_string(first) + others +
                  " share no joint: they are read as one character, as their joints hang on node "
                  "'" +
                  model.nodes[roots_of(model)[model.skins[skins[0]].joints[0]]].name +
                  "' (mesh = \"…\" reads one)");
}

/// Which skins belong to one skeleton.
DisjointSets skeletons(const Model& model) {
  const std::vector<std::size_t> roots = roots_of(model);
  DisjointSets sets(static_cast<int>(model.skins.size()));
  std::vector<int> skin_of_root(model.nodes.size(), -1);
  for (int s = 0; s < sets.size(); ++s) {
    for (const std::size_t joint : model.skins[s].joints) {
      int& known = skin_of_root[roots[joint]];
      known = known < 0 ? s : sets.join(s, known);
    }
  }
  return sets;
}

/// "skin 1 'dog' of mesh 'dog'".
std::string skin_title(const Model& model, std::size_t node) {
  const std::size_t skin = *model.nodes[node].skin;
  const std::string& name = model.skins[skin].name;
  return "skin " + std::to_string(skin) + (name.empty() ? "" : " '" + name + "'") + " of " +
         mesh_title(model, *model.nodes[node].mesh);
}

/// Orders skins by their topmost joints.
void sort_by_root(const Model& model, std::vector<std::size_t>& skins) {
  std::vector<std::size_t> place(model.nodes.size());
  for (std::size_t k = 0; k < model.node_order.size(); ++k) place[model.node_order[k]] = k;
  const auto topmost = [&](std::size_t skin) {
    std::size_t first = model.nodes.size();
    for (const std::size_t joint : model.skins[skin].joints) first = std::min(first, place[joint]);
    return first;
  };
  std::stable_sort(skins.begin(), skins.end(),
                   [&](std::size_t a, std::size_t b) { return topmost(a) < topmost(b); });
}

/// The joint that each node is, or hangs on.
std::vector<std::optional<std::size_t>> joints_above(const Model& model,
                                                     const std::vector<bool>& is_joint) {
  std::vector<std::optional<std::size_t>> above(model.nodes.size());
  for (const std::size_t i : model.node_order) {
    const auto& parent = model.nodes[i].parent;
    if (is_joint[i]) {
      above[i] = i;
    } else if (parent) {
      above[i] = above[*parent];
    }
  }
  return above;
}

/// The skeleton that is read.
struct OneSkeleton {
  DisjointSets& sets;
  int set = 0;
  std::size_t first_skin = 0;

  [[nodiscard]] bool has(std::size_t skin) const {
    return sets.find(static_cast<int>(skin)) == set;
  }
};

/// Takes the meshes that move with the skeleton, and notes the others.
void take_meshes(const Model& model, const std::vector<std::size_t>& nodes,
                 const OneSkeleton& skeleton, const std::vector<bool>& is_joint,
                 Selection& selection) {
  LeftOut strangers("their skins have joints of another skeleton than skin " +
                    std::to_string(skeleton.first_skin) + " (mesh = \"…\" reads one alone)");
  const auto above = joints_above(model, is_joint);
  LeftOut loose("they have no skin and hang on no joint of the skeleton");
  std::vector<bool> is_named(model.skins.size(), false);
  for (const std::size_t i : nodes) {
    const auto& skin = model.nodes[i].skin;
    if (skin && skeleton.has(*skin)) {
      selection.meshes.push_back({i, skin, std::nullopt});
      if (*skin == skeleton.first_skin && selection.first_skin.empty())
        selection.first_skin = skin_title(model, i);
    } else if (skin) {
      strangers.add(model, i);
      if (!is_named[*skin]) selection.other_skins.push_back(skin_title(model, i));
      is_named[*skin] = true;
    } else if (above[i]) {
      selection.meshes.push_back({i, std::nullopt, above[i]});
    } else {
      loose.add(model, i);
    }
  }
  strangers.note(selection.notes);
  loose.note(selection.notes);
}

}  // namespace

std::string mesh_title(const Model& model, std::size_t mesh) {
  const std::string& name = model.meshes[mesh].name;
  return name.empty() ? "mesh " + std::to_string(mesh) : "mesh '" + name + "'";
}

Selection select_meshes(const Model& model, const std::optional<std::string>& mesh) {
  Selection selection;
  const std::vector<std::size_t> nodes = candidates(model, mesh, selection.notes);
  std::optional<std::size_t> first;
  for (const std::size_t i : nodes) {
    if (!first) first = model.nodes[i].skin;
  }
  if (!first) {
    for (const std::size_t i : nodes) selection.meshes.push_back({i, std::nullopt, std::nullopt});
    return selection;
  }
  DisjointSets sets = skeletons(model);
  const OneSkeleton skeleton{sets, sets.find(static_cast<int>(*first)), *first};
  std::vector<bool> is_used(model.skins.size(), false);
  std::vector<bool> is_joint(model.nodes.size(), false);
  for (const std::size_t i : nodes) {
    const auto& skin = model.nodes[i].skin;
    if (!skin || is_used[*skin] || !skeleton.has(*skin)) continue;
    is_used[*skin] = true;
    selection.skins.push_back(*skin);
    for (const std::size_t joint : model.skins[*skin].joints) is_joint[joint] = true;
  }
  sort_by_root(model, selection.skins);
  note_unrelated(model, selection.skins, selection.notes);
  take_meshes(model, nodes, skeleton, is_joint, selection);
  return selection;
}

}  // namespace geoprior::gltf
