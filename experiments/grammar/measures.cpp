#include "experiments/grammar/measures.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "experiments/grammar/measures/asked.h"
#include "experiments/grammar/measures/distribution.h"
#include "experiments/grammar/measures/fidelity.h"
#include "experiments/grammar/measures/motion.h"
#include "experiments/grammar/measures/persistence.h"

namespace geoprior::grammar {
namespace {

/// Frames are numbered as the scene's steps are.
std::size_t step_number(double parameter) {
  return static_cast<std::size_t>(std::lround(parameter));
}

bool is_deformation(const Step& step) {
  return step.kind == Step::Kind::gesture || step.kind == Step::Kind::random;
}

bool records_all(const GrammarScene& scene) {
  return scene.record != GrammarSceneOptions::Record::sample;
}

/// The rest, of the elements that a frame may have.
RecordedState rest_beside(const GrammarScene& scene, const RecordedState& state) {
  if (records_all(scene)) return RecordedState(scene.rest);
  return {scene.rest, state.numbers()};
}

ConstraintMeasures constraints_of(const GrammarScene& scene, const RecordedState& state,
                                  const RecordedState& rest) {
  return {building_violations(state), tree_violations(state, rest), scatter_violations(state),
          machine_violations(state, rest, scene.kind == Object::imported)};
}

std::vector<const Tally*> tallies_of(const ConstraintMeasures& m) {
  return {&m.building.wall_angle,
          &m.building.wall_gap,
          &m.building.storey_height,
          &m.building.storey_gap,
          &m.building.overhang,
          &m.building.window_pitch,
          &m.building.window_outside,
          &m.building.door_gap,
          &m.tree.length,
          &m.tree.attachment,
          &m.tree.crossings,
          &m.scatter.too_close,
          &m.scatter.ground_gap,
          &m.scatter.upright,
          &m.scatter.path_pitch,
          &m.machine.shape,
          &m.machine.turn,
          &m.machine.slide,
          &m.machine.links};
}

FidelityMeasures fidelity_of(const Deviation& deviation) {
  FidelityMeasures out{deviation.of_state, deviation.of_nothing, {}};
  if (out.of_nothing > 0) out.ratio = out.deviation / out.of_nothing;
  return out;
}

void raise(Value& largest, double value) { largest = std::max(largest.value_or(value), value); }

/// Numbers that are in both, each ascending.
std::vector<int> in_both(const std::vector<int>& a, const std::vector<int>& b) {
  std::vector<int> out;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
  return out;
}

/// Whether a step of a gesture goes on from the step before it.
bool continues(const GrammarScene& scene, std::size_t step) {
  const Step& now = scene.steps.at(step);
  if (step == 0 || now.kind != Step::Kind::gesture) return false;
  const Step& last = scene.steps[step - 1];
  return now.before == (last.kind == Step::Kind::gesture ? last.fraction : 0);
}

}  // namespace

int ConstraintMeasures::broken() const {
  int sum = 0;
  for (const Tally* t : tallies_of(*this)) sum += t->broken;
  return sum;
}

std::set<int> ConstraintMeasures::broken_elements() const {
  std::set<int> out;
  for (const Tally* t : tallies_of(*this)) out.insert(t->elements.begin(), t->elements.end());
  return out;
}

std::optional<ConstraintMeasures> constraint_measures(const GrammarScene& scene,
                                                      const Frame& frame) {
  if (!records_all(scene)) return std::nullopt;
  const RecordedState state(frame, scene.rest.types());
  return constraints_of(scene, state, rest_beside(scene, state));
}

std::optional<FidelityMeasures> fidelity_measures(const GrammarScene& scene, const Frame& frame) {
  const RecordedState state(frame, scene.rest.types());
  const auto deviation =
      deviation_of(state, rest_beside(scene, state), asked_at(scene, step_number(frame.parameter)));
  if (!deviation) return std::nullopt;
  return fidelity_of(*deviation);
}

std::optional<ChangeMeasures> change_measures(const GrammarScene& scene, const Frame& frame) {
  if (!records_all(scene)) return std::nullopt;
  const RecordedState state(frame, scene.rest.types());
  const RecordedState rest = rest_beside(scene, state);
  const ElementChanges changes = element_changes(state, rest);
  return ChangeMeasures{static_cast<double>(changes.touched) / changes.before,
                        static_cast<double>(changes.lost), static_cast<double>(changes.added),
                        kept_size(state, rest)};
}

std::optional<DistributionMeasures> distribution_measures(const GrammarScene& scene,
                                                          const Frame& frame) {
  if (!records_all(scene)) return std::nullopt;
  const RecordedState state(frame, scene.rest.types());
  const RecordedState rest = rest_beside(scene, state);
  const TreeDistributions tree = tree_distributions(state, rest);
  const SetDistribution set =
      set_distribution(state, rest, asked_at(scene, step_number(frame.parameter)));
  return DistributionMeasures{tree.lengths, tree.angles, set.spread, set.hole};
}

ReferenceMeasures reference_measures(const GrammarScene& scene, const Frame& frame,
                                     const Frame& reference) {
  const RecordedState state(frame, scene.rest.types()), other(reference, scene.rest.types());
  const Difference difference = difference_of(state, other);
  ReferenceMeasures out{{}, difference.largest, static_cast<double>(difference.unmatched)};
  const auto own = fidelity_measures(scene, frame), best = fidelity_measures(scene, reference);
  if (own && best && best->deviation > 0) out.deviation_ratio = own->deviation / best->deviation;
  return out;
}

MotionMeasures motion_measures(const GrammarScene& scene, const FrameSequence& frames) {
  MotionMeasures out;
  PopMeter pops;
  std::optional<RecordedState> start, last;
  std::optional<AskedPlaces> last_asked;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::size_t step = step_number(frames.parameter(i));
    RecordedState state(*frames.frame(i), scene.rest.types());
    AskedPlaces asked = asked_at(scene, step);
    const Step& now = scene.steps.at(step);
    if (now.kind != Step::Kind::gesture) start = state;
    if (last && continues(scene, step) && step_number(frames.parameter(i - 1)) + 1 == step)
      pops.add(*last, *last_asked, state, asked);
    if (start && now.kind == Step::Kind::gesture && now.fraction == 0)
      raise(out.return_gap, return_gap(*start, state));
    last = std::move(state);
    last_asked = std::move(asked);
  }
  out.pop = pops.largest();
  out.pop_ratio = pops.largest_over_size();
  return out;
}

LocalityMeasures locality_measures(const GrammarScene& scene, const FrameSequence& frames) {
  LocalityMeasures out;
  if (!records_all(scene)) return out;
  PersistenceMeter edits;
  std::optional<RecordedState> start;  // of the gesture: as the last edit left it
  std::optional<std::vector<int>> never_reached;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::size_t step = step_number(frames.parameter(i));
    RecordedState state(*frames.frame(i), scene.rest.types());
    const Step& now = scene.steps.at(step);
    if (now.kind == Step::Kind::edit) {
      const SceneEdit& edit = scene.edits.at(now.number);
      const bool again = edits.forget(edit.wish.element);
      edits.compare(state);
      if (edit.tag || again) edits.remember(state, edit.wish.element);
    }
    if (is_deformation(now)) {
      if (start) {
        std::vector<int> others = out_of_reach(*start, *scene.asked_map(step));
        // What an earlier step of the gesture reached need not come back to the last bit.
        if (now.kind == Step::Kind::gesture && never_reached)
          others = in_both(others, *never_reached);
        never_reached = others;
        if (!others.empty()) raise(out.stray_of_gestures, changed_among(others, state, *start));
      }
      edits.compare(state);
    } else {
      start = std::move(state);
      never_reached.reset();
    }
  }
  out.tagged_change = edits.distance();
  out.tagged_parameter_change = edits.parameter();
  out.lost_edits = edits.lost();
  return out;
}

std::optional<SuiteMeasures> suite_measures(const GrammarScene& scene,
                                            const FrameSequence& frames) {
  SuiteMeasures out;
  double deviation = 0, of_nothing = 0;
  double unserved_sum = 0, asked_sum = 0;  // the same, of all elements
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Step& step = scene.steps.at(step_number(frames.parameter(i)));
    if (!is_deformation(step)) continue;
    const auto frame = frames.frame(i);
    out.gestures += 1;
    const RecordedState state(*frame, scene.rest.types());
    const RecordedState rest = rest_beside(scene, state);
    const AskedPlaces asked = asked_at(scene, step_number(frame->parameter));
    if (records_all(scene)) {
      const ConstraintMeasures constraints = constraints_of(scene, state, rest);
      const int broken = constraints.broken();
      raise(out.worst_violations, broken);
      out.broken_gestures = out.broken_gestures.value_or(0) + (broken > 0 ? 1 : 0);
      if (const auto unserved =
              unserved_deviation_of(state, rest, asked, constraints.broken_elements())) {
        unserved_sum += unserved->of_state;
        asked_sum += unserved->of_nothing;
      }
    }
    const auto served = deviation_of(state, rest, asked);
    if (!served) continue;
    const FidelityMeasures fidelity = fidelity_of(*served);
    deviation += fidelity.deviation;
    of_nothing += fidelity.of_nothing;
    if (fidelity.ratio) raise(out.worst_deviation_ratio, *fidelity.ratio);
  }
  if (out.gestures == 0) return std::nullopt;
  if (of_nothing > 0) out.mean_deviation_ratio = deviation / of_nothing;
  if (asked_sum > 0) out.unserved_ratio = unserved_sum / asked_sum;
  return out;
}

}  // namespace geoprior::grammar
