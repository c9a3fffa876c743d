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
