#include "experiments/skinning/scene/skeleton_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "core/error.h"
#include "experiments/skinning/scene/literal_axis.h"
#include "testbed/formats/text/nesting.h"
#include "testbed/formats/text/text_file.h"

namespace geoprior::skinning {
namespace {

std::string place(const std::string& name, const toml::source_region& source) {
  return name + ":" + std::to_string(source.begin.line);
}

toml::table parse(std::string_view text, const std::string& name) {
  require_shallow_toml(text, name);
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& e) {
    throw Error("no valid TOML: " + std::string(e.description()), place(name, e.source()));
  }
}

/// Members of a table in the order of the file (toml++ sorts them by name).
std::vector<std::pair<std::string, const toml::node*>> in_file_order(const toml::table& table) {
  std::vector<std::pair<std::string, const toml::node*>> members;
  for (const auto& [key, node] : table) members.emplace_back(key.str(), &node);
  const auto position = [](const toml::node& node) {
    const auto& begin = node.source().begin;
    return std::pair(begin.line, begin.column);
  };
  std::stable_sort(members.begin(), members.end(), [&](const auto& a, const auto& b) {
    return position(*a.second) < position(*b.second);
  });
  return members;
}

/// A TOML value with its key and place, for messages.
struct Value {
  const toml::node& node;
  std::string key;
  const std::string& file;

  [[noreturn]] void fail(const std::string& problem, const std::string& allowed) const {
    throw Error("'" + key + "' " + problem, place(file, node.source()), allowed);
  }
  [[nodiscard]] const toml::table& table() const {
    if (!node.is_table()) fail("is no table", "a table");
    return *node.as_table();
  }
  [[nodiscard]] std::string text() const {
    if (!node.is_string()) fail("is no string", "a string");
    return node.as_string()->get();
  }
  [[nodiscard]] bool flag() const {
    if (!node.is_boolean()) fail("is no boolean", "true or false");
    return node.as_boolean()->get();
  }
  [[nodiscard]] double number() const {
    const auto x = node.is_number() ? node.value<double>() : std::nullopt;
    if (!x || !std::isfinite(*x)) fail("is no finite number", "a number");
    return *x;
  }
  [[nodiscard]] Eigen::Vector3d vector() const {
    const toml::array* array = node.as_array();
    if (array == nullptr || array->size() != 3) fail("is no vector", "[x, y, z]");
    Eigen::Vector3d x;
    for (std::size_t i = 0; i < 3; ++i) x[i] = Value{*array->get(i), key, file}.number();
    return x;
  }
};

Eigen::Vector3d parse_axis(const Value& value) {
  if (!value.node.is_string()) {
    const Eigen::Vector3d axis = value.vector();
    if (!(axis.norm() > 1e-9) || !std::isfinite(axis.norm())) {
      value.fail("has no direction", "[x, y, z] with a length");
    }
    return axis.normalized();
  }
  const std::optional<LiteralAxis> literal = parse_literal_axis(value.text());
  if (!literal || literal->is_local) value.fail("is no axis", "\"+x\" … \"-z\" or [x, y, z]");
  return literal->direction;
}

/// A joint before the joints are sorted.
struct Entry {
  Joint joint;
  std::optional<std::string> parent;
  std::optional<std::string> bvh;
  bool bvh_align = true;
  std::string place;
};

Entry parse_joint(const std::string& name, const Value& value) {
  Entry entry;
  entry.joint.name = name;
  entry.place = place(value.file, value.node.source());
  bool has_head = false;
  for (const auto& [key, node] : in_file_order(value.table())) {
    const Value member{*node, key, value.file};
    if (key == "parent") {
      entry.parent = member.text();
    } else if (key == "head") {
      entry.joint.head = member.vector();
      has_head = true;
    } else if (key == "tail") {
      entry.joint.tail = member.vector();
    } else if (key == "axes") {
      for (const auto& [axis, axis_node] : in_file_order(member.table())) {
        const Value axis_value{*axis_node, axis, value.file};
        if (parse_literal_axis(axis)) axis_value.fail("means itself", "another name");
        entry.joint.axes[axis] = parse_axis(axis_value);
      }
    } else if (key == "bvh") {
      entry.bvh = member.text();
    } else if (key == "bvh_align") {
      entry.bvh_align = member.flag();
    } else {
      std::string keys;
      for (const OptionRow& row : skeleton_keys().keys)
        keys += (keys.empty() ? "" : ", ") + row.key;
      member.fail("is no key of a joint", keys);
    }
  }
  if (!has_head) throw Error("joint '" + name + "' has no 'head'", entry.place, "head = [x, y, z]");
  if (entry.joint.tail && (*entry.joint.tail - entry.joint.head).norm() == 0)
    throw Error("head and tail of joint '" + name + "' coincide", entry.place,
                "a bone with a length, or no tail");
  return entry;
}

/// Adds a joint after its ancestors. `state`: 0 new, 1 being visited, 2 done.
void add_with_ancestors(const std::map<std::string, std::size_t>& by_name,
                        const std::vector<Entry>& entries, std::size_t first,
                        std::vector<int>& state, std::vector<int>& index, SkeletonFile& result) {
  std::vector<std::size_t> chain;
  for (std::optional<std::size_t> at = first; at && state[*at] != 2;) {
    const Entry& entry = entries[*at];
    if (state[*at] == 1)
      throw Error("joint '" + entry.joint.name + "' is its own ancestor", entry.place);
    state[*at] = 1;
    chain.push_back(*at);
    if (!entry.parent) break;
    const auto parent = by_name.find(*entry.parent);
    if (parent == by_name.end()) {
      throw Error("no joint '" + *entry.parent + "', the parent of '" + entry.joint.name + "'",
                  entry.place, "the joints of the file");
    }
    at = parent->second;
  }
  for (auto it = chain.rbegin(); it != chain.rend(); ++it) {
    const Entry& entry = entries[*it];
    Joint joint = entry.joint;
    joint.parent = entry.parent ? index[by_name.at(*entry.parent)] : -1;
    index[*it] = result.skeleton.size();
    result.skeleton.joints.push_back(std::move(joint));
    result.bvh_joint.push_back(entry.bvh);
    result.bvh_align.push_back(entry.bvh_align);
    state[*it] = 2;
  }
}

/// The joints sorted, parents first.
SkeletonFile assemble(const std::vector<Entry>& entries) {
  std::map<std::string, std::size_t> by_name;
  for (std::size_t i = 0; i < entries.size(); ++i) by_name[entries[i].joint.name] = i;
  SkeletonFile result;
  std::vector<int> state(entries.size(), 0);
  std::vector<int> index(entries.size(), -1);
  for (std::size_t i = 0; i < entries.size(); ++i)
    add_with_ancestors(by_name, entries, i, state, index, result);
  validate(result.skeleton);
  return result;
}

}  // namespace

TopicFile skeleton_keys() {
  return {
      "skeleton",
      "joints of a character: where they are, how they turn, what of a motion capture file "
      "drives them; `geoprior rig` writes one",
      "[joint.<name>]",
      {{"parent", "text", "", "", "", "joint that it hangs on; absent: a root"},
       {"head", "3 numbers", "required", "", "m", "where it turns, in the mesh's coordinates"},
       {"tail", "3 numbers", "", "", "m", "end of its bone; absent: no bone of its own"},
       {"axes", "table", "", "", "",
        "name = axis: \"+x\" … \"-z\" of the mesh, or [x, y, z] of any length; a positive angle "
        "turns right-handed"},
       {"bvh", "text", "", "", "", "joint of a motion capture file that drives it"},
       {"bvh_align", "boolean", "true", "", "",
        "turn the rest bone into the direction of the file's bone first"}}};
}

TopicFile pose_keys() {
  return {"poses",
          "poses by joint angles, in the order of the file",
          "[pose.<name>]",
          {{"<joint>", "table", "", "", "deg",
            std::string("axis = angle; axes: names of the skeleton file, ") + kLiteralAxes +
                "; angles of one joint turn in the order of the file"}}};
}

std::optional<int> find_joint(const Skeleton& skeleton, const std::string& name) {
  for (int j = 0; j < skeleton.size(); ++j) {
    if (skeleton.joints[j].name == name) return j;
  }
  return std::nullopt;
}

SkeletonFile parse_skeleton(std::string_view text, const std::string& name) {
  const toml::table root = parse(text, name);
  std::vector<Entry> entries;
  for (const auto& [key, node] : in_file_order(root)) {
    const Value value{*node, key, name};
    if (key != "joint") value.fail("is no key of a skeleton file", "[joint.<name>] tables");
    for (const auto& [joint, joint_node] : in_file_order(value.table()))
      entries.push_back(parse_joint(joint, {*joint_node, joint, name}));
  }
  if (entries.empty()) throw Error("no joints", name, "[joint.<name>] tables");
  return assemble(entries);
}

SkeletonFile with_kept_joints(const SkeletonFile& file, const Skeleton& own,
                              const std::vector<bool>& kept, const std::string& name) {
  const auto is_there = [&](int j) {
    return kept[j] || find_joint(file.skeleton, own.joints[j].name);
  };
  const auto nearest_ancestor = [&](int j, const auto& accepted) -> std::optional<std::string> {
    for (j = own.joints[j].parent; j >= 0; j = own.joints[j].parent) {
      if (accepted(j)) return own.joints[j].name;
    }
    return std::nullopt;
  };
  std::vector<Entry> entries;
  for (int i = 0; i < file.skeleton.size(); ++i) {
    const Joint& joint = file.skeleton.joints[i];
    Entry entry{joint, std::nullopt, file.bvh_joint[i], file.bvh_align[i], name};
    if (joint.parent >= 0) entry.parent = file.skeleton.joints[joint.parent].name;
    const std::optional<int> namesake = find_joint(own, joint.name);
    if (namesake) entry.joint.frame = own.joints[*namesake].frame;
    if (namesake && !entry.parent) {
      entry.parent = nearest_ancestor(*namesake, [&](int j) { return kept[j]; });
    }
    entries.push_back(std::move(entry));
  }
  for (int j = 0; j < own.size(); ++j) {
    if (kept[j]) entries.push_back({own.joints[j], nearest_ancestor(j, is_there), {}, true, name});
  }
  return assemble(entries);
}

SkeletonFile read_skeleton_file(const std::filesystem::path& file) {
  return parse_skeleton(read_text_file(file), file.string());
}

std::vector<NamedPose> parse_poses(std::string_view text, const std::string& name) {
  const toml::table root = parse(text, name);
  std::vector<NamedPose> poses;
  for (const auto& [key, node] : in_file_order(root)) {
    const Value value{*node, key, name};
    if (key != "pose") value.fail("is no key of a pose file", "[pose.<name>] tables");
    for (const auto& [pose, pose_node] : in_file_order(value.table())) {
      poses.push_back({pose, {}});
      const Value pose_value{*pose_node, pose, name};
      for (const auto& [joint, joint_node] : in_file_order(pose_value.table())) {
        const Value joint_value{*joint_node, joint, name};
        for (const auto& [axis, angle] : in_file_order(joint_value.table()))
          poses.back().angles.push_back({joint, axis, Value{*angle, axis, name}.number()});
      }
    }
  }
  if (poses.empty()) throw Error("no poses", name, "[pose.<name>] tables");
  return poses;
}

std::vector<NamedPose> read_pose_file(const std::filesystem::path& file) {
  return parse_poses(read_text_file(file), file.string());
}

Eigen::Vector3d joint_axis(const Skeleton& skeleton, const std::string& joint,
                           const std::string& axis) {
  const Joint& found = skeleton.joints[skeleton.index_of(joint)];
  const auto it = found.axes.find(axis);
  if (it != found.axes.end()) return it->second;
  if (const auto literal = parse_literal_axis(axis)) return rest_direction(*literal, found);
  std::string names;
  for (const auto& [name, direction] : found.axes) names += name + ", ";
  throw Error(
      "no axis '" + axis + "'", "joint '" + joint + "'",
      names + kLiteralAxes + (names.empty() ? ", or a name that a skeleton file gives" : ""));
}

JointRotation joint_rotation(const Skeleton& skeleton, const JointAngle& angle) {
  const Eigen::Vector3d axis = joint_axis(skeleton, angle.joint, angle.axis);
  const double radians = angle.angle_deg * std::numbers::pi / 180;
  return {skeleton.index_of(angle.joint), Eigen::Quaterniond(Eigen::AngleAxisd(radians, axis))};
}

}  // namespace geoprior::skinning
