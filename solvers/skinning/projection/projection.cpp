#include "solvers/skinning/projection/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace geoprior::skinning {
namespace {

constexpr std::size_t kLiveBlocksPerTask = 4;

/// Stride of a vertex that leaves the far side of a fold, over the longest step.
constexpr float kWalk = 0.5F;

/// Cosine between the inward gradient and the outward normal above which a vertex is on that side.
constexpr float kAgainst = 0.5F;

/// Rest field of a bone above which a vertex is near enough for that test to mean anything.
constexpr float kNear = 0.25F;

}  // namespace

Projection::Projection(const FieldComposition& field, const ImplicitOptions& options)
    : field_(field),
      step_(static_cast<float>(options.step)),
      max_step_(static_cast<float>(options.max_step)),
      stop_cos_(static_cast<float>(std::cos(options.stop_angle_deg * std::numbers::pi / 180))),
      tolerance_(static_cast<float>(options.tolerance)),
      gap_(static_cast<float>(options.contact_gap)),
      bisect_(options.bisect_at_stop),
      leave_far_side_(options.leave_far_side),
      stop_on_growth_(options.stop_on_growth) {}

Projection::Target Projection::target_of(const SkinState& state, std::size_t slot,
                                         const FieldAt& at) const {
  const float iso = state.iso[slot];
  const float excess = at.other + gap_ - std::max(0.0F, state.rest_other[slot] + gap_ - iso);
  return excess > iso ? Target{excess, true} : Target{iso, false};
}

FieldAt Projection::field_of(const SkinState& state, std::size_t slot, Float4 p) const {
  std::array<int, kMaxFieldBones> bones;
  const int count = field_.bones_near(p, p, bones.data());
  return field_.at(p, state.owner[slot], {bones.data(), static_cast<std::size_t>(count)});
}

void Projection::record_rest(SkinState& state) const {
  for (std::size_t s = 0; s < state.size(); ++s) {
    if (state.owner[s] < 0) continue;
    const FieldAt at = field_of(state, s, state.position[s]);
    state.iso[s] = at.value;
    state.rest_other[s] = at.other;
    state.gradient[s] = at.gradient;
    const float slope = length3(at.gradient);
    state.rest_normal[s] = slope > 0 ? -xyz(at.gradient) / splat(slope) : Float4{};
  }
}

void Projection::step(SkinState& state) const {
  struct Task {
    const Projection* self;
    SkinState* state;
  };
  const Task task{this, &state};
  parallel_blocks(state.live_blocks.size(), kLiveBlocksPerTask,
                  [task](std::size_t begin, std::size_t end) {
                    for (std::size_t b = begin; b < end; ++b) {
                      task.self->step_block(*task.state, task.state->live_blocks[b]);
                    }
                  });
  state.drop_dead_blocks();
}

void Projection::step_block(SkinState& state, std::size_t block) const {
  const std::size_t begin = block * SkinState::kBlock;
  const std::size_t count = state.active_count[block];
  Float4Bounds bounds;
  for (std::size_t i = begin; i < begin + count; ++i) {
    bounds.include(state.position[state.active[i]]);
  }
  std::array<int, kMaxFieldBones> bones;
  const int near = field_.bones_near(bounds.low, bounds.high, bones.data());
  const std::span<const int> reach{bones.data(), static_cast<std::size_t>(near)};
  std::size_t kept = begin;
  std::int64_t evaluations = 0;
  for (std::size_t i = begin; i < begin + count; ++i) {
    const std::size_t slot = state.active[i];
    const FieldAt at = field_.at(state.position[slot], state.owner[slot], reach);
    evaluations += at.evaluations;
    if (step_vertex(state, slot, at)) state.active[kept++] = static_cast<int>(slot);
  }
  state.active_count[block] = static_cast<int>(kept - begin);
  state.evaluations[block] += evaluations;
}

bool Projection::step_vertex(SkinState& state, std::size_t slot, const FieldAt& at) const {
  const float slope2 = dot3(at.gradient, at.gradient);
  const int owner = state.owner[slot];
  const auto radius = static_cast<float>(field_.fields()[owner].bone.radius);
  const Float4 last = state.gradient[slot];
  const bool has_last = state.last_bone[slot] >= 0;
  const Target target = target_of(state, slot, at);
  const float error = at.value - target.value;
  if (leave_far_side_ && error > tolerance_ && on_far_side(state, slot, at)) {
    walk_out(state, slot, at.bone);
    return true;
  }
  if (!has_last && at.value == 0) return enter_field(state, slot);
  if (has_last) {
    const float cos_times_lengths = dot3(last, at.gradient);
    if (cos_times_lengths < stop_cos_ * std::sqrt(slope2 * dot3(last, last))) {
      stop_in_contact(state, slot, at.bone);
      return false;
    }
  }
  state.contact_bone[slot] = target.in_contact ? at.other_bone : -1;
  if (std::abs(error) < tolerance_) {
    state.stop[slot] = VertexStop::converged;
    return false;
  }
  const Float4 direction = target.in_contact ? at.gradient - at.other_gradient : at.gradient;
  const float length2 = dot3(direction, direction);
  if (!(length2 * radius * radius > 1e-8F) || !(slope2 > 0)) {
    state.stop[slot] = VertexStop::no_field;
    return false;
  }
  if (stop_on_growth_ && has_last && std::abs(error) > std::abs(last[3])) {
    state.position[slot] = state.last_position[slot];
    state.stop[slot] = VertexStop::pit;
    return false;
  }
  const float length = std::sqrt(length2);
  const float distance =
      std::clamp(step_ * error / length, -max_step_ * radius, max_step_ * radius);
  state.last_position[slot] = state.position[slot];
  state.position[slot] -= xyz(direction) * splat(distance / length);
  state.gradient[slot] = at.gradient;
  state.gradient[slot][3] = error;
  state.last_bone[slot] = at.bone;
  return true;
}

bool Projection::enter_field(SkinState& state, std::size_t slot) const {
  const Float4 carried = field_.carry(state.owner[slot], state.rest[slot]);
  const Float4 moved = carried - state.position[slot];
  if (!(dot3(moved, moved) > 0)) {
    state.stop[slot] = VertexStop::no_field;
    return false;
  }
  state.position[slot] = carried;
  return true;
}

bool Projection::on_far_side(const SkinState& state, std::size_t slot, const FieldAt& at) const {
  const int owner = state.owner[slot];
  if (at.bone < 0 || (at.bone != owner && !field_.share_joint(at.bone, owner))) return false;
  if (field_.rest_value(state.rest[slot], at.bone) < kNear) return false;
  const float against = dot3(at.gradient, field_.turn(at.bone, state.rest_normal[slot]));
  return against > kAgainst * length3(at.gradient);
}

void Projection::walk_out(SkinState& state, std::size_t slot, int bone) const {
  const int owner = state.owner[slot];
  const Float4 normal = state.rest_normal[slot];
  const Float4 out =
      bone == owner ? state.outward[slot] : field_.turn(owner, normal) + field_.turn(bone, normal);
  const float length = length3(out);
  const auto radius_of = [&](int b) { return field_.fields()[b].bone.radius; };
  const auto radius = static_cast<float>(std::min(radius_of(owner), radius_of(bone)));
  if (length > 0) state.position[slot] += out * splat(kWalk * max_step_ * radius / length);
  state.gradient[slot] = Float4{};
  state.last_bone[slot] = -1;
}

void Projection::stop_in_contact(SkinState& state, std::size_t slot, int bone_now) const {
  state.stop[slot] = VertexStop::contact;
  state.beta[slot] = 1;
  const int before = state.last_bone[slot];
  state.contact_bone[slot] = bone_now;
  Float4 a = state.last_position[slot];
  Float4 b = state.position[slot];
  if (!bisect_ || bone_now < 0 || bone_now == before) {
    state.position[slot] = a;
    return;
  }
  // f_before - f_now falls from positive at a to negative at b: find its zero.
  for (int i = 0; i < 6; ++i) {
    const Float4 middle = (a + b) * 0.5F;
    (field_.difference(middle, before, bone_now) > gap_ ? a : b) = middle;
  }
  state.position[slot] = (a + b) * 0.5F;
}

}  // namespace geoprior::skinning
