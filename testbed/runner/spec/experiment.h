#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "testbed/figure_view.h"
#include "testbed/runner/spec/terms.h"
#include "testbed/topic.h"

namespace geoprior {

/// One method with its options on the scene of a case.
struct VariantSpec {
  std::string name;
  std::string method;
  std::string role;                      ///< "method", "baseline", "ablation" or "null"
  std::optional<std::string> reference;  ///< variant that metrics with needs_reference compare with
  std::shared_ptr<const OptionSet> options;
  std::string options_json;  ///< resolved: every option, defaults included
  /// "file:line:column" of every option that is written, by its dotted path ("options.step").
  std::map<std::string, std::string> option_places;
};

/// One point of the sweeps: a scene and the variants that run on it.
struct CaseSpec {
  std::string name = "default";              ///< "stop_angle_deg=26", folder-safe
  std::map<std::string, std::string> swept;  ///< dotted key to the JSON text of its value
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all
  std::shared_ptr<const OptionSet> scene;
  std::string scene_json;  ///< resolved
  /// "file:line:column" of every key below [scene], by its dotted path ("scene.handles.0.keys").
  std::map<std::string, std::string> scene_places;
  std::vector<VariantSpec> variants;
  bool claims_only = false;  ///< decides claims and studies: not blessed, timed again or drawn
};

/// A statement that the runner can decide: value (is) factor * value of the other side + offset.
struct ClaimSpec {
  std::string text;
  /// A name of the metric table, or "timing:<phase>" (median, in s), "diagnostic:<name>" (per
  /// frame), or "study:<name>" (its value; has no variant and is decided once).
  std::string metric;
  std::string variant;
  std::optional<std::string> of;  ///< compared with this variant; absent: with `value`
  std::optional<double> value;
  /// All that the sentence is about: a specification each, of one text. Empty: `variant` alone.
  std::vector<std::string> variants;
  Comparison is = Comparison::less_equal;
  double factor = 1;
  double offset = 0;
  double tolerance = 0;  ///< for `equal`
  /// Why the claim falls short, where that is known and documented: `run` reports it, `check` lets
  /// it pass where it falls short by as much as when it was blessed.
  std::optional<std::string> known_shortfall;
  /// Why the limit is far from the value: `bless` wants it near.
  std::optional<std::string> slack;
  std::optional<double> at_parameter;  ///< at = { angle_deg = 90 }; the frame must exist
  std::string at_key;  ///< "angle_deg": parameter name and unit, compared with the scene's
  /// Over the frames, when there is no `at`; of `every` frame, the one nearest to failing is
  /// recorded.
  Reduction reduce = Reduction::max;
  std::optional<Reduction> of_reduce;  ///< of the other side; absent: as `reduce`
  /// Cases in which it is decided but need not hold, and why.
  std::map<std::string, std::string> except;
  ClaimOver over = ClaimOver::case_;
  /// Variant that must fail the same inequality put in the place of `variant`.
  std::optional<std::string> null;
  Exemption exempt = Exemption::none;
  Tolerance metric_tolerance;  ///< by more than which the null must fail
};

/// A quantity across cases.
struct StudySpec {
  std::string name;
  StudyKind kind = StudyKind::exponent;
  std::string variant;
  std::string
      quantity;  ///< as a claim's metric: of the table, "timing:<phase>", "diagnostic:<name>"
  std::string against;  ///< a scene fact ("vertices") or a swept key; unused by spreads
  Reduction reduce = Reduction::median;  ///< over the frames, as a claim's
  std::vector<std::string> cases;        ///< empty: every case that has the variant and `against`
  Finer finer = Finer::smaller;          ///< of `order`
  /// Of `within_spread`: the variant that is the yardstick; of `matched`: that which is right, or
  /// empty where `match` is an error.
  std::string of;
  /// Of `pooled`: the quantity of events; absent where they have none.
  std::function<std::optional<double>(const std::vector<Event>&)> of_events = {};
  std::string match = {};  ///< of `matched`: the quality, as `quantity`
  Reduction match_reduce = Reduction::last;
  std::vector<std::vector<std::string>> families = {};  ///< of `matched`: variants, coarse to fine
  /// Of `matched`: the metric of which rivals may have less than the variant by `keep_within`, or
  /// empty; reduced as `match`.
  std::string keep = {};
  Direction keep_direction = Direction::none;
  double keep_within = 0;
};

/// The study that the claim is about; null when it is about a variant.
const StudySpec* study_of(const ClaimSpec& claim, const std::vector<StudySpec>& studies);

/// Which way a value is better for such a claim; none for an equality.
Direction direction_of(Comparison comparison);

/// The claim compares with its null itself (`a < b` with b for null): b is not less than b, so the
/// null fails by nothing, and it is the claim's own margin that must be clear.
bool null_is_yardstick(const ClaimSpec& claim);

/// An experiment file after [quick], --set, sweeps and defaults: what is run and decided.
struct Experiment {
  std::string id;  ///< "skinning/knee"
  std::string title;
  std::string figure;
  std::string topic;
  std::filesystem::path file;
  /// Variant that does nothing: claims are graded between it and theirs. Absent: no variant is of
  /// the topic's inputs.
  std::optional<std::string> input;
  bool quick = false;
  std::vector<CaseSpec> cases;
  std::vector<ClaimSpec> claims;
  std::vector<StudySpec> studies;
  std::map<std::string, Tolerance>
      tolerances;  ///< [tolerance] overrides of the metric table, by metric or "study:<name>"
  /// [check]: the motion takes one of several paths, and `check` compares medians over the seeds.
  bool bifurcates = false;
  /// [check]: metrics with reference values that neither a claim nor the figure reads.
  std::vector<std::string> checked_metrics;
  /// [check]: the reference keeps a hash of what each column came to (reference/outcomes.h).
  bool keeps_outcomes = false;
  int timing_repetitions = 1;
  std::optional<int> timing_warm_up;  ///< absent: 1 for pose methods, 0 for processes
  FigureView view;
  /// The whole text after quick, --set and defaults, before sweeps: an experiment file itself.
  std::string resolved_toml;
  /// sha256 of `resolved_toml` without [figure_view] and [check] (neither changes a number),
  /// program version, commit and the sources' difference from it; 64 hex digits.
  std::string hash;
};

/// The topic of a loaded experiment. Throws Error when it is none of `topics`.
const Topic& topic_of(const Experiment& experiment, const std::vector<Topic>& topics);

}  // namespace geoprior
