#include "solvers/skinning/field/composition.h"

#include <array>
#include <cmath>

#include "solvers/skinning/field/compact_support.h"

namespace geoprior::skinning {
namespace {

/// p turned about an axis through a point.
Float4 turned(Float4 v, Float4 axis, AxisTurn turn) {
  return splat(turn.cosine) * v + splat(turn.sine) * cross3(axis, v) +
         splat((1 - turn.cosine) * dot3(axis, v)) * axis;
}

/// The rigid motion of a bone: scale and shear are dropped about the image of its head, as in the
/// dual quaternions that the solve starts from.
Eigen::Isometry3d bone_motion(const FieldBone& bone, const Eigen::Affine3d& transform,
                              const Eigen::Matrix3d& rotation) {
  Eigen::Isometry3d rigid = Eigen::Isometry3d::Identity();
  rigid.linear() = rotation;
  rigid.translation() = transform * bone.head - rigid.linear() * bone.head;
  return rigid;
}

/// Bones that one vertex's field is made of: neighbours in the skeleton or in the skin.
std::vector<std::uint8_t> body_parts(const std::vector<int>& parent,
                                     const std::vector<int>& bone_of_vertex,
                                     const VertexGraph& graph, bool everything) {
  const std::size_t n = parent.size();
  std::vector<std::uint8_t> same(n * n, everything ? 1 : 0);
  const auto join = [&](int a, int b) {
    same[a * n + b] = 1;
    same[b * n + a] = 1;
  };
  for (std::size_t b = 0; b < n; ++b) {
    join(static_cast<int>(b), static_cast<int>(b));
    if (parent[b] >= 0) join(static_cast<int>(b), parent[b]);
  }
  for (int v = 0; v < std::ssize(bone_of_vertex); ++v) {
    for (const int w : graph.of(v)) {
      const int a = bone_of_vertex[v], b = bone_of_vertex[w];
      if (a >= 0 && b >= 0) join(a, b);
    }
  }
  return same;
}

/// Numbers of the joints, equal where their transforms are.
void number_groups(const Pose& pose, std::vector<int>& groups) {
  constexpr double kSame = 1e-7;
  groups.clear();
  for (std::size_t j = 0; j < pose.size(); ++j) {
    std::size_t same = 0;
    while (same < j && (pose[same].matrix() - pose[j].matrix()).cwiseAbs().maxCoeff() > kSame)
      ++same;
    groups.push_back(static_cast<int>(same));
  }
}

}  // namespace

FieldComposition::FieldComposition(std::vector<BoneField> fields,
                                   std::vector<JointOperator> operators, SupportKind support,
                                   const std::vector<int>& bone_of_vertex, const VertexGraph& graph,
                                   bool limb_contact)
    : fields_(std::move(fields)), operators_(std::move(operators)), support_(support) {
  for (const BoneField& field : fields_) parent_.push_back(field.bone.parent);
  same_part_ = body_parts(parent_, bone_of_vertex, graph, !limb_contact);
  posed_.resize(fields_.size());
  to_rest_.resize(fields_.size());
}

void FieldComposition::set_pose(const Pose& pose) {
  number_groups(pose, groups_);
  rotations_.resize(pose.size());
  for (std::size_t j = 0; j < pose.size(); ++j) rotations_[j] = rigid_part(pose[j]).linear();
  for (std::size_t b = 0; b < fields_.size(); ++b) {
    const BoneField& field = fields_[b];
    const int joint = field.bone.joint;
    const Eigen::Isometry3d rigid = bone_motion(field.bone, pose[joint], rotations_[joint]);
    const Eigen::Isometry3d inverse = rigid.inverse();
    to_rest_[b] = inverse;
    // An exact field has grid coordinates in metres.
    const double cell = field.cache ? field.cache->cell_size() : 1;
    const Eigen::Vector3d extent =
        field.cache ? field.cache->extent() : Eigen::Vector3d(field.box.high - field.box.low);
    const Eigen::Matrix3d linear = field.box.axes.transpose() * inverse.linear() / cell;
    const Eigen::Vector3d offset =
        (field.box.axes.transpose() * inverse.translation() - field.box.low) / cell;
    PosedBone& posed = posed_[b];
    for (int k = 0; k < 3; ++k) {
      posed.to_grid[k] = to_float4(linear.col(k));
      posed.rotation[k] = to_float4(rigid.linear().col(k));
    }
    posed.to_grid[3] = to_float4(offset);
    posed.translation = to_float4(rigid.translation());
    posed.extent = to_float4(extent);
    posed.centre = posed.extent * 0.5F;
    posed.half_extent = posed.centre;
    const Eigen::Vector3d along = field.bone.tail - field.bone.head;
    const Eigen::Vector3d axis =
        along.norm() > 0 ? Eigen::Vector3d(along.normalized()) : Eigen::Vector3d::UnitX();
    const Eigen::Quaterniond q(rigid.linear());
    posed.head = to_float4(rigid * field.bone.head);
    posed.rest_axis = to_float4(axis);
    posed.axis = to_float4(rigid.linear() * axis);
    posed.quaternion = to_float4(q.vec());
    posed.quaternion[3] = static_cast<float>(q.w());
  }
}

int FieldComposition::bones_near(Float4 low, Float4 high, int* bones) const {
  const Float4 centre = (low + high) * 0.5F;
  const Float4 half = (high - low) * 0.5F;
  int count = 0;
  for (int b = 0; b < std::ssize(posed_); ++b) {
    const PosedBone& posed = posed_[b];
    const Float4 c = posed.to_grid[0] * splat(centre[0]) + posed.to_grid[1] * splat(centre[1]) +
                     posed.to_grid[2] * splat(centre[2]) + posed.to_grid[3] - posed.centre;
    bool meets = true;
    for (int k = 0; k < 3; ++k) {
      const float reach = posed.half_extent[k] + std::abs(posed.to_grid[0][k]) * half[0] +
                          std::abs(posed.to_grid[1][k]) * half[1] +
                          std::abs(posed.to_grid[2][k]) * half[2];
      meets = meets && std::abs(c[k]) <= reach;
    }
    if (meets) bones[count++] = b;
  }
  return count;
}

Float4 FieldComposition::exact_distance(int bone, Float4 p) const {
  const Hrbf::Value v = fields_[bone].hrbf(
      to_rest_[bone] * Eigen::Vector3d(static_cast<double>(p[0]), static_cast<double>(p[1]),
                                       static_cast<double>(p[2])));
  Float4 result = to_float4(v.gradient);
  result[3] = static_cast<float>(v.value);
  return result;
}

bool FieldComposition::sample_bone(int bone, Float4 p, BoneSample& out) const {
  const PosedBone& posed = posed_[bone];
  const Float4 u = posed.to_grid[0] * splat(p[0]) + posed.to_grid[1] * splat(p[1]) +
                   posed.to_grid[2] * splat(p[2]) + posed.to_grid[3];
  const Float4 e = posed.extent;
  if (!(u[0] >= 0 && u[1] >= 0 && u[2] >= 0 && u[0] < e[0] && u[1] < e[1] && u[2] < e[2])) {
    return false;
  }
  const BoneField& field = fields_[bone];
  const Float4 d = field.cache ? field.cache->sample(u) : exact_distance(bone, p);
  if (!(d[3] < 1.0F)) return false;
  const SupportValue f = compact_support(support_, static_cast<double>(d[3]));
  const auto slope = static_cast<float>(f.derivative / field.bone.radius);
  out.f = static_cast<float>(f.value);
  const Float4 outward = posed.rotation[0] * splat(d[0]) + posed.rotation[1] * splat(d[1]) +
                         posed.rotation[2] * splat(d[2]);
  out.gradient = outward * splat(slope);
  out.inward = -outward;
  out.depth = -d[3] * static_cast<float>(field.bone.radius);
  out.bone = bone;
  return true;
}

template <class Take>
void FieldComposition::each_value(std::span<const BoneSample> fields, const Take& take) const {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const BoneSample& child = fields[i];
    take(Composed{child.f, child.gradient, child.bone}, 1.0F);
    const JointOperator& op = operators_[child.bone];
    const int parent = parent_[child.bone];
    if (parent < 0 || op.is_union()) continue;
    for (std::size_t j = 0; j < i; ++j) {  // parents come before children
      const BoneSample& up = fields[j];
      if (up.bone != parent) continue;
      const float lengths = dot3(child.gradient, child.gradient) * dot3(up.gradient, up.gradient);
      if (!(lengths > 0)) break;
      const BlendValue g =
          op(static_cast<double>(child.f), static_cast<double>(up.f),
             static_cast<double>(dot3(child.gradient, up.gradient) / std::sqrt(lengths)));
      take(Composed{static_cast<float>(g.value),
                    splat(static_cast<float>(g.d1)) * child.gradient +
                        splat(static_cast<float>(g.d2)) * up.gradient,
                    child.f > up.f ? child.bone : up.bone},
           static_cast<float>(g.value) - std::max(child.f, up.f));
      break;
    }
  }
}

FieldComposition::Composed FieldComposition::compose(std::span<const BoneSample> fields) const {
  Composed result;
  each_value(fields, [&](const Composed& other, float) {
    if (other.value > result.value) result = other;
  });
  return result;
}

FieldComposition::Composed FieldComposition::compose_smoothly(std::span<const BoneSample> fields,
                                                              float width) const {
  Composed result = compose(fields);
  Float4 sum{};
  float weights = 0;
  each_value(fields, [&](const Composed& other, float above) {
    const float weight =
        smooth_ramp(result.value - width, result.value, other.value) * smooth_ramp(0, width, above);
    sum += splat(weight) * other.gradient;
    weights += weight;
  });
  if (weights > 0) result.gradient = sum / splat(weights);
  return result;
}

FieldAt FieldComposition::at(Float4 p, int owner, std::span<const int> bones) const {
  std::array<BoneSample, kMaxOverlap> own, other;
  std::size_t own_count = 0, other_count = 0;
  FieldAt result;
  const std::uint8_t* part = same_part_.data() + static_cast<std::size_t>(owner) * fields_.size();
  for (const int bone : bones) {
    BoneSample sampled;
    ++result.evaluations;
    if (!sample_bone(bone, p, sampled)) continue;
    if (part[bone] != 0) {
      if (own_count < kMaxOverlap) own[own_count++] = sampled;
    } else if (other_count < kMaxOverlap) {
      other[other_count++] = sampled;
    }
  }
  const Composed inside = compose({own.data(), own_count});
  result.value = inside.value;
  result.gradient = inside.gradient;
  result.bone = inside.bone;
  if (other_count > 0) {
    const Composed outside = compose({other.data(), other_count});
    result.other = outside.value;
    result.other_gradient = outside.gradient;
    result.other_bone = outside.bone;
  }
  return result;
}

AxisTurn FieldComposition::turn_to(int bone, Float4 rotation) const {
  // q_bone* q_vertex, of which the part about the axis is kept (swing-twist decomposition).
  constexpr float kNoTwist = 1e-4F;  // of a half turn across the axis, where it is undefined
  const Float4 q = posed_[bone].quaternion;
  const float w = q[3] * rotation[3] + dot3(q, rotation);
  const Float4 v = splat(q[3]) * rotation - splat(rotation[3]) * q - cross3(q, rotation);
  const float a = dot3(v, posed_[bone].rest_axis);
  const float scale = 1 / (w * w + a * a + kNoTwist);
  return {(w * w - a * a + kNoTwist) * scale, 2 * w * a * scale};
}

int FieldComposition::samples_at(Float4 p, int owner, Float4 rotation, std::span<const int> bones,
                                 BoneSample* out) const {
  const std::uint8_t* part = same_part_.data() + static_cast<std::size_t>(owner) * fields_.size();
  int count = 0;
  for (const int bone : bones) {
    if (count == kMaxOverlap) break;
    if (part[bone] == 0) {
      if (sample_bone(bone, p, out[count])) ++count;
      continue;
    }
    const PosedBone& posed = posed_[bone];
    const AxisTurn turn = turn_to(bone, rotation);
    const Float4 back = posed.head + turned(p - posed.head, posed.axis, {turn.cosine, -turn.sine});
    if (!sample_bone(bone, back, out[count])) continue;
    out[count].gradient = turned(out[count].gradient, posed.axis, turn);
    out[count].inward = turned(out[count].inward, posed.axis, turn);
    ++count;
  }
  return count;
}

float FieldComposition::rest_value(Float4 rest, int bone) const {
  // The field moves rigidly: carry the point along.
  BoneSample sampled;
  return sample_bone(bone, carry(bone, rest), sampled) ? sampled.f : 0.0F;
}

Float4 FieldComposition::carry(int bone, Float4 rest) const {
  return turn(bone, rest) + posed_[bone].translation;
}

float FieldComposition::difference(Float4 p, int a, int b) const {
  BoneSample sa, sb;
  return (sample_bone(a, p, sa) ? sa.f : 0.0F) - (sample_bone(b, p, sb) ? sb.f : 0.0F);
}

}  // namespace geoprior::skinning
