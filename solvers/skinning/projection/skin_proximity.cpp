#include "solvers/skinning/projection/skin_proximity.h"

#include <algorithm>
#include <cmath>

namespace geoprior::skinning {
namespace {

constexpr int kMostCells = 64;       // along an axis
constexpr float kOpposed = 0.4F;     // cosine of two normals up to which they face each other
constexpr float kCameNearer = 0.5F;  // share of the distance at rest
constexpr float kRim = 0.3F;         // of these limits, within which certainty falls
constexpr float kNearness = 0.1F;    // of the reach: vertices this far count a sixteenth

/// 1 well below a limit, 0 at it.
float below(float x, float limit, float rim) { return smooth_ramp(0, rim, limit - x); }

}  // namespace

int SkinProximity::cell_of(float x, int axis) const {
  return std::clamp(static_cast<int>((x - low_[axis]) / cell_), 0, size_[axis] - 1);
}

void SkinProximity::build(const std::vector<Float4>& position) {
  position_ = &position;
  Float4Bounds bounds;
  for (const Float4 p : position) bounds.include(p);
  low_ = bounds.low;
  const Float4 extent = bounds.high - bounds.low;
  cell_ = std::max({extent[0], extent[1], extent[2], 1e-12F}) / kMostCells;
  for (int k = 0; k < 3; ++k) size_[k] = 1 + static_cast<int>(extent[k] / cell_);
  const auto cells = static_cast<std::size_t>(size_[0]) * size_[1] * size_[2];
  offset_.assign(cells + 1, 0);
  cell_of_slot_.resize(position.size());
  slots_.resize(position.size());
  for (std::size_t s = 0; s < position.size(); ++s) {
    const Float4 p = position[s];
    const int cell = (cell_of(p[2], 2) * size_[1] + cell_of(p[1], 1)) * size_[0] + cell_of(p[0], 0);
    cell_of_slot_[s] = cell;
    ++offset_[static_cast<std::size_t>(cell) + 1];
  }
  for (std::size_t c = 0; c < cells; ++c) offset_[c + 1] += offset_[c];
  cursor_.assign(offset_.begin(), offset_.end() - 1);
  for (int s = 0; s < std::ssize(position); ++s) {
    int& next = cursor_[cell_of_slot_[s]];
    slots_[next++] = s;
  }
}

std::optional<SkinProximity::Facing> SkinProximity::facing(const SkinState& state, std::size_t slot,
                                                           float reach) const {
  const Float4 p = (*position_)[slot];
  const Float4 normal = state.outward[slot];
  const float normal2 = dot3(normal, normal);
  float weights = 0, depths = 0, unsure = 1;
  int begin[3], end[3];
  for (int k = 0; k < 3; ++k) {
    begin[k] = cell_of(p[k] - reach, k);
    end[k] = cell_of(p[k] + reach, k);
  }
  for (int z = begin[2]; z <= end[2]; ++z) {
    for (int y = begin[1]; y <= end[1]; ++y) {
      const int row = (z * size_[1] + y) * size_[0];
      const int first = offset_[row + begin[0]];
      const int last = offset_[row + end[0] + 1];
      for (int i = first; i < last; ++i) {
        const std::size_t other = slots_[i];
        const Float4 way = (*position_)[other] - p;
        const float distance2 = dot3(way, way);
        if (distance2 >= reach * reach) continue;
        const Float4 facing = state.outward[other];
        const float length2 = dot3(facing, facing);
        const float cosine_limit = kOpposed * std::sqrt(normal2 * length2);
        const float product = dot3(normal, facing);
        if (product >= cosine_limit) continue;
        const Float4 at_rest = state.rest[other] - state.rest[slot];
        const float rest2 = dot3(at_rest, at_rest);
        if (distance2 >= kCameNearer * kCameNearer * rest2) continue;
        const float distance = std::sqrt(distance2);
        const float sure = below(product / std::sqrt(normal2 * length2), kOpposed, kRim) *
                           below(distance / std::sqrt(rest2), kCameNearer, kRim * kCameNearer) *
                           below(distance, reach, kRim * reach);
        // The nearest count most, those a few edges farther little.
        const float nearness = kNearness * reach / (distance + kNearness * reach);
        const float weight = sure * nearness * nearness * nearness * nearness;
        weights += weight;
        depths += weight * dot3(way, facing) / std::sqrt(length2);
        unsure *= 1 - sure;
      }
    }
  }
  if (!(weights > 0)) return std::nullopt;
  return Facing{depths / weights, 1 - unsure};
}

}  // namespace geoprior::skinning
