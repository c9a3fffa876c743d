#include "solvers/skinning/smooth/joint_volumes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "models/skinning/surface_diffusion.h"
#include "solvers/skinning/smooth/limbs.h"

namespace geoprior::skinning {
namespace {

/// Reach of a joint's swelling, in the mean local radius of its flesh: what blended rotations
/// inflate under a raised arm is as wide as the trunk's side.
constexpr double kSwellingReach = 5;

/// Largest swelling and shrinking in that radius: what contact took from a deep fold does not all
/// come out on its other side, which would bulge.
constexpr double kLargestSwelling = 0.18;
constexpr double kLargestShrinking = 0.6;

/// How far from the joint rigid skin is watched, in that radius.
constexpr double kRigidReach = 6;

/// Means over one rings that smooth shares where skin of two bones meets.
constexpr int kSharePasses = 8;
constexpr int kNormalPasses = 20;

/// A bone that goes less far, by the sine of half its turn, shrinks skin on all sides alike: it
/// twists.
constexpr float kLeastWay = 0.03F;

/// Weights that are none, shares of a swelling that are none, and the mobility of rigid skin.
constexpr float kLeastWeight = 1e-6F;
constexpr float kLeastShare = 1e-4F;
constexpr float kRigid = 1e-4F;

constexpr std::size_t kTrianglesOfTask = 2048;

/// Whether each joint is `joint` or hangs on it.
std::vector<bool> subtree(const Skeleton& skeleton, int joint) {
  std::vector<bool> below(skeleton.joints.size(), false);
  for (int j = 0; j < skeleton.size(); ++j) {
    const int parent = skeleton.joints[j].parent;
    below[j] = j == joint || (parent >= 0 && below[parent]);
  }
  return below;
}

/// Of each slot, the weight of the joints that hang on `joint`, itself included.
std::vector<float> weights_below(const Skeleton& skeleton, int joint, const SkinState& state) {
  const std::vector<bool> below = subtree(skeleton, joint);
  std::vector<float> weight(state.size(), 0.0F);
  for (std::size_t s = 0; s < state.size(); ++s) {
    for (int i = state.influence_offset[s]; i < state.influence_offset[s + 1]; ++i)
      if (below[state.influence_joint[i]]) weight[s] += state.influence_weight[i];
  }
  return weight;
}

/// How much each slot is moved by both sides of a joint: w (1 - w) of the weight w below it.
std::vector<float> mobilities(const std::vector<float>& below) {
  std::vector<float> mobility;
  for (const float weight : below) {
    const float w = std::clamp(weight, 0.0F, 1.0F);
    mobility.push_back(w > kLeastWeight && w < 1 - kLeastWeight ? w * (1 - w) : 0.0F);
  }
  return mobility;
}

/// Skin that moves with one of the two bones counts a little, up to `reach` from the joint: contact
/// may press it in.
void add_rigid_skin(std::vector<float>& mobility, const BonePartition& partition,
                    const FieldBone& bone, double reach, const SkinState& state) {
  const Float4 head = to_float4(bone.head);
  for (std::size_t s = 0; s < state.size(); ++s) {
    if (state.owner[s] < 0) continue;
    if (static_cast<double>(length3(state.rest[s] - head)) > reach) continue;
    const int joint = partition.bones[state.owner[s]].joint;
    if (joint == bone.joint || joint == partition.bones[bone.parent].joint) mobility[s] += kRigid;
  }
}

/// Mean of the local radii of the skin that a joint moves (m); 0 where there is none.
double radius_of_flesh(const std::vector<float>& mobility, const std::vector<float>& radius,
                       const Eigen::VectorXd& area, const SkinState& state) {
  double weight = 0, mean = 0;
  for (std::size_t s = 0; s < state.size(); ++s) {
    const double own = static_cast<double>(mobility[s]);
    weight += own * area(state.vertex[s]);
    mean += own * area(state.vertex[s]) * static_cast<double>(radius[s]);
  }
  return weight > 0 ? mean / weight : 0;
}

/// p_j of each slot: 1 at the joint, 0 from `reach` on and where it moves nothing.
std::vector<float> bump_about(const Eigen::Vector3d& head, double reach,
                              const std::vector<float>& mobility, const RiggedMesh& rig,
                              const SkinState& state) {
  std::vector<float> bump(state.size(), 0.0F);
  for (std::size_t s = 0; s < state.size(); ++s) {
    if (!(mobility[s] > 0)) continue;
    const Eigen::Vector3d p = rig.mesh.V.row(state.vertex[s]);
    const double x = (p - head).norm() / reach;
    if (x < 1) bump[s] = static_cast<float>((1 - x * x) * (1 - x * x));
  }
  smooth_values(bump, state, kSharePasses);
  return bump;
}

/// Normals at rest without the detail of the skin.
std::vector<Float4> smooth_normals(const SkinState& state) {
  std::vector<Float4> normal = state.rest_normal, next(normal.size());
  for (int pass = 0; pass < kNormalPasses; ++pass) {
    for (std::size_t s = 0; s < normal.size(); ++s) {
      Float4 sum = normal[s];
      for (int j = state.ring_offset[s]; j < state.ring_offset[s + 1]; ++j)
        sum += normal[state.ring[j]];
      const float length = length3(sum);
      next[s] = length > 0 ? sum / splat(length) : normal[s];
    }
    normal.swap(next);
  }
  return normal;
}

}  // namespace

JointVolumes::JointVolumes(const RiggedMesh& rig, const BonePartition& partition,
                           const SkinState& state, const std::vector<float>& radius)
    : moved_(rig.mesh.F.rows()) {
  const Eigen::VectorXd area = vertex_areas(rig.mesh);
  const std::vector<Float4> outward = smooth_normals(state);
  std::vector<int> slot_of_vertex(rig.mesh.vertex_count(), 0);
  for (std::size_t s = 0; s < state.size(); ++s)
    slot_of_vertex[state.vertex[s]] = static_cast<int>(s);
  for (const FieldBone& bone : partition.bones) {
    if (bone.parent < 0) continue;
    JointFlesh flesh;
    flesh.joint = bone.joint;
    flesh.parent = partition.bones[bone.parent].joint;
    flesh.head = bone.head;
    flesh.along = (bone.tail - bone.head).normalized();
    flesh.place = flesh.parent_place = to_float4(flesh.head);
    std::vector<float> below = weights_below(rig.skeleton, bone.joint, state);
    smooth_values(below, state, kSharePasses);
    std::vector<float> mobility = mobilities(below);
    const double r = radius_of_flesh(mobility, radius, area, state);
    if (!(r > 0)) continue;
    flesh.radius = r;
    add_rigid_skin(mobility, partition, bone, kRigidReach * r, state);
    for (int f = 0; f < static_cast<int>(rig.mesh.F.rows()); ++f) {
      Triangle triangle{};
      triangle.face = f;
      for (int k = 0; k < 3; ++k) {
        triangle.slot[k] = slot_of_vertex[rig.mesh.F(f, k)];
        triangle.below += std::clamp(below[triangle.slot[k]], 0.0F, 1.0F) / 3;
        triangle.mobility += mobility[triangle.slot[k]] / 3;
      }
      if (!(triangle.mobility > 0)) continue;
      triangle.rest = cone(flesh, triangle, state.rest);
      flesh.triangles.push_back(triangle);
    }
    const std::vector<float> bump =
        bump_about(flesh.head, kSwellingReach * r, mobility, rig, state);
    for (std::size_t s = 0; s < state.size(); ++s) {
      if (bump[s] > kLeastShare) {
        flesh.swellings.push_back(
            {static_cast<int>(s), bump[s], static_cast<float>(area(state.vertex[s])), outward[s]});
      }
    }
    joints_.push_back(std::move(flesh));
  }
}

float JointVolumes::cone(const JointFlesh& flesh, const Triangle& triangle,
                         const std::vector<Float4>& position) {
  const Float4 tip =
      flesh.parent_place + splat(triangle.below) * (flesh.place - flesh.parent_place);
  return dot3(position[triangle.slot[0]] - tip,
              cross3(position[triangle.slot[1]] - tip, position[triangle.slot[2]] - tip));
}

double JointVolumes::lost(const JointFlesh& flesh, const std::vector<Float4>& position) {
  const std::size_t count = flesh.triangles.size();
  partial_.assign((count + kTrianglesOfTask - 1) / kTrianglesOfTask, 0.0);
  parallel_blocks(count, kTrianglesOfTask, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& t = flesh.triangles[i];
      const float share = t.mobility * flesh.turn / moved_[t.face];
      sum += static_cast<double>(share * (t.rest - cone(flesh, t, position)));
    }
    partial_[begin / kTrianglesOfTask] = sum;
  });
  return std::accumulate(partial_.begin(), partial_.end(), 0.0) / 6;
}

void JointVolumes::set_pose(const FieldComposition& field, const Pose& pose,
                            const std::vector<Float4>& rotations) {
  std::fill(moved_.begin(), moved_.end(), 0.0F);
  for (JointFlesh& flesh : joints_) {
    flesh.bends = field.groups()[flesh.joint] != field.groups()[flesh.parent];
    flesh.swelling = 0;
    if (!flesh.bends) continue;
    const Eigen::Matrix3d& own = field.rotations()[flesh.joint];
    const Eigen::Matrix3d& parent = field.rotations()[flesh.parent];
    flesh.place = to_float4(pose[flesh.joint] * flesh.head);
    flesh.parent_place = to_float4(pose[flesh.parent] * flesh.head);
    flesh.turn = static_cast<float>(std::max(0.0, 3 - own.cwiseProduct(parent).sum())) + 1e-12F;
    for (const Triangle& t : flesh.triangles) moved_[t.face] += t.mobility * flesh.turn;
    // Where the bone went, as long as the sine of half the turn.
    const Float4 inner = to_float4((own - parent) * flesh.along / 2);
    set_ways(flesh, inner, rotations);
  }
}

void JointVolumes::set_ways(JointFlesh& flesh, const Float4& inner,
                            const std::vector<Float4>& rotations) {
  const float length = std::max(length3(inner), kLeastWay);
  flesh.growing = flesh.shrinking = 0;
  for (Swelling& swelling : flesh.swellings) {
    const Float4 outward = turned(rotations[swelling.slot], swelling.outward);
    const float along = dot3(inner, outward);
    // Skin of the inner side has nowhere to go; what is too much is on the outer one.
    const float inside = std::max(0.0F, along);
    const float outside = std::max(0.0F, (1 - along / length) / 2);
    const float grow = swelling.share * std::exp(-inside * inside);
    const float shrink = swelling.share * outside;
    swelling.grow = splat(grow) * outward;
    swelling.shrink = splat(shrink) * outward;
    flesh.growing += static_cast<double>(grow * swelling.area);
    flesh.shrinking += static_cast<double>(shrink * swelling.area);
  }
}

bool JointVolumes::restore(std::vector<Float4>& base, std::vector<Float4>& position) {
  bool bends = false;
  for (JointFlesh& flesh : joints_) {
    if (!flesh.bends || !(flesh.growing > 0) || !(flesh.shrinking > 0)) continue;
    bends = true;
    const double before = flesh.swelling;
    const double given = before * (before > 0 ? flesh.growing : flesh.shrinking);
    const double wanted = given + lost(flesh, position);
    flesh.swelling = std::clamp(wanted / (wanted > 0 ? flesh.growing : flesh.shrinking),
                                -kLargestShrinking * flesh.radius, kLargestSwelling * flesh.radius);
    const double now = flesh.swelling;
    const auto grown = static_cast<float>(std::max(now, 0.0) - std::max(before, 0.0));
    const auto shrunk = static_cast<float>(std::min(now, 0.0) - std::min(before, 0.0));
    for (const Swelling& swelling : flesh.swellings) {
      const Float4 way = splat(grown) * swelling.grow + splat(shrunk) * swelling.shrink;
      base[swelling.slot] += way;
      position[swelling.slot] += way;
    }
  }
  return bends;
}

}  // namespace geoprior::skinning
