#include "testbed/runner/judgement/grades.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "testbed/runner/journal/frame_files.h"
#include "testbed/runner/journal/recorded_frames.h"
#include "testbed/runner/judgement/blended_frame.h"
#include "testbed/runner/judgement/judgement.h"
#include "testbed/runner/judgement/measure.h"
#include "testbed/runner/judgement/recorded_scene.h"
#include "testbed/runner/judgement/studies.h"
#include "testbed/runner/options/quantity.h"
#include "testbed/runner/process/stop.h"

namespace geoprior {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Of all frames of a sequence that is changed: it is held in memory.
constexpr std::size_t kMostBytes = std::size_t{1} << 30;
/// By how much a metric of unchanged frames may be off the recorded one, beside its tolerance.
constexpr double kRoundOff = 1e-9;

double blend(double input, double output, double s) {
  // Equal values stay equal, infinite ones too.
  return input == output ? output : input + s * (output - input);
}

/// The frame of the input that the output's is mixed with: that of equal parameter; the only one of
/// a shape that does not change; of a method that ends elsewhere, for its last frame the last one.
std::optional<std::size_t> paired_frame(const VariantRecord& input, const VariantRecord& output,
                                        std::size_t i) {
  const int same = frame_of_parameter(input.frames, output.frames[i].parameter);
  if (same >= 0) return static_cast<std::size_t>(same);
  if (input.frames.size() == 1) return 0;
  if (!input.frames.empty() && i + 1 == output.frames.size()) return input.frames.size() - 1;
  return std::nullopt;
}

/// One value a frame of the output, mixed with that of the input's frame of equal parameter.
std::vector<double> blended_column(const VariantRecord& input, const std::vector<double>& of_input,
                                   const VariantRecord& output,
                                   const std::vector<double>& of_output, double s) {
  std::vector<double> mixed(of_output.size(), kNone);
  for (std::size_t i = 0; i < std::min(mixed.size(), output.frames.size()); ++i) {
    const std::optional<std::size_t> pair = paired_frame(input, output, i);
    if (pair && *pair < of_input.size()) mixed[i] = blend(of_input[*pair], of_output[i], s);
  }
  return mixed;
}

/// The output with the values of a metric or a diagnostic mixed with those of the input.
VariantRecord blended_values(const VariantRecord& input, const VariantRecord& output,
                             const std::string& quantity, double s) {
  VariantRecord mixed = output;
  const auto mix = [&](auto& columns, const auto& of_input, const std::string& name) {
    const auto column = columns.find(name);
    const auto other = of_input.find(name);
    if (column == columns.end()) return;
    if (other == of_input.end()) {
      columns.erase(column);
      return;
    }
    column->second.values =
        blended_column(input, other->second.values, output, column->second.values, s);
  };
  if (quantity.starts_with("diagnostic:")) {
    mix(mixed.diagnostics, input.diagnostics, quantity.substr(11));
    return mixed;
  }
  mix(mixed.metrics, input.metrics, quantity);
  const auto whole = mixed.summary.find(quantity);
  const auto other = input.summary.find(quantity);
  if (whole != mixed.summary.end() && other != input.summary.end()) {
    whole->second.value = blend(other->second.value, whole->second.value, s);
  } else if (whole != mixed.summary.end()) {
    mixed.summary.erase(whole);
  }
  return mixed;
}

/// The case with another record of one of its variants.
CaseRecord with_variant(const CaseRecord& in, VariantRecord variant) {
  CaseRecord changed = in;
  for (VariantRecord& one : changed.variants) {
    if (one.name == variant.name) one = std::move(variant);
  }
  return changed;
}

/// A claim in one case, and what it is graded between.
struct Sides {
  const ClaimSpec* claim = nullptr;
  const CaseRecord* in = nullptr;
  const VariantRecord* input = nullptr;
  const VariantRecord* output = nullptr;
};

bool is_whole(const VariantRecord* variant) {
  return variant != nullptr && variant->status != "failed";
}

/// The smallest step from which on it holds, when it holds at the last; of frames, whose measures
/// cost, by bisection. Absent where a mutation on the way has no value.
template <class HoldsAt>
std::optional<int> least_step(bool by_bisection, HoldsAt holds_at) {
  int fails = -1, holds = kGradeSteps;
  while (holds - fails > 1) {
    // The input itself first, then between; without bisection one step after the other.
    const int next = !by_bisection ? holds - 1 : fails < 0 ? 0 : (fails + holds) / 2;
    const std::optional<bool> passes = holds_at(next);
    if (!passes) return std::nullopt;
    (*passes ? holds : fails) = next;
    if (next == 0 && *passes) return 0;
  }
  return holds;
}

}  // namespace

class Grader::Impl {
 public:
  Impl(const Experiment& experiment, const std::vector<Topic>& topics, const RunRecord& record,
       std::filesystem::path folder)
      : experiment_(experiment),
        topics_(topics),
        topic_(topic_of(experiment, topics)),
        record_(record),
        files_(std::move(folder), topic_.looked_at) {}

  GradeRecord grade(const ClaimRecord& decided) {
    GradeRecord grade;
    const ClaimSpec* claim = spec_of(decided);
    if (claim == nullptr || claim->exempt != Exemption::none || !decided.holds) return grade;
    const auto look = [&](Graded of) {
      if (holds_at(decided, of, kGradeSteps) != true) return;
      const std::optional<int> least =
          least_step(of == Graded::frames, [&](int step) { return holds_at(decided, of, step); });
      if (!least) return;
      grade.of = of;
      grade.least = static_cast<double>(*least) / kGradeSteps;
    };
    if (study_of(*claim, experiment_.studies) != nullptr) {
      grade.input = experiment_.input.value_or("");
      if (!grade.input.empty()) look(Graded::values);
      return grade;
    }
    const std::optional<Sides> sides = sides_of(*claim, decided);
    if (!sides) return grade;
    grade.input = sides->input->name;
    if (frames_tell(*sides)) look(Graded::frames);
    if (grade.of == Graded::not_graded) look(Graded::values);
    return grade;
  }

  std::optional<bool> holds_at(const ClaimRecord& decided, Graded of, int step) {
    throw_if_stopped();
    const ClaimSpec* claim = spec_of(decided);
    if (claim == nullptr) return std::nullopt;
    const double s = static_cast<double>(step) / kGradeSteps;
    try {
      if (const StudySpec* study = study_of(*claim, experiment_.studies)) {
        return study_holds(*claim, *study, s);
      }
      const std::optional<Sides> sides = sides_of(*claim, decided);
      if (!sides) return std::nullopt;
      const VariantRecord mixed =
          of == Graded::frames ? measured(*sides, step)
                               : blended_values(*sides->input, *sides->output, claim->metric, s);
      return judge(*claim, with_variant(*sides->in, mixed), sides->output->name).holds();
    } catch (const Error&) {  // no value, or a shape that cannot be measured
      return std::nullopt;
    }
  }

 private:
  const ClaimSpec* spec_of(const ClaimRecord& decided) const {
    const auto found = std::find_if(
        experiment_.claims.begin(), experiment_.claims.end(), [&](const ClaimSpec& claim) {
          return claim.text == decided.text && claim.variant == decided.variant;
        });
    return found == experiment_.claims.end() ? nullptr : &*found;
  }

  [[nodiscard]] std::optional<Sides> sides_of(const ClaimSpec& claim,
                                              const ClaimRecord& decided) const {
    if (!experiment_.input || *experiment_.input == claim.variant) return std::nullopt;
    for (const CaseRecord& in : record_.cases) {
      if (in.name != decided.case_name) continue;
      const Sides sides{&claim, &in, find_variant(in, *experiment_.input),
                        find_variant(in, claim.variant)};
      if (is_whole(sides.input) && is_whole(sides.output)) return sides;
    }
    return std::nullopt;
  }

  [[nodiscard]] bool study_holds(const ClaimSpec& claim, const StudySpec& study, double s) const {
    Experiment one;
    one.studies = {study};
    RunRecord changed;
    bool mixed = false;
    for (const CaseRecord& in : record_.cases) {
      const VariantRecord* input = find_variant(in, *experiment_.input);
      const VariantRecord* output = find_variant(in, study.variant);
      const bool named = study.cases.empty() || std::find(study.cases.begin(), study.cases.end(),
                                                          in.name) != study.cases.end();
      const bool both = named && is_whole(input) && is_whole(output) && input != output;
      mixed = mixed || both;
      if (!both) {
        changed.cases.push_back(in);
        continue;
      }
      VariantRecord blended = blended_values(*input, *output, study.quantity, s);
      for (const std::string& quality : {study.match, study.keep})
        if (!quality.empty()) blended = blended_values(*input, blended, quality, s);
      changed.cases.push_back(with_variant(in, blended));
    }
    if (!mixed) throw Error("no case has the input", "study '" + study.name + "'");
    return judge_study(claim, make_studies(one, changed)).holds();
  }

  /// Whether the metric follows the frames: of those of the input it is that of the input, which
  /// has none where it is what the others are compared with.
  bool frames_tell(const Sides& sides) {
    const MetricEntry* metric = find_metric(topic_, sides.claim->metric);
    if (metric == nullptr) return false;
    const ClaimSpec& claim = *sides.claim;
    const Reduction reduce = claim.reduce == Reduction::every ? Reduction::max : claim.reduce;
    const auto value = [&](const VariantRecord& of) {
      return quantity_of(*sides.in, of, claim.metric, claim.at_parameter, reduce).value;
    };
    const auto follows = [&](int step, const VariantRecord& of) {
      const double recorded = value(of);
      return std::abs(value(measured(sides, step)) - recorded) <=
             metric->tolerance.of(recorded) + kRoundOff * std::abs(recorded);
    };
    try {
      const bool compared_with = group_of(topic_, *metric).needs_reference &&
                                 sides.input->reference.empty() &&
                                 reference_of(*sides.in, *sides.output) == sides.input;
      return (compared_with ? !std::isnan(value(measured(sides, 0))) : follows(0, *sides.input)) &&
             follows(kGradeSteps, *sides.output);
    } catch (const Error&) {
      return false;
    }
  }

  /// The output with the claim's metric of its changed frames, of those that the claim reads.
  const VariantRecord& measured(const Sides& sides, int step) {
    const MetricGroup& group = group_of(topic_, *find_metric(topic_, sides.claim->metric));
    const bool all = !sides.claim->at_parameter || group.of_sequence;
    const Key key(sides.output->name, &group, all ? std::nullopt : sides.claim->at_parameter, step);
    go_to(*sides.in);
    if (const auto known = measured_.find(key); known != measured_.end()) return known->second;
    const CaseSpec& spec = case_spec(experiment_, sides.in->name);
    VariantRecord variant = *sides.output;
    for (const MetricEntry& row : group.rows) {
      variant.metrics.erase(row.name);
      variant.summary.erase(row.name);
    }
    with_threads(spec.threads, [&] { measure(sides, group, all, step, variant); });
    return measured_.emplace(key, std::move(variant)).first->second;
  }

  void measure(const Sides& sides, const MetricGroup& group, bool all, int step,
               VariantRecord& variant) {
    const Scene& scene = *scene_;
    std::vector<Frame> frames;
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < variant.frames.size(); ++i) {
      throw_if_stopped();
      const double parameter = variant.frames[i].parameter;
      if (!all && !same_parameter(parameter, *sides.claim->at_parameter)) continue;
      const std::optional<std::size_t> pair = paired_frame(*sides.input, variant, i);
      if (!pair) throw Error("has no frame of equal parameter", sides.input->name);
      Frame frame = blended_frame(files_.frame(*sides.input, *pair), files_.frame(*sides.output, i),
                                  static_cast<double>(step) / kGradeSteps);
      if (group.of_sequence) {
        bytes += memory_of(frame);
        if (bytes > kMostBytes) throw Error("is too long to be held in memory", variant.name);
        frames.push_back(std::move(frame));
        continue;
      }
      const std::optional<Frame> reference = reference_frame(*sides.in, variant, parameter);
      for (const auto& [name, value] :
           measure_frame(group, scene, frame, reference ? &*reference : nullptr)) {
        variant.metrics[name].values.resize(variant.frames.size(), kNone);
        variant.metrics[name].values[i] = value;
      }
    }
    if (group.of_sequence) measure_whole(sides, group, std::move(frames), scene, variant);
  }

  void measure_whole(const Sides& sides, const MetricGroup& group, std::vector<Frame> frames,
                     const Scene& scene, VariantRecord& variant) const {
    std::sort(frames.begin(), frames.end(),
              [](const Frame& a, const Frame& b) { return a.parameter < b.parameter; });
    const KeptFrames none(0);
    const VariantRecord* reference = reference_of(*sides.in, variant);
    const auto compared = reference != nullptr ? std::optional<RecordedFrames>(
                                                     std::in_place, files_, *reference, none)
                                               : std::nullopt;
    const FramesInMemory sequence(frames, variant.events, {}, compared ? &*compared : nullptr);
    for (const auto& [name, value] : measure_sequence(group, scene, sequence)) {
      variant.summary[name].value = value;
    }
  }

  [[nodiscard]] std::optional<Frame> reference_frame(const CaseRecord& in,
                                                     const VariantRecord& variant,
                                                     double parameter) const {
    const VariantRecord* reference = reference_of(in, variant);
    if (reference == nullptr) return std::nullopt;
    const int same = frame_of_parameter(reference->frames, parameter);
    if (same < 0) return std::nullopt;
    return files_.frame(*reference, static_cast<std::size_t>(same));
  }

  /// Of one case at a time scene and measures are kept.
  void go_to(const CaseRecord& in) {
    if (at_ == &in) return;
    measured_.clear();
    scene_.reset();
    scene_ = load_recorded_scene(experiment_, case_spec(experiment_, in.name), topics_, record_);
    at_ = &in;
  }

  /// Variant, what is measured, at which frame alone, and the step of the mutation.
  using Key = std::tuple<std::string, const MetricGroup*, std::optional<double>, int>;

  const Experiment& experiment_;
  const std::vector<Topic>& topics_;
  const Topic& topic_;
  const RunRecord& record_;
  FrameFiles files_;
  const CaseRecord* at_ = nullptr;
  std::shared_ptr<Scene> scene_;
  std::map<Key, VariantRecord> measured_;
};

Grader::Grader(const Experiment& experiment, const std::vector<Topic>& topics,
               const RunRecord& record, std::filesystem::path folder)
    : impl_(std::make_unique<Impl>(experiment, topics, record, std::move(folder))) {}
Grader::~Grader() = default;

GradeRecord Grader::grade(const ClaimRecord& decided) { return impl_->grade(decided); }

std::optional<bool> Grader::holds_at(const ClaimRecord& decided, Graded of, int step) {
  return impl_->holds_at(decided, of, step);
}

std::vector<std::string> cases_of(const std::vector<ClaimRecord>& claims) {
  std::vector<std::string> cases;
  for (const ClaimRecord& claim : claims) {
    if (std::find(cases.begin(), cases.end(), claim.case_name) == cases.end()) {
      cases.push_back(claim.case_name);
    }
  }
  return cases;
}

void grade_claims(const Experiment& experiment, const std::vector<Topic>& topics,
                  const std::filesystem::path& folder, RunRecord& record) {
  Grader grader(experiment, topics, record, folder);
  for (const std::string& in : cases_of(record.claims)) {
    for (ClaimRecord& claim : record.claims) {
      if (claim.case_name == in) claim.grade = grader.grade(claim);
    }
  }
}

}  // namespace geoprior
