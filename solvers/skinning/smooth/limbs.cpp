#include "solvers/skinning/smooth/limbs.h"

#include <algorithm>

namespace geoprior::skinning {
namespace {

/// Least local radius, over the largest distance of the bone's skin.
constexpr double kLeastRadius = 0.3;

/// Part of a bone over which its skin goes over from one end to the other.
constexpr float kHeadPart = 0.3F;
constexpr float kTailPart = 0.7F;

/// Means that smooth shares: rings at a joint belong to one bone or the other.
constexpr int kLimbPasses = 5;

/// Length of a bone over the mean radius of its skin: bones of the trunk have less than a short
/// limb, phalanges 2.5 to 3.3, hands 4, arms and legs 4.3 and more. Over the least part of its
/// radius weights spread on a short limb.
constexpr float kTrunk = 2.3F, kShortLimb = 2.6F, kPhalanx = 3.3F, kLongLimb = 4.2F;
constexpr double kLeastSpread = 0.2;

std::vector<double> limb_likeness(const BonePartition& partition, LimbRatios ratios) {
  std::vector<double> likeness;
  for (const FieldBone& bone : partition.bones) {
    const double ratio = (bone.tail - bone.head).norm() / (2 * bone.reach);
    likeness.push_back(
        static_cast<double>(smooth_ramp(ratios.trunk, ratios.limb, static_cast<float>(ratio))));
  }
  return likeness;
}

/// Likeness at the two ends of each bone.
struct EndLikeness {
  std::vector<double> head, tail;
};

EndLikeness at_ends(const BonePartition& partition, const std::vector<double>& limb) {
  EndLikeness ends{limb, limb};
  for (std::size_t b = 0; b < limb.size(); ++b) {
    const int parent = partition.bones[b].parent;
    if (parent < 0) continue;
    const std::size_t p = parent;
    ends.head[b] = std::min(limb[b], limb[p]);
    ends.tail[p] = std::min(ends.tail[p], ends.head[b]);
  }
  return ends;
}

}  // namespace

std::vector<float> limb_shares(const RiggedMesh& rig, const BonePartition& partition,
                               const SkinState& state, LimbRatios ratios) {
  const EndLikeness ends = at_ends(partition, limb_likeness(partition, ratios));
  std::vector<float> shares;
  for (std::size_t s = 0; s < state.size(); ++s) {
    if (state.owner[s] < 0) {
      shares.push_back(0);
      continue;
    }
    const std::size_t b = state.owner[s];
    const FieldBone& bone = partition.bones[b];
    const double along = segment_parameter(rig.mesh.V.row(state.vertex[s]), bone.head, bone.tail);
    const double share =
        static_cast<double>(smooth_ramp(kHeadPart, kTailPart, static_cast<float>(along)));
    shares.push_back(static_cast<float>(ends.head[b] + share * (ends.tail[b] - ends.head[b])));
  }
  smooth_values(shares, state, kLimbPasses);
  return shares;
}

Eigen::VectorXd local_radii(const RiggedMesh& rig, const BonePartition& partition) {
  Eigen::VectorXd radius = Eigen::VectorXd::Zero(rig.mesh.vertex_count());
  for (Eigen::Index v = 0; v < radius.size(); ++v) {
    const int owner = partition.bone_of_vertex[v];
    if (owner < 0) continue;
    const FieldBone& bone = partition.bones[owner];
    radius(v) = std::max(kLeastRadius * bone.reach,
                         segment_distance(rig.mesh.V.row(v), bone.head, bone.tail));
  }
  return radius;
}

Eigen::VectorXd spread_lengths(const RiggedMesh& rig, const BonePartition& partition,
                               ShortLimbs short_limbs) {
  Eigen::VectorXd length = local_radii(rig, partition);
  const double mean = length.sum() / static_cast<double>((length.array() > 0).count());
  std::vector<double> part;
  for (const FieldBone& bone : partition.bones) {
    const double thickness = std::max(length(bone.vertices).mean(), 1e-3 * mean);
    const auto ratio = static_cast<float>((bone.tail - bone.head).norm() / thickness);
    const float limb = smooth_ramp(kTrunk, kShortLimb, ratio);
    const float slim = smooth_ramp(kPhalanx, kLongLimb, ratio);
    const bool less = short_limbs == ShortLimbs::less;
    part.push_back(less ? 1 - (1 - kLeastSpread) * static_cast<double>(limb * (1 - slim)) : 1);
  }
  for (Eigen::Index v = 0; v < length.size(); ++v) {
    const int owner = partition.bone_of_vertex[v];
    length(v) = length(v) > 0 ? length(v) * part[owner] : mean;
  }
  return length;
}

void smooth_values(std::vector<float>& values, const SkinState& state, int passes) {
  std::vector<float> next(values.size());
  for (int i = 0; i < passes; ++i) {
    for (std::size_t s = 0; s < values.size(); ++s) {
      float sum = values[s];
      for (int j = state.ring_offset[s]; j < state.ring_offset[s + 1]; ++j)
        sum += values[state.ring[j]];
      next[s] = sum / static_cast<float>(1 + state.ring_offset[s + 1] - state.ring_offset[s]);
    }
    values.swap(next);
  }
}

}  // namespace geoprior::skinning
