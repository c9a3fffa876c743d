#include "solvers/skinning/field/bones.h"

#include <algorithm>
#include <limits>

namespace geoprior::skinning {
namespace {

struct Segment {
  Eigen::Vector3d head;
  Eigen::Vector3d tail;
};

/// Where the bone of a joint ends: its tail, else the mean of its children's heads, else its head.
Segment bone_segment(const Skeleton& skeleton, const std::vector<int>& children, int joint) {
  const Joint& j = skeleton.joints[joint];
  if (j.tail) return {j.head, *j.tail};
  if (children.empty()) return {j.head, j.head};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const int c : children) sum += skeleton.joints[c].head;
  return {j.head, sum / static_cast<double>(children.size())};
}

/// The joint a vertex belongs to among those allowed, or -1.
int owner_joint(const RiggedMesh& rig, int v, PartitionRule rule,
                const std::vector<Segment>& segments, const std::vector<bool>& allowed) {
  int best = -1;
  double best_score = -std::numeric_limits<double>::infinity();
  for (SkinWeights::InnerIterator it(rig.weights, v); it; ++it) {
    const auto j = it.col();
    if (!allowed[j] || !(it.value() > 0)) continue;
    // The closest bone competes only among joints that matter; 0.05 is the released code's bound.
    double score = it.value();
    if (rule == PartitionRule::closest_bone) {
      const double d = segment_distance(rig.mesh.V.row(v), segments[j].head, segments[j].tail);
      score = it.value() >= 0.05 ? 1 - d : -1e6 - d;
    }
    if (score > best_score) {
      best_score = score;
      best = static_cast<int>(it.col());
    }
  }
  return best;
}

std::vector<std::vector<int>> clusters_of(const std::vector<int>& owner, int joints) {
  std::vector<std::vector<int>> clusters(joints);
  for (int v = 0; v < std::ssize(owner); ++v) {
    if (owner[v] >= 0) clusters[owner[v]].push_back(v);
  }
  return clusters;
}

/// A bone without direction points to the far side of its skin's centroid.
void aim_at_skin(const Eigen::MatrixX3d& V, FieldBone& bone) {
  if ((bone.tail - bone.head).norm() > 0) return;
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  for (const int v : bone.vertices) sum += V.row(v);
  const Eigen::Vector3d centroid = sum.transpose() / static_cast<double>(bone.vertices.size());
  bone.tail = bone.head + 1.5 * (centroid - bone.head);
}

}  // namespace

double segment_parameter(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length2 = ab.squaredNorm();
  return length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0;
}

double segment_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                        const Eigen::Vector3d& b) {
  return (p - a - segment_parameter(p, a, b) * (b - a)).norm();
}

BonePartition partition_bones(const RiggedMesh& rig, PartitionRule rule, double radius_scale) {
  const int joints = rig.skeleton.size();
  const std::vector<std::vector<int>> children = rig.skeleton.children();
  std::vector<Segment> segments;
  for (int j = 0; j < joints; ++j) {
    segments.push_back(bone_segment(rig.skeleton, children[j], j));
  }
  std::vector<bool> allowed(joints, true);
  std::vector<int> owner(rig.mesh.vertex_count());
  std::vector<std::vector<int>> clusters;
  for (bool changed = true; changed;) {
    for (int v = 0; v < std::ssize(owner); ++v) {
      owner[v] = owner_joint(rig, v, rule, segments, allowed);
    }
    clusters = clusters_of(owner, joints);
    changed = false;
    for (std::size_t j = 0; j < clusters.size(); ++j) {
      if (allowed[j] && std::ssize(clusters[j]) < kMinBoneVertices) {
        allowed[j] = false;
        changed = changed || !clusters[j].empty();
      }
    }
  }
  BonePartition result;
  std::vector<int> bone_of_joint(joints, -1);
  for (int j = 0; j < std::ssize(clusters); ++j) {
    if (!allowed[j]) continue;
    FieldBone bone;
    bone.joint = j;
    for (int a = rig.skeleton.joints[j].parent; a >= 0 && bone.parent < 0;
         a = rig.skeleton.joints[a].parent) {
      bone.parent = bone_of_joint[a];
    }
    bone.head = segments[j].head;
    bone.tail = segments[j].tail;
    bone.vertices = std::move(clusters[j]);
    aim_at_skin(rig.mesh.V, bone);
    for (const int v : bone.vertices) {
      bone.radius =
          std::max(bone.radius, segment_distance(rig.mesh.V.row(v), bone.head, bone.tail));
    }
    bone.reach = bone.radius;
    bone.radius *= radius_scale;
    if (!(bone.radius > 0)) continue;
    bone_of_joint[j] = static_cast<int>(result.bones.size());
    result.bones.push_back(std::move(bone));
  }
  for (const FieldBone& bone : result.bones) {
    if (bone.parent >= 0) result.bones[bone.parent].has_children = true;
  }
  result.bone_of_vertex.assign(owner.size(), -1);
  for (std::size_t v = 0; v < owner.size(); ++v) {
    if (owner[v] >= 0) result.bone_of_vertex[v] = bone_of_joint[owner[v]];
  }
  return result;
}

}  // namespace geoprior::skinning
