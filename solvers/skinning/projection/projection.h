#pragma once

#include "solvers/skinning/field/composition.h"
#include "solvers/skinning/implicit_options.h"
#include "solvers/skinning/projection/skin_state.h"

namespace geoprior::skinning {

/// Marching of the vertices to their rest iso-value (thesis eq. 3.2 with its sign corrected).
///
///   p <- p - Delta_L (F(p) - target) grad F / |grad F|^2
///
/// The printed equation has a plus, which walks away from the surface whatever the convention of
/// the field. A vertex stops when |F - target| < tolerance; at a contact, where the gradient turns
/// by more than the stop angle between two steps; where the gradient vanishes; and, as an option,
/// where the error grows. A step is at most `max_step` r long.
///
/// A vertex that starts beyond a medial axis (a deep fold: the far half of the other bone) would
/// be pushed out on the wrong side. It is recognised by a field that pushes against the vertex'
/// skinned normal, and walks along that normal, out of the fold, until the two agree.
///
/// Target: the vertex' iso-value. Where another part of the body is deeper than that, its field:
/// F = f_other is the contact surface of the two, what Cani's operator makes of it for iso = 1/2.
/// What overlaps already at rest is left out, so the rest pose stays as it is.
class Projection {
 public:
  Projection(const FieldComposition& field, const ImplicitOptions& options);

  /// Writes rest iso-values and gradients; `state.position` holds the rest pose, the field is at
  /// rest.
  void record_rest(SkinState& state) const;

  /// One step of all active vertices; drops those that stop.
  void step(SkinState& state) const;

  /// Value that F should have at a vertex, and whether another part of the body sets it.
  struct Target {
    float value;
    bool in_contact;
  };
  [[nodiscard]] Target target_of(const SkinState& state, std::size_t slot, const FieldAt& at) const;

  /// F at one vertex, by the bones that can reach it.
  [[nodiscard]] FieldAt field_of(const SkinState& state, std::size_t slot, Float4 p) const;

 private:
  void step_block(SkinState& state, std::size_t block) const;
  bool step_vertex(SkinState& state, std::size_t slot, const FieldAt& at) const;
  [[nodiscard]] bool on_far_side(const SkinState& state, std::size_t slot, const FieldAt& at) const;
  /// A vertex outside every field (swollen start, or walked out) goes where its own bone carries
  /// it.
  bool enter_field(SkinState& state, std::size_t slot) const;
  void walk_out(SkinState& state, std::size_t slot, int bone) const;
  void stop_in_contact(SkinState& state, std::size_t slot, int bone_now) const;

  const FieldComposition& field_;
  float step_;
  float max_step_;
  float stop_cos_;
  float tolerance_;
  float gap_;
  bool bisect_;
  bool leave_far_side_;
  bool stop_on_growth_;
};

}  // namespace geoprior::skinning
