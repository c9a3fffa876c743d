#include "solvers/skinning/smooth/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/parallel.h"

namespace geoprior::skinning {
namespace {

/// Of the local radius: what is asked below is none.
constexpr float kNothing = 1e-5F;

/// Of the local radius: a displacement that is no more than this is not kept for the next pose.
constexpr float kKept = 1e-4F;

// What a field may ask, and when it is believed: ours, found on the joints of the body and the
// finger; ramps, because a threshold would make skin jump.

/// Smaller demands of a section fade out, larger ones are bounded; in local radii.
constexpr float kDeadZone = 0.01F;
constexpr float kLargestDemand = 0.5F;

/// Length of a bone over the thickness of its skin: up to the first its field says nothing of the
/// section (a part of the trunk), from the second on it says all (a limb).
constexpr LimbRatios kKnownSections{1.0F, 1.4F};

/// Cosine of gradient and skinned normal: a field is not believed up to the first (beyond a medial
/// axis they part), entirely from the second on.
constexpr float kDisagrees = 0.3F;
constexpr float kAgrees = 0.8F;

/// Cosine of the other field's gradient and the skinned normal: no contact up to the first, a whole
/// one from the second on.
constexpr float kTurnedAway = -0.5F;
constexpr float kFacing = 0.0F;

/// Excess over contact along a way, over its length: two depths, each of which grows by little
/// more.
constexpr float kSteepest = 3;

/// Length of a mean of unit directions below which they contradict each other.
constexpr float kNoWay = 0.05F;

/// Own depth, in local radii, from which on both sides of a contact yield alike.
constexpr float kOwnDepth = 0.1F;

/// Fields of bones whose values are no farther apart share the direction of what is asked.
constexpr float kSameField = 0.05F;

/// Slope of a field, over a local radius, up to which it does not say where the surface is.
constexpr float kFlat = 0.02F;

/// How far below contact another bone's field begins to silence the own one, in local radii.
constexpr float kCrowd = 0.5F;

/// Means over one rings that smooth radii: rings at a joint belong to one bone or the other.
constexpr int kPreparationPasses = 5;

constexpr std::size_t kBlocksOfTask = 4;
constexpr std::size_t kSlotsOfTask = 512;

/// Local radii of the slots.
std::vector<float> slot_radii(const RiggedMesh& rig, const BonePartition& partition,
                              const SkinState& state) {
  const Eigen::VectorXd of_vertex = local_radii(rig, partition);
  std::vector<float> radius;
  for (const int v : state.vertex) radius.push_back(static_cast<float>(of_vertex(v)));
  smooth_values(radius, state, kPreparationPasses);
  return radius;
}

/// Normalised weighted mean of the joints' quaternions, with the signs of dual quaternion blending.
Float4 blended_rotation(const SkinState& state, std::size_t s,
                        const std::vector<Float4>& rotations) {
  Float4 sum{}, pivot{};
  float largest = -1;
  for (int i = state.influence_offset[s]; i < state.influence_offset[s + 1]; ++i) {
    if (state.influence_weight[i] <= largest) continue;
    largest = state.influence_weight[i];
    pivot = rotations[state.influence_joint[i]];
  }
  for (int i = state.influence_offset[s]; i < state.influence_offset[s + 1]; ++i) {
    const Float4 q = rotations[state.influence_joint[i]];
    const float same = dot3(q, pivot) + q[3] * pivot[3];
    sum += splat(same < 0 ? -state.influence_weight[i] : state.influence_weight[i]) * q;
  }
  return sum / splat(std::sqrt(dot3(sum, sum) + sum[3] * sum[3]));
}

std::size_t end_of_block(const SkinState& state, std::size_t block) {
  return std::min(state.size(), (block + 1) * SkinState::kBlock);
}

Float4Bounds bounds_of(const SkinState& state, std::size_t block) {
  Float4Bounds bounds;
  for (std::size_t s = block * SkinState::kBlock; s < end_of_block(state, block); ++s)
    bounds.include(state.position[s]);
  return bounds;
}

/// Joints that move a block's vertices, and those of the bones about it at rest. Empty for a block
/// none of whose vertices has a bone.
std::vector<int> joints_about(const SkinState& state, const FieldComposition& field,
                              std::size_t block) {
  std::vector<int> joints;
  bool owned = false;
  for (std::size_t s = block * SkinState::kBlock; s < end_of_block(state, block); ++s) {
    owned = owned || state.owner[s] >= 0;
    for (int i = state.influence_offset[s]; i < state.influence_offset[s + 1]; ++i)
      joints.push_back(state.influence_joint[i]);
  }
  if (!owned) return {};
  std::array<int, kMaxFieldBones> near;
  const Float4Bounds bounds = bounds_of(state, block);
  const int count = field.bones_near(bounds.low, bounds.high, near.data());
  for (int i = 0; i < count; ++i) joints.push_back(field.fields()[near[i]].bone.joint);
  std::sort(joints.begin(), joints.end());
  joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  return joints;
}

}  // namespace

SmoothProjection::SmoothProjection(const RiggedMesh& rig, const BonePartition& partition,
                                   const FieldComposition& field, const ImplicitOptions& options,
                                   const SkinState& state)
    : field_(field),
      options_(options.smooth),
      gap_(static_cast<float>(options.smooth.contact_gap)),
      radius_(slot_radii(rig, partition, state)),
      trust_(limb_shares(rig, partition, state, kKnownSections)),
      system_(rig.mesh, state, radius_),
      rotation_(state.size()),
      demand_(state.size()),
      moved_(state.size()),
      seen_(state.size()),
      kept_(state.size()) {
  if (options_.volume) volumes_.emplace(rig, partition, state, radius_);
}

void SmoothProjection::blend_rotations(const SkinState& state,
                                       const std::vector<Float4>& rotations) {
  parallel_blocks(state.size(), kSlotsOfTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) rotation_[s] = blended_rotation(state, s, rotations);
  });
}

void SmoothProjection::record_rest(const SkinState& state) {
  std::fill(rotation_.begin(), rotation_.end(), Float4{0, 0, 0, 1});
  joints_.clear();
  for (std::size_t b = 0; b < state.block_count(); ++b)
    joints_.push_back(joints_about(state, field_, b));
  is_awake_.assign(state.block_count(), 0);
  overlap_offset_.assign(1, 0);
  overlap_.clear();
  std::array<int, kMaxFieldBones> near;
  for (std::size_t s = 0; s < state.size(); ++s) {
    if (state.owner[s] >= 0) {
      const Float4 p = state.position[s];
      const int bones = field_.bones_near(p, p, near.data());
      const Sampled at = sampled(state, s, {near.data(), static_cast<std::size_t>(bones)});
      for (const BoneSample& other : at.all()) {
        const float slack = depth_beyond_own(s, at, other);
        if (other.bone != state.owner[s] && slack > 0) overlap_.push_back({other.bone, slack});
      }
    }
    overlap_offset_.push_back(static_cast<int>(overlap_.size()));
  }
}

float SmoothProjection::depth_beyond_own(std::size_t slot, const Sampled& at,
                                         const BoneSample& other) const {
  return other.depth + gap_ * radius_[slot] - std::max(0.0F, at.own.depth);
}

float SmoothProjection::excess_of(std::size_t slot, const Sampled& at,
                                  const BoneSample& other) const {
  return depth_beyond_own(slot, at, other) - slack_of(slot, other.bone);
}

float SmoothProjection::slack_of(std::size_t slot, int bone) const {
  for (int i = overlap_offset_[slot]; i < overlap_offset_[slot + 1]; ++i)
    if (overlap_[i].bone == bone) return overlap_[i].slack;
  return 0;
}

float SmoothProjection::facing_of(const BoneSample& other, Float4 outward) const {
  const float lengths = length3(other.inward) * length3(outward);
  if (!(lengths > 0)) return 0;
  return smooth_ramp(kTurnedAway, kFacing, dot3(other.inward, outward) / lengths);
}

float SmoothProjection::crowding(const SkinState& state, std::size_t slot,
                                 const Sampled& at) const {
  const Float4 outward = state.outward[slot];
  const float margin = kCrowd * radius_[slot];
  float crowd = 0;
  for (const BoneSample& other : at.all()) {
    if (other.bone == state.owner[slot]) continue;
    const float facing = facing_of(other, outward);
    const float excess = excess_of(slot, at, other);
    crowd = std::max(crowd, facing * smooth_ramp(-margin, 0, excess));
  }
  return crowd;
}

Demand SmoothProjection::contact_demand(const SkinState& state, std::size_t slot,
                                        const Sampled& at) const {
  const Float4 outward = state.outward[slot];
  const float radius = radius_[slot];
  const float band = static_cast<float>(options_.contact_band) * radius;
  // What several bones ask is their mean, each by how surely and how deeply it is met: none of them
  // takes over abruptly.
  float weights = 0, excess_sum = 0, facing_sum = 0;
  Float4 direction{};
  const float inside = smooth_ramp(0, kOwnDepth * radius, at.own.depth);
  for (const BoneSample& other : at.all()) {
    if (other.bone == state.owner[slot]) continue;
    const float excess = excess_of(slot, at, other);
    if (excess <= -kSteepest * band) continue;
    const float towards = facing_of(other, outward);
    // Both sides yield as their own fields do: towards the surface where both are equally deep.
    const Float4 way = splat(inside) * at.own.inward - other.inward;
    const float slope = length3(way);
    if (!(slope > 0)) continue;
    const float depth = excess / std::min(std::max(slope, length3(other.inward)), kSteepest);
    const float weight =
        towards * smooth_ramp(-band, band, depth) * smooth_ramp(kNoWay, 4 * kNoWay, slope);
    if (!(weight > 0)) continue;
    weights += weight;
    excess_sum += weight * depth;
    facing_sum += weight * towards;
    direction += splat(weight / slope) * way;
  }
  const float along = length3(direction);
  if (!(weights > 0) || !(along > 0)) return {};
  const float deepest = excess_sum / weights;
  const float facing = facing_sum / weights * smooth_ramp(kNoWay, 4 * kNoWay, along / weights);
  direction /= splat(along);
  // Fields may be fuller than the skin that is there: only what has met is parted.
  const auto met =
      proximity_.facing(state, slot, static_cast<float>(options_.contact_reach) * radius);
  if (!met) return {};
  const float depth = std::min({deepest, met->depth + gap_ * radius, kLargestDemand * radius});
  if (depth <= -band) return {};
  // A Newton step on a hinge that bends within the band, so that contact does not switch.
  const bool bends = depth < band;
  const float stiffness = bends ? (depth + band) / (2 * band) : 1;
  const float amount = bends ? (depth + band) / 2 : depth;
  const float weight = facing * met->sure * static_cast<float>(options_.contact_weight);
  return {direction, amount, weight * stiffness};
}

Demand SmoothProjection::section_demand(const SkinState& state, std::size_t slot,
                                        const Sampled& at) const {
  const int owner = state.owner[slot];
  const Float4 outward = state.outward[slot];
  const float radius = radius_[slot];
  std::array<BoneSample, FieldComposition::kMaxOverlap> own_part;
  std::size_t own_count = 0;
  for (const BoneSample& sample : at.all())
    if (field_.same_part(owner, sample.bone)) own_part[own_count++] = sample;
  const FieldComposition::Composed all =
      field_.compose_smoothly({own_part.data(), own_count}, kSameField);
  const float slope = length3(all.gradient);
  const float outward_length = length3(outward);
  if (!(slope * radius > kFlat) || !(outward_length > 0)) return {};
  const float agree =
      smooth_ramp(kDisagrees, kAgrees, -dot3(all.gradient, outward) / (slope * outward_length));
  const float known = smooth_ramp(kFlat, 5 * kFlat, slope * radius) *
                      smooth_ramp(0.02F, 0.15F, all.value) *
                      (1 - smooth_ramp(0.85F, 0.98F, all.value));
  const float free = 1 - crowding(state, slot, at);
  const Float4 n = all.gradient / splat(slope);
  const float before = dot3(n, moved_[slot]);
  const float dead = kDeadZone * radius;
  const float reach = kLargestDemand * radius;
  float wanted = (state.iso[slot] - all.value) / slope + before;
  wanted *= wanted * wanted / (wanted * wanted + dead * dead);
  wanted /= std::sqrt(1 + wanted * wanted / (reach * reach));
  wanted *= static_cast<float>(options_.section);
  // Where the skin is right it is asked to stay: whatever was asked, the weight does not jump.
  if (std::abs(wanted) < kNothing * radius) wanted = 0;
  return {n, wanted, trust_[slot] * known * free * agree};
}

void SmoothProjection::find_awake(const SkinState& state) {
  const std::vector<int>& groups = field_.groups();
  parallel_blocks(state.block_count(), kBlocksOfTask, [&](std::size_t begin, std::size_t end) {
    std::array<int, kMaxFieldBones> near;
    for (std::size_t b = begin; b < end; ++b) {
      const std::vector<int>& joints = joints_[b];
      is_awake_[b] = 0;
      if (joints.empty()) continue;
      const auto group = [&](int joint) { return groups[joint]; };
      bool awake = false;
      for (const int joint : joints) awake = awake || group(joint) != group(joints.front());
      if (!awake) {
        const Float4Bounds bounds = bounds_of(state, b);
        const int count = field_.bones_near(bounds.low, bounds.high, near.data());
        for (int i = 0; i < count; ++i) {
          const int joint = field_.fields()[near[i]].bone.joint;
          awake = awake || group(joint) != group(joints.front());
        }
      }
      is_awake_[b] = awake ? 1 : 0;
    }
  });
}

void SmoothProjection::list_awake() {
  for (const int b : system_.open_blocks()) is_awake_[b] = 1;
  awake_.clear();
  for (int b = 0; b < std::ssize(is_awake_); ++b)
    if (is_awake_[b] != 0) awake_.push_back(b);
}

float SmoothProjection::nearest_contact(const SkinState& state, std::size_t slot,
                                        const Sampled& at) const {
  float nearest = -radius_[slot];
  for (const BoneSample& other : at.all()) {
    if (other.bone == state.owner[slot]) continue;
    nearest = std::max(nearest, excess_of(slot, at, other));
  }
  return nearest;
}

bool SmoothProjection::is_free(const SkinState& state, std::size_t slot) const {
  const float band = static_cast<float>(options_.contact_band) * radius_[slot];
  const float way = length3(state.position[slot] - seen_[slot].position);
  return seen_[slot].excess < 0 && seen_[slot].excess + kSteepest * (band + way) < 0;
}

void SmoothProjection::ask(SkinState& state, Stage stage) {
  parallel_blocks(awake_.size(), kBlocksOfTask, [&](std::size_t begin, std::size_t end) {
    std::array<int, kMaxFieldBones> near;
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t b = awake_[i];
      const Float4Bounds bounds = bounds_of(state, b);
      const int count = field_.bones_near(bounds.low, bounds.high, near.data());
      const std::span<const int> bones{near.data(), static_cast<std::size_t>(count)};
      for (std::size_t s = b * SkinState::kBlock; s < end_of_block(state, b); ++s) {
        demand_[s] = {};
        if (state.owner[s] < 0 || (stage == Stage::section ? trust_[s] <= 0 : is_free(state, s)))
          continue;
        const Sampled at = sampled(state, s, bones);
        state.evaluations[b] += count;
        if (stage == Stage::section) {
          if (at.count > 0) demand_[s] = section_demand(state, s, at);
          continue;
        }
        seen_[s] = {state.position[s], nearest_contact(state, s, at)};
        if (is_free(state, s)) continue;
        demand_[s] = contact_demand(state, s, at);
        demand_[s].amount += dot3(demand_[s].direction, moved_[s]);
      }
    }
  });
}

SmoothProjection::Sampled SmoothProjection::sampled(const SkinState& state, std::size_t slot,
                                                    std::span<const int> bones) const {
  Sampled at;
  at.count = field_.samples_at(state.position[slot], state.owner[slot], rotation_[slot], bones,
                               at.samples.data());
  for (const BoneSample& sample : at.all())
    if (sample.bone == state.owner[slot]) at.own = sample;
  return at;
}

void SmoothProjection::start_stage() {
  list_awake();
  system_.close(moved_);
  std::fill(demand_.begin(), demand_.end(), Demand{});
  std::fill(seen_.begin(), seen_.end(), Seen{});
}

int SmoothProjection::correct_sections(SkinState& state) {
  const SmoothSystem::Options options{options_.cutoff, options_.anchor, options_.iterations};
  start_stage();
  int steps = 0;
  for (int i = 0; i < options_.evaluations; ++i) {
    ask(state, Stage::section);
    system_.open(demand_, options);
    steps += system_.solve(demand_, options, moved_);
    place(state);
  }
  return steps;
}

void SmoothProjection::place(SkinState& state) const {
  system_.each_open([&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) state.position[s] = base_[s] + moved_[s];
  });
}

void SmoothProjection::forget() {
  std::fill(kept_.begin(), kept_.end(), Float4{});
  kept_blocks_.clear();
}

void SmoothProjection::recall() {
  system_.open(kept_blocks_);
  system_.each_open([&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) moved_[s] = turned(rotation_[s], kept_[s]);
  });
}

void SmoothProjection::keep() {
  forget();
  for (const int block : system_.open_blocks()) {
    const std::size_t begin = static_cast<std::size_t>(block) * SkinState::kBlock;
    const std::size_t end = std::min(kept_.size(), begin + SkinState::kBlock);
    bool displaced = false;
    for (std::size_t s = begin; s < end; ++s)
      displaced = displaced || length3(moved_[s]) > kKept * radius_[s];
    if (!displaced) continue;
    kept_blocks_.push_back(block);
    for (std::size_t s = begin; s < end; ++s)
      kept_[s] = turned(rotation_[s] * Float4{-1, -1, -1, 1}, moved_[s]);
  }
}

bool SmoothProjection::restore_volume(SkinState& state) {
  return volumes_ && volumes_->restore(base_, state.position);
}

int SmoothProjection::resolve_contacts(SkinState& state) {
  const SmoothSystem::Options options{options_.contact_cutoff, options_.contact_anchor,
                                      options_.iterations};
  start_stage();
  if (follows_) {
    recall();
    place(state);
  }
  int steps = 0;
  for (int i = 0; i < options_.contact_evaluations; ++i) {
    const bool bends = restore_volume(state);
    proximity_.build(state.position);
    ask(state, Stage::contact);
    system_.open(demand_, options);
    if (system_.open_blocks().empty() && !bends) break;
    steps += system_.solve(demand_, options, moved_);
    place(state);
    for (std::size_t s = 0; s < state.size(); ++s)
      if (demand_[s].weight > 0) state.stop[s] = VertexStop::contact;
  }
  if (follows_) keep();
  return steps;
}

int SmoothProjection::solve(SkinState& state, const Pose& pose,
                            const std::vector<Float4>& rotations) {
  blend_rotations(state, rotations);
  if (volumes_) volumes_->set_pose(field_, pose, rotation_);
  std::fill(state.stop.begin(), state.stop.end(), VertexStop::converged);
  base_ = state.start;
  system_.close(moved_);
  find_awake(state);
  restore_volume(state);
  int steps = correct_sections(state);
  base_ = state.position;
  restore_volume(state);
  steps += resolve_contacts(state);
  return steps;
}

}  // namespace geoprior::skinning
