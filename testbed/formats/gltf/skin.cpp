#include "testbed/formats/gltf/skin.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <set>
#include <sstream>

#include "core/error.h"

namespace geoprior::gltf {
namespace {

std::vector<Eigen::Affine3d> inverse_bind_matrices(const Model& model, const Skin& skin,
                                                   const std::string& where) {
  const std::size_t n = skin.joints.size();
  std::vector<Eigen::Affine3d> result(n, Eigen::Affine3d::Identity());
  if (!skin.inverse_bind_matrices) return result;
  const Accessor& accessor = model.accessors[*skin.inverse_bind_matrices];
  if (accessor.columns != 16 || accessor.component != Component::f32 || accessor.count < n) {
    throw Error("inverse bind matrices are not one float MAT4 for each of the " +
                    std::to_string(n) + " joints",
                where);
  }
  const Eigen::MatrixXd values = decode(model, *skin.inverse_bind_matrices);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Matrix<double, 16, 1> row = values.row(i).transpose();
    const Eigen::Map<const Eigen::Matrix4d> m(row.data());
    const std::string joint = where + ", bind matrix of joint " + std::to_string(i);
    if (!row.allFinite())
      throw Error("not finite, of node '" + model.nodes[skin.joints[i]].name + "'", joint);
    const Eigen::Matrix3d linear = m.topLeftCorner<3, 3>();
    if (is_flat(linear)) {
      throw Error("singular (determinant " + std::to_string(linear.determinant()) + "), of node '" +
                      model.nodes[skin.joints[i]].name + "'",
                  joint, "an invertible matrix");
    }
    if ((m.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > 1e-4)
      throw Error("not affine", joint, "last row 0 0 0 1");
    result[i].linear() = linear;
    result[i].translation() = m.topRightCorner<3, 1>();
  }
  return result;
}

/// Nearest ancestor of a node that is a joint, or -1.
int parent_joint(const Model& model, std::size_t node, const std::vector<int>& joint_of_node) {
  for (auto at = model.nodes[node].parent; at; at = model.nodes[*at].parent) {
    if (joint_of_node[*at] >= 0) return joint_of_node[*at];
  }
  return -1;
}

std::string unique_name(const Node& node, int joint, std::set<std::string>& used) {
  std::string name = node.name.empty() ? "joint-" + std::to_string(joint) : node.name;
  for (int k = 2; !used.insert(name).second; ++k) name = node.name + "-" + std::to_string(k);
  return name;
}

/// Directions at rest of a joint's own axes; absent where they are beyond the numbers' range.
std::optional<Eigen::Matrix3d> unit_axes(const Eigen::Affine3d& from_rest) {
  Eigen::Matrix3d axes = from_rest.linear().inverse();
  axes /= axes.cwiseAbs().maxCoeff();
  axes.colwise().normalize();
  const bool are_unit = ((axes.colwise().norm().array() - 1).abs() < 1e-6).all();
  return are_unit ? std::optional(axes) : std::nullopt;
}

void set_tails(Skeleton& skeleton) {
  const auto children = skeleton.children();
  for (std::size_t j = 0; j < children.size(); ++j) {
    if (children[j].empty()) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int c : children[j]) mean += skeleton.joints[c].head;
    mean /= static_cast<double>(children[j].size());
    const Eigen::Vector3d& head = skeleton.joints[j].head;
    if ((mean - head).norm() > 1e-9 * (1 + head.norm())) skeleton.joints[j].tail = mean;
  }
}

/// Joints of the skins, parents first; returns the joint of each node, or -1.
std::vector<int> make_joints(const Model& model, const std::vector<std::size_t>& skins,
                             RigData& rig) {
  std::vector<bool> is_joint(model.nodes.size(), false);
  for (const std::size_t skin : skins) {
    for (const std::size_t node : model.skins[skin].joints) is_joint[node] = true;
  }
  std::vector<int> joint_of_node(model.nodes.size(), -1);
  std::set<std::string> names;
  for (const std::size_t node : model.node_order) {
    if (!is_joint[node]) continue;
    const int joint = rig.skeleton.size();
    rig.node_of_joint.push_back(node);
    rig.skeleton.joints.push_back({unique_name(model.nodes[node], joint, names),
                                   parent_joint(model, node, joint_of_node),
                                   Eigen::Vector3d::Zero(),
                                   std::nullopt,
                                   {}});
    joint_of_node[node] = joint;
  }
  return joint_of_node;
}

/// What the skins of a rig are bound by.
struct BindPoses {
  const Model& model;
  std::vector<Eigen::Affine3d> world;  ///< of the nodes at rest
  const std::vector<int>& joint_of_node;
};

/// Where the node of a joint that is not bound yet stands in the rest pose: as it does to the
/// nearest joint above it that is; in the scene where there is none.
Eigen::Affine3d node_at_rest(const BindPoses& poses, int joint, const std::vector<bool>& is_bound,
                             const RigData& rig) {
  const Eigen::Affine3d& own = poses.world[rig.node_of_joint[joint]];
  for (int p = rig.skeleton.joints[joint].parent; p >= 0; p = rig.skeleton.joints[p].parent) {
    if (is_bound[p])
      return rig.from_rest[p].inverse() * poses.world[rig.node_of_joint[p]].inverse() * own;
  }
  return own;
}

/// Whether the joints of a skin are bound in the pose of the skeleton: the heads differ by less
/// than a thousandth of its size.
bool is_one_pose(const SkinBinding& skin, const std::vector<int>& joints,
                 const std::vector<Eigen::Vector3d>& heads) {
  Eigen::AlignedBox3d box;
  for (std::size_t k = 0; k < joints.size(); ++k) box.extend(skin.first_to_rest * heads[k]);
  const double size = skin.first_to_rest.linear().norm();
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Eigen::Affine3d& to_rest = skin.to_rest[joints[k]];
    const double moved = (to_rest * heads[k] - skin.first_to_rest * heads[k]).norm();
    const double extent = std::max(box.diagonal().norm(), 1e-3 * box.min().norm());
    if ((to_rest.linear() - skin.first_to_rest.linear()).norm() > 1e-3 * size) return false;
    if (moved > 1e-3 * extent + 1e-9 * size) return false;
  }
  return true;
}

void require_extent(const Eigen::Affine3d& to_rest, const std::string& joint,
                    const std::string& where) {
  if (!to_rest.matrix().allFinite() || is_flat(to_rest.linear())) {
    throw Error("the root joint '" + joint + "' flattens the mesh", where,
                "transforms that can be inverted");
  }
}

/// Binds a skin to the joints of the rig that it has, and binds those that no skin before it had.
void bind_skin(const BindPoses& poses, std::size_t skin_index, std::vector<bool>& is_bound,
               RigData& rig) {
  const Skin& skin = poses.model.skins[skin_index];
  const std::string where = place(poses.model, "/skins/" + std::to_string(skin_index));
  const auto inverse_bind = inverse_bind_matrices(poses.model, skin, where);
  SkinBinding binding;
  binding.to_rest.resize(rig.skeleton.joints.size(), Eigen::Affine3d::Identity());
  std::vector<int> entry_of_joint(rig.skeleton.joints.size(), -1);
  for (std::size_t entry = 0; entry < skin.joints.size(); ++entry) {
    binding.joint_of_entry.push_back(poses.joint_of_node[skin.joints[entry]]);
    entry_of_joint[binding.joint_of_entry.back()] = static_cast<int>(entry);
  }
  std::vector<int> joints;
  std::vector<Eigen::Vector3d> heads;  // in the mesh's coordinates
  std::optional<Eigen::Affine3d> known;
  for (int j = 0; j < rig.skeleton.size() && !known; ++j) {
    if (entry_of_joint[j] >= 0 && is_bound[j])
      known = rig.from_rest[j].inverse() * inverse_bind[entry_of_joint[j]];
  }
  for (int j = 0; j < rig.skeleton.size(); ++j) {
    if (entry_of_joint[j] < 0) continue;
    const Eigen::Affine3d& inverse = inverse_bind[entry_of_joint[j]];
    Eigen::Affine3d& to_rest = binding.to_rest[j];
    if (is_bound[j]) {
      to_rest = rig.from_rest[j].inverse() * inverse;
    } else {
      if (!known) known = node_at_rest(poses, j, is_bound, rig) * inverse;
      to_rest = *known;
    }
    require_extent(to_rest, rig.skeleton.joints[j].name, where);
    if (joints.empty()) binding.first_to_rest = to_rest;
    joints.push_back(j);
    heads.push_back(inverse.inverse().translation());
    if (is_bound[j]) continue;
    rig.skeleton.joints[j].head = to_rest * heads.back();
    rig.from_rest[j] = inverse * to_rest.inverse();
    is_bound[j] = true;
  }
  binding.is_one_pose = is_one_pose(binding, joints, heads);
  rig.skins.push_back(std::move(binding));
}

bool is_weight_type(const Accessor& a) {
  return a.columns == 4 &&
         (a.component == Component::f32 ||
          (a.normalized && (a.component == Component::u8 || a.component == Component::u16)));
}

bool is_joint_type(const Accessor& a) {
  return a.columns == 4 && !a.normalized &&
         (a.component == Component::u8 || a.component == Component::u16);
}

std::size_t attribute(const Primitive& primitive, const std::string& name,
                      const std::string& where) {
  const auto it = primitive.attributes.find(name);
  if (it == primitive.attributes.end()) throw Error("no " + name + " for a skinned mesh", where);
  return it->second;
}

}  // namespace

std::vector<Eigen::Affine3d> world_transforms(const Model& model) {
  std::vector<Eigen::Affine3d> world(model.nodes.size());
  for (const std::size_t i : model.node_order) {
    const Node& node = model.nodes[i];
    Eigen::Affine3d local;
    if (node.matrix) {
      local = *node.matrix;
    } else {
      local = Eigen::Translation3d(node.translation) * node.rotation * Eigen::Scaling(node.scale);
    }
    world[i] = node.parent ? world[*node.parent] * local : local;
    if (!world[i].matrix().allFinite()) {
      throw Error("the transform overflows", place(model, "/nodes/" + std::to_string(i)));
    }
  }
  return world;
}

bool is_flat(const Eigen::Matrix3d& linear) {
  // Relative to the size of the entries: units of a file may be anything.
  const double size = linear.norm();
  return !(std::abs(linear.determinant()) > 1e-9 * size * size * size);
}

void note_scaled_joints(const RigData& rig, std::vector<std::string>& notes) {
  constexpr double kUniform = 1e-3;
  int count = 0, most = 0;
  double largest = 1;
  for (int j = 0; j < rig.skeleton.size(); ++j) {
    const Eigen::Vector3d scales =
        Eigen::JacobiSVD<Eigen::Matrix3d>(rig.from_rest[j].linear()).singularValues();
    const double ratio = scales[0] / scales[2];
    if (!(ratio > 1 + kUniform)) continue;
    ++count;
    if (ratio > largest) most = j;
    largest = std::max(largest, ratio);
  }
  if (count == 0) return;
  std::ostringstream text;
  text << (count == 1 ? "1 joint is" : std::to_string(count) + " joints are")
       << " bound with a scale that differs by direction, '" << rig.skeleton.joints[most].name
       << "' by a factor of " << std::setprecision(4) << largest
       << ": a clip that turns what hangs on it shears the skin, which not every method follows; "
          "apply the scale in the program that wrote the file";
  notes.push_back(text.str());
}

RigData read_rig(const Model& model, const std::vector<std::size_t>& skins) {
  RigData rig;
  const std::vector<int> joint_of_node = make_joints(model, skins, rig);
  rig.from_rest.resize(rig.skeleton.joints.size());
  const BindPoses poses{model, world_transforms(model), joint_of_node};
  std::vector<bool> is_bound(rig.skeleton.joints.size(), false);
  for (const std::size_t skin : skins) bind_skin(poses, skin, is_bound, rig);
  for (int j = 0; j < rig.skeleton.size(); ++j)
    rig.skeleton.joints[j].frame = unit_axes(rig.from_rest[j]);
  set_tails(rig.skeleton);
  validate(rig.skeleton);
  return rig;
}

void read_influences(const Model& model, const Primitive& primitive, const std::string& where,
                     const SkinBinding& skin, int vertex_count, int first_vertex,
                     std::vector<Eigen::Triplet<double>>& triplets, bool& renormalised) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(vertex_count);
  const std::size_t first_triplet = triplets.size();
  for (int set = 0; set == 0 || primitive.attributes.count("WEIGHTS_" + std::to_string(set)) > 0;
       ++set) {
    const std::string suffix = std::to_string(set);
    const std::size_t joints_at = attribute(primitive, "JOINTS_" + suffix, where);
    const std::size_t weights_at = attribute(primitive, "WEIGHTS_" + suffix, where);
    const Accessor& joint_accessor = model.accessors[joints_at];
    const Accessor& weight_accessor = model.accessors[weights_at];
    if (!is_joint_type(joint_accessor) || !is_weight_type(weight_accessor) ||
        joint_accessor.count != static_cast<std::size_t>(vertex_count) ||
        weight_accessor.count != static_cast<std::size_t>(vertex_count)) {
      throw Error("JOINTS_" + suffix + " and WEIGHTS_" + suffix + " do not fit the positions",
                  where, "VEC4 of u8 or u16, and of float or normalised u8 or u16, one a vertex");
    }
    const Eigen::MatrixXd joints = decode(model, joints_at);
    const Eigen::MatrixXd weights = decode(model, weights_at);
    for (int v = 0; v < vertex_count; ++v) {
      for (int k = 0; k < 4; ++k) {
        const double w = weights(v, k);
        const std::string vertex = where + ", vertex " + std::to_string(v);
        if (!std::isfinite(w) || w < 0)
          throw Error("weight " + std::to_string(w), vertex, "finite and >= 0");
        if (w == 0) continue;  // the joint of an unused slot may be anything
        const auto entry = static_cast<std::size_t>(joints(v, k));
        if (entry >= skin.joint_of_entry.size())
          throw Error("joint index " + std::to_string(entry) + " is out of range", vertex,
                      "0 to " + std::to_string(skin.joint_of_entry.size() - 1));
        triplets.emplace_back(first_vertex + v, skin.joint_of_entry[entry], w);
        sums[v] += w;
      }
    }
  }
  for (int v = 0; v < vertex_count; ++v) {
    if (!(sums[v] > 0) || !std::isfinite(1 / sums[v])) {
      throw Error("its weights sum to " + std::to_string(sums[v]),
                  where + ", vertex " + std::to_string(v), "a sum above zero");
    }
    // Quantised weights miss 1 by half a step of 1/255 for each of four influences.
    if (std::abs(sums[v] - 1) > 0.01) renormalised = true;
  }
  for (std::size_t i = first_triplet; i < triplets.size(); ++i) {
    const auto& t = triplets[i];
    triplets[i] = {t.row(), t.col(), t.value() / sums[t.row() - first_vertex]};
  }
}

}  // namespace geoprior::gltf
