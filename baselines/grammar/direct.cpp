#include "baselines/grammar/direct.h"

#include <memory>
#include <utility>

#include "baselines/details/naive_stretch.h"
#include "baselines/skinning/linear_blend/linear_blend.h"
#include "core/context.h"
#include "models/details/surface_walk.h"
#include "models/grammar/objects/surface_set.h"

namespace geoprior::grammar {
namespace {

/// Details where the items are, numbered as the list.
details::DetailScene scene_of_items(const Hierarchy& h, std::vector<int>& items) {
  details::DetailScene scene;
  scene.name = "items on '" + h.label(0) + "'";
  scene.surface.F = h.type(0).triangles;
  const auto points = h.points(0);
  scene.surface.V.resize(static_cast<int>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v)
    scene.surface.V.row(static_cast<int>(v)) = points[v];
  const int type = h.find_type("item");
  for (int e = 0; e < h.size(); ++e) {
    if (h.type_number(e) != type || !h.present(e)) continue;
    items.push_back(e);
    const double b0 = h.parameter(e, ItemParameter::kB0), b1 = h.parameter(e, ItemParameter::kB1);
    details::Detail detail;
    detail.at = {static_cast<int>(h.parameter(e, ItemParameter::kTriangle)), {b0, b1, 1 - b0 - b1}};
    scene.details.push_back(detail);
  }
  scene.motion =
      std::make_shared<details::StoredMotion>(std::vector{scene.surface.V}, std::vector<double>{0});
  return scene;
}

/// Where a detail is: x along its tangent, z along the normal of its face.
Pose pose_of_detail(const details::DetailMesh& d, int i) {
  const details::Detail& detail = d.site[i];
  Eigen::Matrix3d frame;
  frame.col(0) = details::tangent_direction(detail.at.face, detail.tangent_angle, *d.surface, d.x);
  frame.col(2) = details::normal_of_face(detail.at.face, *d.surface, d.x);
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return {d.position[i], Eigen::Quaterniond(frame)};
}

std::vector<Pose> poses_of_details(const details::DetailMesh& d, int count) {
  std::vector<Pose> out;
  for (int i = 0; i < count; ++i) out.push_back(pose_of_detail(d, i));
  return out;
}

}  // namespace

RigidParts::RigidParts(const Hierarchy& rest) : rest_(rest), joint_of_(rest.size(), 0) {
  const int joint_type = rest.find_type("joint");
  for (int e = 0; e < rest.size(); ++e) {
    const int above = e == 0 ? -1 : joint_of_[rest.parent(e)];
    joint_of_[e] = above;
    if (e != 0 && rest.type_number(e) != joint_type) continue;
    joint_of_[e] = skeleton_.size();
    Joint joint;
    joint.name = rest.label(e);
    joint.parent = above;
    joint.head = rest.position(e);
    skeleton_.joints.push_back(std::move(joint));
  }
  pose_ = rest_pose(skeleton_.size());
}

void RigidParts::turn(int element, const Eigen::Quaterniond& rotation) {
  // The joint's rotations multiply in its own axes: with A those that it has in the world by now,
  // W A = A (A^-1 W A).
  const int joint = joint_of_.at(element);
  const Eigen::Quaterniond own(pose_[joint].linear());
  rotations_.push_back({joint, own.conjugate() * rotation * own});
  pose_ = pose_from_rotations(skeleton_, rotations_);
}

Eigen::MatrixX3d RigidParts::skinned(const Eigen::MatrixX3d& points,
                                     const std::vector<int>& element) const {
  RiggedMesh rig;
  rig.mesh.V = points;
  rig.skeleton = skeleton_;
  rig.weights.resize(points.rows(), skeleton_.size());
  rig.weights.reserve(Eigen::VectorXi::Ones(points.rows()));
  for (int i = 0; i < points.rows(); ++i) rig.weights.insert(i, joint_of_[element[i]]) = 1;
  Eigen::MatrixX3d posed;
  skinning::LinearBlend(rig).deform(pose_, posed);
  return posed;
}

Geometry RigidParts::geometry(bool with_surface) const {
  Geometry out = geometry_of(rest_, with_surface);
  out.keys = skinned(out.keys, out.key_element);
  if (with_surface) out.surface.V = skinned(out.surface.V, out.vertex_element);
  return out;
}

void RigidParts::place(Hierarchy& state) const {
  for (int e = 0; e < rest_.size(); ++e) {
    const Eigen::Affine3d& T = pose_[joint_of_[e]];
    state.set_pose(e, {T * rest_.position(e), Eigen::Quaterniond(T.linear()) * rest_.turn(e)});
  }
}

Hierarchy carried_details(const Hierarchy& before, const SpatialMap& map) {
  Hierarchy after = before;
  std::vector<int> items;
  const details::DetailScene scene = scene_of_items(before, items);
  const auto carried = details::make_naive_stretch(scene, {});
  const int count = static_cast<int>(items.size());
  const std::vector<Pose> then = poses_of_details(carried->details(), count);

  Eigen::MatrixX3d V(scene.surface.V.rows(), 3);
  for (int v = 0; v < V.rows(); ++v) {
    const Eigen::Vector3d x = map.at(before.points(0)[v]);
    V.row(v) = x;
    after.points(0)[v] = x;
  }
  RunContext context;
  carried->step(V, context);

  const std::vector<Pose> now = poses_of_details(carried->details(), count);
  for (int i = 0; i < count; ++i) {
    const int e = items[i];
    const Eigen::Quaterniond turn = now[i].turn * then[i].turn.conjugate();
    after.set_pose(e, {now[i].position + turn * (before.position(e) - then[i].position),
                       (turn * before.turn(e)).normalized()});
  }
  return after;
}

}  // namespace geoprior::grammar
