#pragma once

#include <optional>
#include <vector>

#include "models/embryo/body/day_state.h"
#include "models/embryo/body/duct_motion.h"
#include "models/embryo/body/key_motion.h"
#include "models/embryo/body/plan.h"
#include "models/embryo/motion/monotone.h"

namespace geoprior::embryo {

/// The state of a body on any day, from its plan.
///
/// Of structures with key frames, with L the crown-rump length (monotone in its logarithm), c the
/// centre of the frame and t a day that stands still from where a process was switched off:
///   sizes      exp of a monotone curve through the logarithms, at t of the sizes
///   place      c + L p(t), p along the path of keys by its arc (key_path.h), at t of the place;
///              its height bounded, with a continuous velocity, by the landmarks that stop it
///   axes       R(angle u, about) ... of those of the keys, at t of the place, u from 0 to 1 eased
///              over the turn's days
///   duct       control points: both ends on their anchors (duct_motion.h), between them places;
///              ends that are held are where they were on their day, as ratios of L. Its centre is
///              the mean of the control points
/// A product of a division without key frames has the shape of the whole. Everything is continuous
/// in the day, with its first derivative, but for what exists, and unless motion is linear.
///
/// A structure exists on a day as it does in the stage that the day lies in: from the stage's first
/// day to the next stage's. A whole ends with its division in any case, by the day its products
/// begin.
///
/// `at` keeps nothing: it may be asked from several threads.
class Body {
 public:
  /// @throws Error  naming the structures: no stages or lengths, a circle of frames, anchors, stops
  ///                and wholes, or what KeyMotion and DuctMotion refuse
  explicit Body(BodyPlan plan);

  /// @throws Error  for a day outside of the stages (names their range)
  [[nodiscard]] DayState at(double day) const;
  [[nodiscard]] double first_day() const { return plan_.stages.front().start_day; }
  [[nodiscard]] double last_day() const { return plan_.stages.back().end_day; }
  /// Metres.
  [[nodiscard]] double crown_rump_length(double day) const;
  [[nodiscard]] const BodyPlan& plan() const { return plan_; }

  /// Half of the days in which what is held comes to rest: it stands from `held` + this on, and
  /// moves freely up to `held` - this.
  static constexpr double kHoldEase = 0.5;
  /// Below a stop by more than this ratio of the crown-rump length nothing is slowed.
  static constexpr double kStopEase = 0.01;

 private:
  class DayShapes;
  /// What moves a structure.
  struct Motion {
    std::optional<KeyMotion> keys;
    std::optional<DuctMotion> duct;
    std::optional<int> whole;  ///< that it is a half of
  };

  void require_order() const;
  [[nodiscard]] std::vector<int> needs(int structure) const;
  [[nodiscard]] int stage_of(double day) const;
  [[nodiscard]] double held(double day, const std::optional<double>& from) const;
  [[nodiscard]] bool has_shape(int structure) const;
  void add_divisions(DayState& state, DayShapes& shapes) const;
  void add_processes(DayState& state, DayShapes& shapes) const;
  void add_fused(DayState& state) const;

  BodyPlan plan_;
  std::vector<Motion> motions_;  ///< by structure
  MonotoneCurve length_;         ///< logarithm of the crown-rump length
};

}  // namespace geoprior::embryo
