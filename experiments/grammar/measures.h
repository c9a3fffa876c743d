#pragma once

#include <optional>
#include <set>

#include "core/frame.h"
#include "experiments/grammar/measures/violations.h"
#include "experiments/grammar/scene/scene.h"
#include "testbed/frame_sequence.h"

namespace geoprior::grammar {

/// What the groups of the table of metrics (metrics.cpp) measure, from the parts of a frame and the
/// scene alone: the elements, their key points, and what the user asks for.
using Value = std::optional<double>;

/// Constraints of all kinds; absent for a sample of the elements.
struct ConstraintMeasures {
  BuildingViolations building;
  TreeViolations tree;
  ScatterViolations scatter;
  MachineViolations machine;

  [[nodiscard]] int broken() const;
  /// Numbers of the elements that break a constraint of their own.
  [[nodiscard]] std::set<int> broken_elements() const;
};
std::optional<ConstraintMeasures> constraint_measures(const GrammarScene& scene,
                                                      const Frame& frame);

/// How far a frame is from what the user asks for.
struct FidelityMeasures {
  double deviation = 0, of_nothing = 0;  ///< m
  Value ratio;                           ///< absent where nothing is asked for
};
std::optional<FidelityMeasures> fidelity_measures(const GrammarScene& scene, const Frame& frame);

/// What became of the elements since the rest; absent for a sample.
struct ChangeMeasures {
  double touched_share = 0;
  double lost = 0, added = 0;
  Value kept_size;  ///< absent where no element has a size
};
std::optional<ChangeMeasures> change_measures(const GrammarScene& scene, const Frame& frame);

/// How the elements are distributed; absent for a sample.
struct DistributionMeasures {
  Value branch_lengths, branch_angles;  ///< Kolmogorov-Smirnov distances from rest
  Value spread, hole;
};
std::optional<DistributionMeasures> distribution_measures(const GrammarScene& scene,
                                                          const Frame& frame);

/// A frame against that of the reference variant.
struct ReferenceMeasures {
  Value deviation_ratio;  ///< absent where the reference has none
  Value difference;       ///< m
  double unmatched = 0;
};
ReferenceMeasures reference_measures(const GrammarScene& scene, const Frame& frame,
                                     const Frame& reference);

/// Over the steps of a gesture.
struct MotionMeasures {
  Value pop, pop_ratio;  ///< m, 1; absent without two steps that follow each other
  Value return_gap;      ///< m; absent where the gesture does not come back
};
MotionMeasures motion_measures(const GrammarScene& scene, const FrameSequence& frames);

/// Elements that nothing asks to change, and those that nothing may change.
struct LocalityMeasures {
  Value stray_of_gestures;  ///< worst of the steps of a gesture and the random gestures
  Value tagged_change;      ///< m
  Value tagged_parameter_change;
  Value lost_edits;
};
LocalityMeasures locality_measures(const GrammarScene& scene, const FrameSequence& frames);

/// Over all steps of a gesture, or all random gestures; absent without any.
struct SuiteMeasures {
  double gestures = 0;         ///< frames that count
  Value broken_gestures;       ///< of these, those with violations
  Value worst_violations;      ///< most of one of them
  Value mean_deviation_ratio;  ///< mean deviation over that of doing nothing
  Value worst_deviation_ratio;
  Value unserved_ratio;  ///< mean unserved deviation over that of doing nothing
};
std::optional<SuiteMeasures> suite_measures(const GrammarScene& scene, const FrameSequence& frames);

}  // namespace geoprior::grammar
