#include "baselines/skinning/shared/influences.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/error.h"

namespace geoprior::skinning {
namespace {

struct Influence {
  std::uint16_t joint;
  float weight;
};

/// Influences of a vertex, strongest first (equal weights: smaller joint first), zeros dropped.
void sorted_influences(const SkinWeights& weights, int vertex, std::vector<Influence>& result) {
  result.clear();
  double sum = 0;
  for (SkinWeights::InnerIterator it(weights, vertex); it; ++it) sum += it.value();
  for (SkinWeights::InnerIterator it(weights, vertex); it; ++it) {
    const auto w = static_cast<float>(it.value() / sum);
    if (w > 0) result.push_back({static_cast<std::uint16_t>(it.col()), w});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
}

}  // namespace

void require_skinnable(const RiggedMesh& rig) {
  validate(rig.weights, rig.mesh.vertex_count(), rig.skeleton.size());
  if (rig.skeleton.size() > std::numeric_limits<std::uint16_t>::max())
    throw Error("too many joints", "skeleton", "at most 65535");
  for (int v = 0; v < rig.mesh.vertex_count(); ++v) {
    if (!rig.mesh.V.row(v).allFinite())
      throw Error("position is not finite", "vertex " + std::to_string(v));
  }
}

PackedInfluences::PackedInfluences(const RiggedMesh& rig)
    : vertex_count(rig.mesh.vertex_count()), joint_count(rig.skeleton.size()) {
  require_skinnable(rig);
  const int blocks = (vertex_count + kLanes - 1) / kLanes;
  std::array<std::vector<Influence>, kLanes> lane;
  std::size_t total_slots = 0;
  for (int b = 0; b < blocks; ++b) {
    if (b % kChunkBlocks == 0) chunk_slots.push_back(total_slots);
    std::array<int, kLanes> vertex{};
    std::size_t slot_count = 1;
    for (std::size_t l = 0; l < kLanes; ++l) {
      vertex[l] = std::min(b * kLanes + static_cast<int>(l), vertex_count - 1);
      sorted_influences(rig.weights, vertex[l], lane[l]);
      slot_count = std::max(slot_count, lane[l].size());
    }
    for (int k = 0; k < 3; ++k) {
      for (const int v : vertex) rest.push_back(rig.mesh.V(v, k));
    }
    slots.push_back(static_cast<std::uint16_t>(slot_count));
    total_slots += slot_count;
    for (std::size_t s = 0; s < slot_count; ++s) {
      for (const std::vector<Influence>& of : lane) {
        // An unused slot repeats the strongest joint with weight 0: no extra cache line is touched.
        joints.push_back(s < of.size() ? of[s].joint : of.front().joint);
        if (s > 0) weights.push_back(s < of.size() ? of[s].weight : 0.0F);
      }
    }
  }
  const auto bytes = static_cast<double>(rest.size() * sizeof(double) + slots.size() * 2 +
                                         joints.size() * 2 + weights.size() * sizeof(float));
  bytes_per_vertex = vertex_count > 0 ? bytes / vertex_count + 3 * sizeof(double) : 0;
}

}  // namespace geoprior::skinning
