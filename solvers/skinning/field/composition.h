#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/geometry/topology.h"
#include "core/inputs/skeleton.h"
#include "solvers/skinning/field/field_cache.h"
#include "solvers/skinning/field/operators.h"
#include "solvers/skinning/field/sampling.h"

namespace geoprior::skinning {

/// The field of one bone, in the rest pose: samples, HRBF and, unless evaluated exactly, its cache.
struct BoneField {
  FieldBone bone;
  BoneSamples samples;
  Hrbf hrbf;
  FieldBox box;
  std::unique_ptr<FieldCache> cache;
};

/// The composed field at a point, seen by a vertex that belongs to one bone.
struct FieldAt {
  float value = 0;    ///< of the vertex's own part of the body
  Float4 gradient{};  ///< of `value`, 1/m
  int bone = -1;      ///< whose field is largest in `value`; -1 where all fields vanish
  float other = 0;    ///< composed field of the bones that do not belong to that part
  Float4 other_gradient{};
  int other_bone = -1;
  int evaluations = 0;  ///< bone fields sampled
};

/// The field of one bone at a point.
struct BoneSample {
  float f = 0;
  Float4 gradient{};  ///< 1/m
  int bone = -1;
  float depth = 0;  ///< -d: how deep inside (m, as far as d is a distance)
  Float4 inward{};  ///< -grad d
};

/// A turn about a bone's own axis.
struct AxisTurn {
  float cosine = 1;
  float sine = 0;
};

/// The field of a posed skeleton: every bone's field moves rigidly, and
///
///   F = max over bones k of g_k(f_k, f_parent(k)),   grad F = g_1 grad f_k + g_2 grad f_parent
///
/// with the operator g_k of the joint between k and its parent. Folding siblings with max before
/// they meet their parent gives the same value, because the operators grow with both arguments.
/// The derivative of the opening angle is neglected, as in both published sources.
///
/// A vertex of bone b sees in `value` its own part of the body only: b, its neighbours in the
/// skeleton, and bones whose skin touches that of b. Bones outside that part are reported apart
/// (`other`), for the contact between limbs; with `limb_contact` off everything is one part.
class FieldComposition {
 public:
  FieldComposition(std::vector<BoneField> fields, std::vector<JointOperator> operators,
                   SupportKind support, const std::vector<int>& bone_of_vertex,
                   const VertexGraph& graph, bool limb_contact);

  /// Moves the fields. `pose` holds one transform a joint; parts that are not rigid are dropped.
  void set_pose(const Pose& pose);

  /// Rotations of the joints in that pose.
  [[nodiscard]] const std::vector<Eigen::Matrix3d>& rotations() const { return rotations_; }

  /// Joints that move as one in that pose have the same number.
  [[nodiscard]] const std::vector<int>& groups() const { return groups_; }

  /// Bones whose box meets the axis-aligned box [low, high]; writes their indices to `bones`
  /// (room for `bone_count`) and returns how many.
  int bones_near(Float4 low, Float4 high, int* bones) const;

  /// @param owner  bone of the vertex that asks
  [[nodiscard]] FieldAt at(Float4 p, int owner, std::span<const int> bones) const;

  /// Fields of `bones` that are positive at p, in their order. Those of the vertex' own part of the
  /// body are turned about their axes to the vertex' own twist (`turn_to`), so that skin which
  /// slides around a bone meets the section that it left.
  /// @param rotation  of the vertex, unit quaternion (x, y, z, w)
  /// @param out       room for `kMaxOverlap`
  int samples_at(Float4 p, int owner, Float4 rotation, std::span<const int> bones,
                 BoneSample* out) const;
  /// At most this many positive fields are composed at one point; a body has a handful.
  static constexpr int kMaxOverlap = 24;

  /// The operators of all joints applied to fields at one point.
  struct Composed {
    float value = 0;
    Float4 gradient{};
    int bone = -1;
  };
  /// @param fields  sorted by bone
  [[nodiscard]] Composed compose(std::span<const BoneSample> fields) const;
  /// The same value with a gradient that does not jump where another bone becomes the largest: the
  /// mean of all that come within `width` of the value, a blend as far as it is more than the
  /// fields that it blends (where an operator is their maximum, its gradient is one or the other).
  [[nodiscard]] Composed compose_smoothly(std::span<const BoneSample> fields, float width) const;

  /// What a turn of `rotation` against a bone is about that bone's axis.
  [[nodiscard]] AxisTurn turn_to(int bone, Float4 rotation) const;

  /// f_a - f_b at p: zero on the contact surface of two bones.
  [[nodiscard]] float difference(Float4 p, int a, int b) const;

  /// Field of a bone at the rest position of a point.
  [[nodiscard]] float rest_value(Float4 rest, int bone) const;
  /// Where a bone carries a point of the rest pose.
  [[nodiscard]] Float4 carry(int bone, Float4 rest) const;

  /// A rest direction turned with a bone.
  [[nodiscard]] Float4 turn(int bone, Float4 direction) const {
    const PosedBone& posed = posed_[bone];
    return posed.rotation[0] * splat(direction[0]) + posed.rotation[1] * splat(direction[1]) +
           posed.rotation[2] * splat(direction[2]);
  }

  /// Whether one bone is the other's parent.
  [[nodiscard]] bool share_joint(int a, int b) const { return parent_[a] == b || parent_[b] == a; }

  [[nodiscard]] int bone_count() const { return static_cast<int>(fields_.size()); }
  [[nodiscard]] const std::vector<BoneField>& fields() const { return fields_; }
  [[nodiscard]] bool same_part(int a, int b) const {
    return same_part_[static_cast<std::size_t>(a) * fields_.size() + b] != 0;
  }

 private:
  /// Calls take(Composed, above) for every bone and every blend with its parent; `above`: how much
  /// the blend is more than both, 1 of a bone.
  template <class Take>
  void each_value(std::span<const BoneSample> fields, const Take& take) const;
  struct PosedBone {
    Float4 to_grid[4];   // columns of the affine map world -> grid coordinates
    Float4 rotation[3];  // columns, rest -> posed
    Float4 translation;
    Float4 extent;  // grid coordinates of the far corner
    Float4 half_extent;
    Float4 centre;      // of the box, grid coordinates
    Float4 head;        // posed
    Float4 axis;        // posed, unit
    Float4 quaternion;  // of the rotation: x, y, z, w
    Float4 rest_axis;
  };
  [[nodiscard]] bool sample_bone(int bone, Float4 p, BoneSample& out) const;
  [[nodiscard]] Float4 exact_distance(int bone, Float4 p) const;

  std::vector<BoneField> fields_;
  std::vector<JointOperator> operators_;  // of the joint between a bone and its parent
  SupportKind support_;
  std::vector<std::uint8_t> same_part_;  // bones x bones
  std::vector<int> parent_;
  std::vector<Eigen::Matrix3d> rotations_;  // by joint
  std::vector<int> groups_;                 // by joint
  std::vector<PosedBone> posed_;
  std::vector<Eigen::Isometry3d> to_rest_;  // exact evaluation
};

}  // namespace geoprior::skinning
