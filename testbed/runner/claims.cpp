#include "testbed/runner/claims.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/error.h"
#include "testbed/runner/frames_text.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/quantity.h"
#include "testbed/runner/studies.h"

namespace geoprior {
namespace {

const VariantRecord* variant_named(const CaseRecord& in, const std::string& name) {
  const auto found = std::find_if(in.variants.begin(), in.variants.end(),
                                  [&](const VariantRecord& v) { return v.name == name; });
  return found == in.variants.end() ? nullptr : &*found;
}

bool holds(const ClaimSpec& claim, double left, double right) {
  switch (claim.is) {
    case Comparison::less_equal:
      return left <= right;
    case Comparison::less:
      return left < right;
    case Comparison::greater_equal:
      return left >= right;
    case Comparison::greater:
      return left > right;
    case Comparison::equal:
      return std::abs(left - right) <= claim.tolerance;
  }
  throw Error("is no comparison", "claim '" + claim.text + "'");
}

/// "0.2 * 3.4e-06 + 1e-9 m^3 (+- 1e-12)".
std::string right_text(const ClaimSpec& claim, double other, const std::string& unit) {
  std::string text = rounded_text(other);
  if (claim.factor != 1) text = number_text(claim.factor) + " * " + text;
  if (claim.offset != 0) text += " + " + number_text(claim.offset);
  if (!unit.empty() && unit != "1") text += " " + unit;
  if (claim.is == Comparison::equal) text += " (within " + number_text(claim.tolerance) + ")";
  return text;
}

ClaimRecord decided(const ClaimSpec& claim, const std::string& subject, const Quantity& left,
                    double other) {
  ClaimRecord record;
  record.text = claim.text;
  record.left = left.value;
  record.right = claim.factor * other + claim.offset;
  record.holds = holds(claim, record.left, record.right);
  record.detail = subject + ": " + rounded_text(left.value) + " " + text_of(claim.is) + " " +
                  right_text(claim, other, left.unit);
  return record;
}

/// `at` must name the scene's parameter: 90 in another unit would be another frame.
void require_parameter(const ClaimSpec& claim, const CaseRecord& in) {
  if (!claim.at_parameter || claim.at_key.empty()) return;
  const std::string with_unit = in.parameter_name + "_" + in.parameter_unit;
  if (claim.at_key == with_unit || claim.at_key == in.parameter_name) return;
  throw Error("the frames have no parameter '" + claim.at_key + "'",
              "claim '" + claim.text + "', case '" + in.name + "'", with_unit);
}

ClaimRecord decide_in_case(const ClaimSpec& claim, const CaseRecord& in,
                           const VariantRecord& variant, const VariantRecord* of) {
  require_parameter(claim, in);
  const auto value = [&](const VariantRecord& v, Reduction reduce) {
    return quantity_of(in, v, claim.metric, claim.at_parameter, reduce);
  };
  const Quantity left = value(variant, claim.reduce);
  const Reduction of_reduce = claim.of_reduce.value_or(claim.reduce);
  std::string subject = claim.metric + " of " + variant.name;
  if (claim.at_parameter) {
    subject += " at " + in.parameter_name + " " + number_text(*claim.at_parameter) + " " +
               in.parameter_unit;
  } else if (!variant.summary.contains(claim.metric)) {
    subject += " (" + text_of(claim.reduce) + ")";
  }
  if (of != nullptr) subject += " against " + of->name;
  if (claim.of_reduce) subject += " (" + text_of(of_reduce) + ")";
  const double other = of != nullptr ? value(*of, of_reduce).value : claim.value.value_or(0);
  ClaimRecord record = decided(claim, subject, left, other);
  record.case_name = in.name;
  return record;
}

/// How far the claim is from failing; negative when it fails.
double margin(const ClaimSpec& claim, const ClaimRecord& record) {
  if (claim.is == Comparison::equal) return claim.tolerance - std::abs(record.left - record.right);
  const bool below = claim.is == Comparison::less_equal || claim.is == Comparison::less;
  return below ? record.right - record.left : record.left - record.right;
}

/// Frame by frame; the frame nearest to failing speaks for all. Frames where a side has no value
/// are passed over, but one at least must have both.
ClaimRecord decide_every_frame(const ClaimSpec& claim, const CaseRecord& in,
                               const VariantRecord& variant, const VariantRecord* of) {
  std::optional<ClaimRecord> worst;
  const auto has_value = [&](const VariantRecord& v, double parameter) {
    return value_at(in, v, claim.metric, parameter).has_value();
  };
  for (const FrameRecord& frame : variant.frames) {
    if (!has_value(variant, frame.parameter)) continue;
    if (of != nullptr && !has_value(*of, frame.parameter)) continue;
    ClaimSpec here = claim;
    here.at_parameter = frame.parameter;
    ClaimRecord record = decide_in_case(here, in, variant, of);
    const bool worse =
        !worst || (worst->holds && !record.holds) ||
        (worst->holds == record.holds && margin(claim, record) < margin(claim, *worst));
    if (worse) worst = std::move(record);
  }
  if (!worst) {
    throw Error("no frame has a value of '" + claim.metric + "'",
                "claim '" + claim.text + "', case '" + in.name + "'");
  }
  return *worst;
}

/// A variant that broke off has values of some frames only: they decide nothing.
std::optional<ClaimRecord> fallen_short(const ClaimSpec& claim, const CaseRecord& in,
                                        const VariantRecord& variant, const VariantRecord* of) {
  for (const VariantRecord* side : {&variant, of}) {
    if (side == nullptr || side->status != "failed") continue;
    ClaimRecord record;
    record.text = claim.text;
    record.case_name = in.name;
    record.left = record.right = std::numeric_limits<double>::quiet_NaN();
    record.detail = "variant '" + side->name + "' failed after " +
                    frames_text(side->frames.size()) + ": " + side->error;
    return record;
  }
  return std::nullopt;
}

ClaimRecord decide_for(const ClaimSpec& claim, const CaseRecord& in, const VariantRecord& variant,
                       const VariantRecord* of) {
  if (auto record = fallen_short(claim, in, variant, of)) return *record;
  const bool every = claim.reduce == Reduction::every && !claim.at_parameter;
  return every ? decide_every_frame(claim, in, variant, of)
               : decide_in_case(claim, in, variant, of);
}

ClaimRecord decide_study(const ClaimSpec& claim, const std::vector<StudyRecord>& studies) {
  const std::string name = claim.metric.substr(6);
  for (const StudyRecord& study : studies) {
    if (study.name != name) continue;
    return decided(claim, study.kind + " of " + study.quantity + " (study '" + name + "')",
                   {study.value, ""}, claim.value.value_or(0));
  }
  throw Error("the run has no study '" + name + "'", "claim '" + claim.text + "'");
}

}  // namespace

std::vector<ClaimRecord> decide_claims(const Experiment& experiment, const RunRecord& record) {
  std::vector<ClaimRecord> decisions;
  std::vector<StudyRecord> studies = record.studies;
  if (studies.empty()) studies = make_studies(experiment, record);
  for (const ClaimSpec& claim : experiment.claims) {
    if (claim.metric.starts_with("study:")) {
      decisions.push_back(decide_study(claim, studies));
      continue;
    }
    std::size_t decided_in = 0;
    for (const CaseRecord& in : record.cases) {
      const bool named =
          std::find(claim.cases.begin(), claim.cases.end(), in.name) != claim.cases.end();
      if (!claim.cases.empty() && !named) continue;
      const VariantRecord* variant = variant_named(in, claim.variant);
      const VariantRecord* of = claim.of ? variant_named(in, *claim.of) : nullptr;
      const bool complete = variant != nullptr && (!claim.of || of != nullptr);
      if (!complete && named) {
        throw Error("has not both variants", "claim '" + claim.text + "', case '" + in.name + "'");
      }
      if (!complete) continue;
      decisions.push_back(decide_for(claim, in, *variant, of));
      ++decided_in;
    }
    if (decided_in == 0) {
      throw Error("no case has what it is about", "claim '" + claim.text + "'",
                  "variant '" + claim.variant + "'" + (claim.of ? " and '" + *claim.of + "'" : ""));
    }
  }
  return decisions;
}

}  // namespace geoprior
