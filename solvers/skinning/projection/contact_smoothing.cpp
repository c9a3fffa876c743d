#include "solvers/skinning/projection/contact_smoothing.h"

#include "core/parallel.h"

namespace geoprior::skinning {
namespace {

constexpr std::size_t kSlotsPerTask = 1024;
constexpr float kNegligible = 1e-3F;

void for_slots(SkinState& state, void (*body)(SkinState&, std::size_t)) {
  struct Task {
    SkinState* state;
    void (*body)(SkinState&, std::size_t);
  };
  const Task task{&state, body};
  parallel_blocks(state.size(), kSlotsPerTask, [task](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) task.body(*task.state, s);
  });
}

void diffuse_slot(SkinState& state, std::size_t s) {
  float sum = state.beta[s];
  const int begin = state.ring_offset[s], end = state.ring_offset[s + 1];
  for (int j = begin; j < end; ++j) {
    sum += state.beta[state.ring[j]];
  }
  state.next_beta[s] = sum / static_cast<float>(end - begin + 1);
}

void smooth_slot(SkinState& state, std::size_t s) {
  const Float4 p = state.position[s];
  state.next[s] = p;
  if (state.beta[s] < kNegligible) return;
  Float4 sum{};
  const int begin = state.ring_offset[s], end = state.ring_offset[s + 1];
  for (int j = begin; j < end; ++j) {
    sum += state.position[state.ring[j]];
  }
  if (begin == end) return;
  const Float4 mean = sum / splat(static_cast<float>(end - begin));
  state.next[s] = p + splat(state.beta[s]) * (mean - p);
}

}  // namespace

void diffuse_contact(SkinState& state, int passes) {
  for (int i = 0; i < passes; ++i) {
    for_slots(state, diffuse_slot);
    state.beta.swap(state.next_beta);
  }
}

void smooth_contact(SkinState& state, int passes) {
  for (int i = 0; i < passes; ++i) {
    for_slots(state, smooth_slot);
    state.position.swap(state.next);
  }
}

}  // namespace geoprior::skinning
