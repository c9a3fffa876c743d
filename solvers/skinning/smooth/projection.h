#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/inputs/rig.h"
#include "solvers/skinning/field/composition.h"
#include "solvers/skinning/implicit_options.h"
#include "solvers/skinning/projection/skin_proximity.h"
#include "solvers/skinning/projection/skin_state.h"
#include "solvers/skinning/smooth/joint_volumes.h"
#include "solvers/skinning/smooth/limbs.h"
#include "solvers/skinning/smooth/system.h"

namespace geoprior::skinning {

/// The correction of a skin as a smooth displacement of all vertices together, instead of a march
/// of each.
///
/// Section: where the field of a limb knows the skin, it asks for its iso-value along its gradient
/// (a Newton step, eq. 3.2); neighbours follow by bending energy (smooth/system.h). It is asked
/// nothing where the gradient does not agree with the skinned normal (a vertex beyond a medial
/// axis), where the support ends, near contact, and about the trunk, whose bones are shorter than
/// thick: skin there is no tube about a bone.
/// Contact: vertices where another bone's field is about as deep as their own, and that have met
/// skin which faces them, are pushed to where both fields are equally deep, no farther than they
/// stand behind that skin. The force grows smoothly within a band about contact: a smooth convex
/// potential, on which every evaluation is a Newton step. With `follow` that begins where the pose
/// before ended.
/// Skin that twists slides around its bone: fields are turned about their axis to each vertex' own
/// twist before they are asked.
class SmoothProjection {
 public:
  SmoothProjection(const RiggedMesh& rig, const BonePartition& partition,
                   const FieldComposition& field, const ImplicitOptions& options,
                   const SkinState& state);

  /// What overlaps at rest: `state` holds the rest pose and its iso-values, the field is at rest.
  void record_rest(const SkinState& state);

  /// Contact begins at the next solves where the one before left it.
  void follow() { follows_ = true; }
  /// The next solve begins without any displacement.
  void forget();

  /// Moves `state.position` from `state.start`; marks vertices in contact.
  /// @param rotations  of the joints, unit quaternions (x, y, z, w)
  /// @return steps of the linear solver
  int solve(SkinState& state, const Pose& pose, const std::vector<Float4>& rotations);

 private:
  enum class Stage { section, contact };
  struct Overlap {
    int bone;
    float slack;
  };
  struct Sampled {
    std::array<BoneSample, FieldComposition::kMaxOverlap> samples;
    int count = 0;
    BoneSample own;
    [[nodiscard]] std::span<const BoneSample> all() const {
      return {samples.data(), static_cast<std::size_t>(count)};
    }
  };

  /// What a vertex saw of contact when it last was asked.
  struct Seen {
    Float4 position{};
    float excess = 0;  ///< over the nearest contact (m); 0: it was not asked
  };

  /// Swells the skin by what it has lost. @return whether any joint bends
  bool restore_volume(SkinState& state);
  void blend_rotations(const SkinState& state, const std::vector<Float4>& rotations);
  int correct_sections(SkinState& state);
  int resolve_contacts(SkinState& state);
  void recall();
  void keep();
  void place(SkinState& state) const;
  /// Blocks of the skin about which something moved against something else.
  void find_awake(const SkinState& state);
  void list_awake();
  void start_stage();
  /// What the fields ask of the blocks that are awake.
  void ask(SkinState& state, Stage stage);
  [[nodiscard]] Sampled sampled(const SkinState& state, std::size_t slot,
                                std::span<const int> bones) const;
  [[nodiscard]] Demand section_demand(const SkinState& state, std::size_t slot,
                                      const Sampled& at) const;
  [[nodiscard]] Demand contact_demand(const SkinState& state, std::size_t slot,
                                      const Sampled& at) const;
  /// Whether another bone faces a vertex, in [0, 1]: its field grows along the skinned normal.
  [[nodiscard]] float facing_of(const BoneSample& other, Float4 outward) const;
  /// Largest excess over contact with another bone (m), negative before it; at least -radius.
  [[nodiscard]] float nearest_contact(const SkinState& state, std::size_t slot,
                                      const Sampled& at) const;
  /// Whether a vertex has not moved far enough to be in contact now.
  [[nodiscard]] bool is_free(const SkinState& state, std::size_t slot) const;
  /// How far other bones crowd a vertex, in [0, 1]: 1 in contact, 0 well before it.
  [[nodiscard]] float crowding(const SkinState& state, std::size_t slot, const Sampled& at) const;
  /// How much deeper a vertex is in another bone's field than in its own, the gap included (m).
  [[nodiscard]] float depth_beyond_own(std::size_t slot, const Sampled& at,
                                       const BoneSample& other) const;
  /// The same at rest, where it is positive.
  [[nodiscard]] float slack_of(std::size_t slot, int bone) const;
  /// `depth_beyond_own` over that at rest (m): positive in contact.
  [[nodiscard]] float excess_of(std::size_t slot, const Sampled& at, const BoneSample& other) const;

  const FieldComposition& field_;
  SmoothOptions options_;
  float gap_;                  // of contacts, in local radii
  std::vector<float> radius_;  // local, per slot
  std::vector<float> trust_;   // what a limb's field knows about the slot's skin
  SmoothSystem system_;
  std::optional<JointVolumes> volumes_;
  SkinProximity proximity_;
  std::vector<std::vector<int>> joints_;  // per block, whose motion decides what fields ask
  std::vector<std::uint8_t> is_awake_;    // per block
  std::vector<int> awake_;                // blocks
  std::vector<int> overlap_offset_;
  std::vector<Overlap> overlap_;  // at rest, per slot
  std::vector<Float4> rotation_;  // blended, per slot
  std::vector<Demand> demand_;
  std::vector<Float4> base_;   // where a stage starts
  std::vector<Float4> moved_;  // from there
  std::vector<Seen> seen_;
  bool follows_ = false;
  std::vector<Float4> kept_;      // displacement by contact, turned back to rest
  std::vector<int> kept_blocks_;  // that hold any
};

}  // namespace geoprior::skinning
