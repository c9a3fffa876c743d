#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <vector>

#include "core/geometry/procedural.h"
#include "core/inputs/rig.h"
#include "core/mesh.h"
#include "core/random.h"

// Rigs and poses with known answers, shared by the tests of skinning.

namespace geoprior::skinning::fixtures {

/// The mesh as `Blend` (of a rig, with `deform`) poses it.
template <class Blend>
Eigen::MatrixX3d deformed(const RiggedMesh& rig, const Pose& pose) {
  Eigen::MatrixX3d posed;
  Blend(rig).deform(pose, posed);
  return posed;
}

/// Two-bone cylinder, small enough for exhaustive checks; the ramp is 0.2 m wide.
inline CylinderOptions cylinder_options() {
  CylinderOptions options;
  options.segments = 24;
  options.rings_per_half = 20;
  return options;
}

/// Two-bone cylinder of 5 cm radius, fine enough for profiles of weights.
inline CylinderOptions fine_cylinder_options(int segments, int rings_per_half) {
  CylinderOptions options;
  options.segments = segments;
  options.rings_per_half = rings_per_half;
  options.radius = 0.05;
  return options;
}

/// The cylinder whose vertices belong to one bone or the other, and nothing between: a bend tears
/// it.
inline RiggedMesh torn_cylinder() {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  std::vector<Eigen::Triplet<double>> entries;
  for (int v = 0; v < rig.mesh.vertex_count(); ++v)
    entries.emplace_back(v, rig.mesh.V(v, 0) < 0 ? 0 : 1, 1.0);
  rig.weights.setFromTriplets(entries.begin(), entries.end());
  return rig;
}

/// Turns joint "upper" of the two-bone cylinder by `angle` radians about one of its named axes.
inline Pose turned(const RiggedMesh& rig, const std::string& joint, const std::string& axis,
                   double angle) {
  const int j = rig.skeleton.index_of(joint);
  const Eigen::Vector3d about = rig.skeleton.joints[j].axes.at(axis);
  return pose_from_rotations(rig.skeleton,
                             {{j, Eigen::Quaterniond(Eigen::AngleAxisd(angle, about))}});
}

/// All joints of the finger flexed by the same angle (radians).
inline Pose curled(const RiggedMesh& finger, double angle) {
  std::vector<JointRotation> rotations;
  for (const char* name : {"proximal", "middle", "distal"}) {
    const int j = finger.skeleton.index_of(name);
    const Eigen::Vector3d about = finger.skeleton.joints[j].axes.at("flexion");
    rotations.push_back({j, Eigen::Quaterniond(Eigen::AngleAxisd(angle, about))});
  }
  return pose_from_rotations(finger.skeleton, rotations);
}

/// Largest distance of two point sets, row by row.
inline double largest_distance(const Eigen::MatrixX3d& a, const Eigen::MatrixX3d& b) {
  return (a - b).rowwise().norm().maxCoeff();
}

/// The cylinder with a third to seventh joint that share the weight of "upper": many influences a
/// vertex. All of them move as "upper" does when their transforms are copies of its.
inline RiggedMesh cylinder_of_many_influences(int copies) {
  RiggedMesh rig = two_bone_cylinder(cylinder_options());
  std::vector<Eigen::Triplet<double>> entries;
  RandomStream random(3, "shares");
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    for (SkinWeights::InnerIterator it(rig.weights, v); it; ++it) {
      if (it.col() == 0) {
        entries.emplace_back(v, 0, it.value());
        continue;
      }
      Eigen::VectorXd share(copies + 1);
      for (int c = 0; c <= copies; ++c) share(c) = 0.1 + random.uniform();
      share *= it.value() / share.sum();
      for (int c = 0; c <= copies; ++c) entries.emplace_back(v, 1 + c, share(c));
    }
  }
  for (int c = 0; c < copies; ++c) {
    Joint joint = rig.skeleton.joints[1];
    joint.name = "upper copy " + std::to_string(c);
    rig.skeleton.joints.push_back(joint);
  }
  rig.weights.resize(rig.mesh.vertex_count(), 2 + copies);
  rig.weights.setFromTriplets(entries.begin(), entries.end());
  return rig;
}

/// Largest distance of a vertex from the input in the rest pose, over the diagonal of the bounding
/// box, of three rigs.
template <class Blend>
double rest_pose_error() {
  double largest = 0;
  for (const RiggedMesh& rig :
       {two_bone_cylinder(cylinder_options()), capsule_finger(), cylinder_of_many_influences(5)}) {
    const Eigen::MatrixX3d posed = deformed<Blend>(rig, rest_pose(rig.skeleton.size()));
    largest =
        std::max(largest, largest_distance(posed, rig.mesh.V) / bounding_box_diagonal(rig.mesh.V));
  }
  return largest;
}

}  // namespace geoprior::skinning::fixtures
