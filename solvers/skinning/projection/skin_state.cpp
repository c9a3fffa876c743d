#include "solvers/skinning/projection/skin_state.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace geoprior::skinning {
namespace {

/// Spreads the lowest 20 bits of x over every third bit.
std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0xFFFFF;
  x = (x | (x << 32)) & 0x001F00000000FFFFULL;
  x = (x | (x << 16)) & 0x001F0000FF0000FFULL;
  x = (x | (x << 8)) & 0x100F00F00F00F00FULL;
  x = (x | (x << 4)) & 0x10C30C30C30C30C3ULL;
  x = (x | (x << 2)) & 0x1249249249249249ULL;
  return x;
}

std::vector<std::uint64_t> morton_codes(const Eigen::MatrixX3d& V) {
  const Eigen::RowVector3d low = V.colwise().minCoeff();
  const double extent = std::max(1e-30, (V.colwise().maxCoeff() - low).maxCoeff());
  std::vector<std::uint64_t> codes;
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) {
      const double x = (V(v, k) - low(k)) / extent * 0xFFFFF;
      code |= spread_bits(static_cast<std::uint64_t>(x)) << k;
    }
    codes.push_back(code);
  }
  return codes;
}

}  // namespace

SkinState::SkinState(const RiggedMesh& rig, const VertexGraph& graph,
                     const std::vector<int>& bone_of_vertex) {
  const std::size_t n = rig.mesh.vertex_count();
  const std::vector<std::uint64_t> codes = morton_codes(rig.mesh.V);
  vertex.resize(n);
  std::iota(vertex.begin(), vertex.end(), 0);
  const auto bone_of = [&](int v) { return bone_of_vertex[v]; };
  std::stable_sort(vertex.begin(), vertex.end(), [&](int a, int b) {
    if (bone_of(a) != bone_of(b)) return bone_of(a) < bone_of(b);
    return codes[a] < codes[b];
  });
  std::vector<int> slot_of(n);
  for (std::size_t s = 0; s < n; ++s) {
    slot_of[vertex[s]] = static_cast<int>(s);
  }
  ring_offset.push_back(0);
  for (std::size_t s = 0; s < n; ++s) {
    owner.push_back(bone_of(vertex[s]));
    for (const int w : graph.of(vertex[s])) ring.push_back(slot_of[w]);
    ring_offset.push_back(static_cast<int>(ring.size()));
  }
  influence_offset.push_back(0);
  for (const int v : vertex) {
    for (SkinWeights::InnerIterator it(rig.weights, v); it; ++it) {
      influence_joint.push_back(static_cast<int>(it.col()));
      influence_weight.push_back(static_cast<float>(it.value()));
    }
    influence_offset.push_back(static_cast<int>(influence_joint.size()));
  }
  ring_weight.assign(ring.size(), 0);
  iso.assign(n, 0);
  rest_other.assign(n, 0);
  start.assign(n, Float4{});
  next = outward = rest_normal = last_position = gradient = start;
  for (const int v : vertex) {
    const Eigen::Vector3f at = rig.mesh.V.row(v).transpose().cast<float>();
    rest.push_back(Float4{at.x(), at.y(), at.z(), 0.0F});
  }
  position = rest;
  last_bone.assign(n, -1);
  contact_bone.assign(n, -1);
  stop.assign(n, VertexStop::active);
  beta.assign(n, 0);
  next_beta.assign(n, 0);
  active.resize(n);
  const std::size_t blocks = (n + kBlock - 1) / kBlock;
  active_count.assign(blocks, 0);
  evaluations.assign(blocks, 0);
  live_blocks.reserve(blocks);
}

void SkinState::activate() {
  live_blocks.clear();
  for (std::size_t b = 0; b < block_count(); ++b) {
    const std::size_t begin = b * kBlock, end = std::min(size(), begin + kBlock);
    std::size_t count = 0;
    for (std::size_t s = begin; s < end; ++s) {
      if (owner[s] < 0) {
        stop[s] = VertexStop::no_field;
        continue;
      }
      stop[s] = VertexStop::active;
      last_bone[s] = -1;
      active[begin + count++] = static_cast<int>(s);
    }
    active_count[b] = static_cast<int>(count);
    if (count > 0) live_blocks.push_back(static_cast<int>(b));
  }
}

void SkinState::drop_dead_blocks() {
  std::erase_if(live_blocks, [&](int b) { return active_count[b] == 0; });
}

}  // namespace geoprior::skinning
