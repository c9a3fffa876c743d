#include "testbed/runner/judgement/studies.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/error.h"
#include "testbed/runner/judgement/matched.h"
#include "testbed/runner/judgement/statistics.h"
#include "testbed/runner/options/quantity.h"

namespace geoprior {
namespace {

/// x of a case: a fact of the scene, or the swept value; absent when the case has neither.
std::optional<double> abscissa(const CaseRecord& in, const StudySpec& study) {
  if (const auto fact = in.facts.find(study.against); fact != in.facts.end()) return fact->second;
  const auto swept = in.swept.find(study.against);
  if (swept == in.swept.end()) return std::nullopt;
  char* end = nullptr;
  const double x = std::strtod(swept->second.c_str(), &end);
  if (end == swept->second.c_str() || *end != 0) {
    throw Error("swept value " + swept->second + " is no number",
                "study '" + study.name + "', case '" + in.name + "'", "numbers");
  }
  return x;
}

void require_positive(double value, const std::string& what, const StudySpec& study,
                      const CaseRecord& in) {
  if (value > 0) return;
  throw Error(what + " is not positive, it has no logarithm",
              "study '" + study.name + "', case '" + in.name + "'");
}

bool is_slope(const StudySpec& study) {
  return study.kind == StudyKind::exponent || study.kind == StudyKind::order;
}

/// Null when the case does not have the variant, or only some of its frames.
const VariantRecord* variant_in(const CaseRecord& in, const std::string& name) {
  const VariantRecord* variant = find_variant(in, name);
  return variant == nullptr || variant->status == "failed" ? nullptr : variant;
}

/// The study's quantity of a variant in a case; absent when the case has no such variant.
std::optional<double> value_in(const CaseRecord& in, const std::string& name,
                               const StudySpec& study) {
  const VariantRecord* variant = variant_in(in, name);
  if (variant == nullptr) return std::nullopt;
  return quantity_of(in, *variant, study.quantity, std::nullopt, study.reduce).value;
}

void add_point(StudyRecord& record, const StudySpec& study, const CaseRecord& in) {
  const std::optional<double> x =
      is_slope(study) ? abscissa(in, study) : static_cast<double>(record.x.size());
  const std::optional<double> y = x ? value_in(in, study.variant, study) : std::nullopt;
  if (!y) return;
  if (study.kind == StudyKind::within_spread) {
    const std::optional<double> other = value_in(in, study.of, study);
    if (!other) return;
    record.y_of.push_back(*other);
  }
  if (is_slope(study)) require_positive(*x, study.against, study, in);
  if (is_slope(study) || study.kind == StudyKind::range)
    require_positive(*y, study.quantity, study, in);
  record.x.push_back(*x);
  record.y.push_back(*y);
}

Interval logarithmic_slope(const StudyRecord& record) {
  std::vector<double> x, y;
  for (const double value : record.x) x.push_back(std::log(value));
  for (const double value : record.y) y.push_back(std::log(value));
  return slope_with_interval(x, y);
}

/// No interval where there is no value, or none without one of the cases.
Interval pooled_interval(const StudyRecord& record) {
  const auto is_absent = [](double value) { return std::isnan(value); };
  if (!is_absent(record.value) && std::none_of(record.y.begin(), record.y.end(), is_absent)) {
    return jackknife_interval(record.value, record.y);
  }
  return {record.value, std::nan(""), std::nan("")};
}

/// Times of the frames of a variant that the case has.
std::vector<double> frame_times(const CaseRecord& in, const std::string& name,
                                const StudySpec& study) {
  std::vector<double> times;
  const VariantRecord& variant = *variant_in(in, name);
  for (const FrameRecord& frame : variant.frames) {
    const auto time = value_at(in, variant, study.quantity, frame.parameter);
    if (time) times.push_back(*time);
  }
  return times;
}

bool is_timed(const StudySpec& study) { return study.quantity.starts_with("timing:"); }

/// Adds cost and quality of a variant in a case; false where the case does not have the variant.
bool add_priced(const CaseRecord& in, const std::string& name, const StudySpec& study,
                Priced& priced) {
  const VariantRecord* variant = variant_in(in, name);
  if (variant == nullptr) return false;
  const double cost = quantity_of(in, *variant, study.quantity, std::nullopt, study.reduce).value;
  const double quality =
      quantity_of(in, *variant, study.match, std::nullopt, study.match_reduce).value;
  require_positive(cost, study.quantity, study, in);
  if (!std::isfinite(quality) || (study.of.empty() && quality < 0)) {
    throw Error(study.match + " of variant '" + name + "' is no error",
                "study '" + study.name + "', case '" + in.name + "'", "finite, not negative");
  }
  priced.cost.push_back(cost);
  priced.quality.push_back(quality);
  if (study.keep.empty()) return true;
  const double kept = quantity_of(in, *variant, study.keep, std::nullopt, study.match_reduce).value;
  priced.kept.push_back(study.keep_direction == Direction::lower_is_better ? -kept : kept);
  return true;
}

/// Adds a case to all samples; false, and some of them have it, where it lacks a variant.
bool add_case(const CaseRecord& in, const StudySpec& study, Matched& all) {
  bool whole = add_priced(in, study.variant, study, all.method);
  for (std::size_t f = 0; f < study.families.size(); ++f) {
    for (std::size_t m = 0; m < study.families[f].size(); ++m)
      whole = whole && add_priced(in, study.families[f][m], study, all.families[f][m]);
  }
  if (!whole || study.of.empty()) return whole;
  const VariantRecord* right = variant_in(in, study.of);
  if (right == nullptr) return false;
  all.truth.push_back(quantity_of(in, *right, study.match, std::nullopt, study.match_reduce).value);
  return true;
}

/// Of a single case the clock alone is drawn by chance: its frames stand for cases.
void draw_frames(const CaseRecord& in, const StudySpec& study, Matched& all) {
  const auto draw = [&](const std::string& name, Priced& priced) {
    priced.cost = frame_times(in, name, study);
    priced.quality.assign(priced.cost.size(), priced.quality.front());
    if (!priced.kept.empty()) priced.kept.assign(priced.cost.size(), priced.kept.front());
  };
  draw(study.variant, all.method);
  for (std::size_t f = 0; f < study.families.size(); ++f) {
    for (std::size_t m = 0; m < study.families[f].size(); ++m)
      draw(study.families[f][m], all.families[f][m]);
  }
  if (!all.truth.empty()) all.truth.assign(all.method.cost.size(), all.truth.front());
}

/// Value and interval: of all cases that have all variants; x: errors of the variant and of all
/// members, family after family; y: their costs.
void add_matched(StudyRecord& record, const StudySpec& study,
                 const std::vector<const CaseRecord*>& cases, std::uint64_t seed) {
  Matched all;
  all.cost = study.reduce == Reduction::mean ? Reduction::mean : Reduction::median;
  all.within = study.keep_within;
  for (const auto& family : study.families) all.families.emplace_back(family.size());
  std::vector<const CaseRecord*> kept;
  for (const CaseRecord* in : cases) {
    Matched next = all;
    if (!add_case(*in, study, next)) continue;
    all = std::move(next);
    kept.push_back(in);
  }
  if (kept.empty()) return;
  const auto add = [&](const Priced& priced) {
    record.x.push_back(error_of(priced, all.truth));
    record.y.push_back(cost_of(priced, all.cost));
  };
  add(all.method);
  for (const auto& family : all.families) std::for_each(family.begin(), family.end(), add);
  const bool one_number = study.reduce == Reduction::median || study.reduce == Reduction::mean;
  if (kept.size() == 1 && is_timed(study) && one_number) draw_frames(*kept.front(), study, all);
  const Interval ratio = matched_with_interval(all, RandomStream(seed, "study " + study.name));
  record.value = ratio.value;
  record.low = ratio.low;
  record.high = ratio.high;
}

/// Of times with the percentile interval over the frames of each case; what else is given has no
/// chance in it, and no interval.
Interval range_of(const StudySpec& study, const StudyRecord& record,
                  const std::vector<const CaseRecord*>& cases, std::uint64_t seed) {
  if (!is_timed(study)) return {largest_over_smallest(record.y), std::nan(""), std::nan("")};
  std::vector<std::vector<double>> times;
  for (const CaseRecord* in : cases) {
    if (variant_in(*in, study.variant) != nullptr)
      times.push_back(frame_times(*in, study.variant, study));
  }
  return range_with_interval(
      times, [&](std::vector<double> frames) { return reduced(std::move(frames), study.reduce); },
      RandomStream(seed, "study " + study.name));
}

Interval interval_of(const StudySpec& study, const StudyRecord& record,
                     const std::vector<const CaseRecord*>& cases, std::uint64_t seed) {
  if (study.kind == StudyKind::matched) return {record.value, record.low, record.high};
  if (study.kind == StudyKind::range) return range_of(study, record, cases, seed);
  if (study.kind == StudyKind::pooled) return pooled_interval(record);
  if (study.kind == StudyKind::spread) {
    return spread_with_interval(record.y, RandomStream(seed, "study " + study.name));
  }
  if (study.kind == StudyKind::within_spread) {
    return median_distance_with_interval(record.y, record.y_of,
                                         RandomStream(seed, "study " + study.name));
  }
  const Interval slope = logarithmic_slope(record);
  // Errors fall with a smaller step, or with a larger count: the order is positive either way.
  if (study.kind == StudyKind::order && study.finer == Finer::larger) {
    return {-slope.value, -slope.high, -slope.low};
  }
  return slope;
}

/// The quantity of the events of all variants but one, in time one variant after another; NaN where
/// they have none.
double pooled_value(const StudySpec& study, const std::vector<const VariantRecord*>& variants,
                    const VariantRecord* left_out) {
  std::vector<Event> all;
  double begin = 0, end = 0;
  for (const VariantRecord* variant : variants) {
    if (variant == left_out) continue;
    for (Event event : variant->events) {
      event.time_s += begin;
      end = std::max(end, event.time_s);
      all.push_back(std::move(event));
    }
    begin = end;
  }
  return study.of_events(all).value_or(std::nan(""));
}

/// The value: of the events of all cases together; y: of all but those of one.
void add_pooled(StudyRecord& record, const StudySpec& study,
                const std::vector<const CaseRecord*>& cases) {
  std::vector<const VariantRecord*> variants;
  for (const CaseRecord* in : cases) {
    if (const VariantRecord* found = variant_in(*in, study.variant)) variants.push_back(found);
  }
  for (const VariantRecord* variant : variants) {
    record.x.push_back(static_cast<double>(record.x.size()));
    record.y.push_back(pooled_value(study, variants, variant));
  }
  record.value = pooled_value(study, variants, nullptr);
}

std::vector<const CaseRecord*> cases_of(const StudySpec& study, const RunRecord& record) {
  std::vector<const CaseRecord*> cases;
  for (const CaseRecord& in : record.cases) {
    const bool named = study.cases.empty() || std::find(study.cases.begin(), study.cases.end(),
                                                        in.name) != study.cases.end();
    if (named) cases.push_back(&in);
  }
  return cases;
}

std::string needed_by(const StudySpec& study) {
  if (study.kind == StudyKind::matched) {
    return "a case with variant '" + study.variant + "' and all members of its families";
  }
  if (study.kind == StudyKind::spread || study.kind == StudyKind::pooled ||
      study.kind == StudyKind::range) {
    return "at least 2 cases with variant '" + study.variant + "'";
  }
  if (study.kind == StudyKind::within_spread) {
    return "at least 2 cases with variants '" + study.variant + "' and '" + study.of + "'";
  }
  return "at least 2 cases with '" + study.against + "', a fact of the scene or a swept key";
}

StudyRecord made_study(const StudySpec& study, const RunRecord& record) {
  StudyRecord made;
  made.name = study.name;
  made.kind = text_of(study.kind);
  made.quantity = study.quantity;
  const std::vector<const CaseRecord*> cases = cases_of(study, record);
  const std::uint64_t seed = record.cases.front().seed;
  if (study.kind == StudyKind::pooled) {
    add_pooled(made, study, cases);
  } else if (study.kind == StudyKind::matched) {
    add_matched(made, study, cases, seed);
  } else {
    for (const CaseRecord* in : cases) add_point(made, study, *in);
  }
  if (made.x.size() < 2) {
    throw Error("only " + std::to_string(made.x.size()) + " cases have what it needs",
                "study '" + study.name + "'", needed_by(study));
  }
  const Interval interval = interval_of(study, made, cases, seed);
  made.value = interval.value;
  made.low = interval.low;
  made.high = interval.high;
  return made;
}

}  // namespace

std::vector<StudyRecord> make_studies(const Experiment& experiment, const RunRecord& record) {
  std::vector<StudyRecord> studies;
  for (const StudySpec& study : experiment.studies) {
    try {
      studies.push_back(made_study(study, record));
    } catch (const Error&) {
      // A study of what could not run is none; claims about it fall short.
      if (!lacks_a_variant(record)) throw;
    }
  }
  return studies;
}

}  // namespace geoprior
