#include "experiments/skinning/scene/scene.h"

#include <algorithm>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "experiments/skinning/scene/scene_view.h"
#include "testbed/given_tables.h"

namespace geoprior::skinning {
namespace {

/// A joint whose region is measured, and the axis it bends about (zero when there is no single
/// one).
struct Hinge {
  int joint = 0;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
};

std::vector<Hinge> hinges_of(const SkinningSceneOptions& options, const Skeleton& skeleton,
                             const Motion& motion) {
  std::vector<Hinge> hinges;
  const auto axis_of = [&](int joint) -> Eigen::Vector3d {
    for (std::size_t i = 0; i < motion.turned_joints.size(); ++i)
      if (motion.turned_joints[i] == joint) return motion.turned_axes[i];
    return Eigen::Vector3d::Zero();
  };
  if (options.regions.empty()) {
    for (const int joint : motion.turned_joints) hinges.push_back({joint, axis_of(joint)});
  }
  for (const std::string& name : options.regions) {
    const int joint = skeleton.index_of(name);
    hinges.push_back({joint, axis_of(joint)});
  }
  // A root has no bone on its near side: it turns the whole body and has no region.
  std::erase_if(hinges, [&](const Hinge& h) { return skeleton.joints[h.joint].parent < 0; });
  return hinges;
}

/// Groups of hinges that are parent and child, in the order of their first members.
std::vector<std::vector<Hinge>> group_neighbours(const std::vector<Hinge>& hinges,
                                                 const Skeleton& skeleton) {
  std::vector<std::size_t> group(hinges.size());
  for (std::size_t i = 0; i < hinges.size(); ++i) group[i] = i;
  const auto parent = [&](std::size_t i) { return skeleton.joints[hinges[i].joint].parent; };
  for (std::size_t i = 0; i < hinges.size(); ++i) {
    for (std::size_t k = 0; k < hinges.size(); ++k) {
      if (parent(i) != hinges[k].joint) continue;
      const std::size_t from = std::max(group[i], group[k]);
      const std::size_t to = std::min(group[i], group[k]);
      std::replace(group.begin(), group.end(), from, to);
    }
  }
  std::vector<std::vector<Hinge>> groups(hinges.size());
  for (std::size_t i = 0; i < hinges.size(); ++i) groups[group[i]].push_back(hinges[i]);
  std::erase_if(groups, [](const std::vector<Hinge>& g) { return g.empty(); });
  return groups;
}

JointRegion make_region(const RiggedMesh& rig, const std::vector<Hinge>& group, double extent) {
  std::string name;
  std::vector<int> joints;
  std::vector<Eigen::Vector3d> axes;
  for (const Hinge& h : group) {
    name += (name.empty() ? "" : "+") + rig.skeleton.joints[h.joint].name;
    joints.push_back(h.joint);
    axes.push_back(h.axis);
  }
  return make_joint_region(rig, name, joints, axes, extent);
}

/// A joint that turns and has no skin about it (a link of a machine) is measured by the whole body
/// alone, with a warning; a region that was asked for has to be there.
std::vector<JointRegion> make_regions(const SkinningSceneOptions& options, const RiggedMesh& rig,
                                      const Motion& motion, std::vector<std::string>& warnings) {
  std::vector<JointRegion> regions;
  const auto hinges = hinges_of(options, rig.skeleton, motion);
  for (const std::vector<Hinge>& group : group_neighbours(hinges, rig.skeleton)) {
    try {
      regions.push_back(make_region(rig, group, options.region_extent));
    } catch (const NoSkinAboutJoint& e) {
      if (!options.regions.empty()) throw;
      warnings.push_back(std::string(e.what()) + ": no region of it is measured");
    }
  }
  return regions;
}

}  // namespace

void describe(OptionVisitor& v, SkinningSceneOptions& options) {
  describe(v, options.character);
  describe_group(v, "motion", options.motion, {.doc = "what the character does"});
  v.value("regions", options.regions,
          {.doc = "joints whose regions are measured; empty: those that a ramp turns"});
  v.value("region_extent", options.region_extent,
          {.doc = "half length of a measured region along the bones, in local radii",
           .min = 0.1,
           .max = 20});
}

std::map<std::string, double> SkinningScene::facts() const {
  return {{"vertices", rig.mesh.vertex_count()},
          {"triangles", rig.mesh.triangle_count()},
          {"input_vertices", input_mesh.vertex_count()},
          {"joints", rig.skeleton.size()},
          {"influences",
           static_cast<double>(rig.weights.nonZeros()) / std::max(1, rig.mesh.vertex_count())},
          {"cap_triangles", cap_triangles},
          {"boundary_edges", static_cast<double>(boundary_edges(rig.mesh.F).size())},
          {"regions", static_cast<double>(regions.size())},
          {"unit_m", unit_m}};
}

const Pose& SkinningScene::pose_at(double parameter) const {
  const auto it = std::find(frame_parameter.begin(), frame_parameter.end(), parameter);
  if (it == frame_parameter.end()) {
    throw Error("the motion has no frame at " + parameter_label + " " + std::to_string(parameter),
                "scene", std::to_string(frame_parameter.size()) + " frames of the motion");
  }
  return frame_pose[it - frame_parameter.begin()];
}

std::shared_ptr<SkinningScene> load_skinning_scene(const SkinningSceneOptions& options,
                                                   const std::filesystem::path& folder) {
  auto scene = std::make_shared<SkinningScene>();
  Character character = load_character(options.character, folder);
  Motion motion = make_motion(options.motion, character, folder);
  scene->regions = make_regions(options, character.rig, motion, character.warnings);
  scene->bending_view = bending_camera(character.rig, motion, scene->regions);
  scene->rig = std::move(character.rig);
  scene->cap_triangles = character.cap_triangles;
  scene->input_mesh = std::move(character.input_mesh);
  scene->welded_of_input = std::move(character.welded_of_input);
  scene->frame_parameter = std::move(motion.parameters);
  scene->frame_pose = std::move(motion.poses);
  scene->parameter_label = std::move(motion.parameter_name);
  scene->parameter_unit_label = std::move(motion.parameter_unit);
  scene->unit_m = character.unit_m;
  scene->input_files = std::move(character.files);
  scene->input_files.insert(scene->input_files.end(), motion.files.begin(), motion.files.end());
  scene->load_warnings = std::move(character.warnings);
  scene->load_warnings.insert(scene->load_warnings.end(), motion.warnings.begin(),
                              motion.warnings.end());
  return scene;
}

Frame SkinningScene::given() const {
  Frame frame;
  Part& surface = frame.parts["surface"];
  surface.points = rig.mesh.V;
  surface.triangles = rig.mesh.F;
  surface.arrays.push_back({"weights", "1", NamedArray::On::points, Eigen::MatrixXd(rig.weights)});

  Part& bones = frame.parts["bones"];
  bones.kind = Part::Kind::lines;
  const int joints = rig.skeleton.size();
  bones.points.resize(2 * joints, 3);
  NamedArray joint{"joint", "1", NamedArray::On::cells, Eigen::MatrixXd(joints, 1)};
  NamedArray parent{"parent", "1", NamedArray::On::cells, Eigen::MatrixXd(joints, 1)};
  for (int j = 0; j < joints; ++j) {
    const Joint& one = rig.skeleton.joints[j];
    bones.points.row(2 * j) = one.head.transpose();
    bones.points.row(2 * j + 1) = one.tail.value_or(one.head).transpose();
    bones.lines.push_back({2 * j, 2 * j + 1});
    joint.values(j, 0) = j;
    joint.names.push_back(one.name);
    parent.values(j, 0) = one.parent;
  }
  bones.arrays = {std::move(joint), std::move(parent)};

  TableBuilder transforms(with_transform_columns({"frame", "joint"}));
  for (std::size_t f = 0; f < frame_pose.size(); ++f) {
    for (std::size_t j = 0; j < frame_pose[f].size(); ++j) {
      transforms.add(
          with_transform({static_cast<double>(f), static_cast<double>(j)}, frame_pose[f][j]));
    }
  }
  frame.tables["transforms"] = transforms.finished();
  return frame;
}

std::vector<PartShape> SkinningScene::frame_shape() const {
  return {{"surface", Part::Kind::triangles, rig.mesh.vertex_count(), rig.mesh.F}};
}

}  // namespace geoprior::skinning
