#include "testbed/runner/judgement/judgement.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "testbed/runner/journal/frames_text.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/options/quantity.h"

namespace geoprior {
namespace {

bool satisfies(const ClaimSpec& claim, double left, double right) {
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

Judgement::Trial compared(const ClaimSpec& claim, const std::string& subject, const Quantity& left,
                          double other) {
  Judgement::Trial made;
  made.left = left.value;
  made.right = claim.factor * other + claim.offset;
  made.holds = satisfies(claim, made.left, made.right);
  made.margin = margin_of(claim, made.left, made.right);
  made.detail = subject + ": " + rounded_text(left.value) + " " + text_of(claim.is) + " " +
                right_text(claim, other, left.unit);
  return made;
}

/// `at` must name the scene's parameter: 90 in another unit would be another frame.
void require_parameter(const ClaimSpec& claim, const CaseRecord& in) {
  if (!claim.at_parameter || claim.at_key.empty()) return;
  const std::string with_unit = in.parameter_name + "_" + in.parameter_unit;
  if (claim.at_key == with_unit || claim.at_key == in.parameter_name) return;
  throw Error("the frames have no parameter '" + claim.at_key + "'",
              "claim '" + claim.text + "', case '" + in.name + "'", with_unit);
}

Judgement::Trial compare_in_case(const ClaimSpec& claim, const CaseRecord& in,
                                 const VariantRecord& variant, const VariantRecord* of) {
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
  return compared(claim, subject, left, other);
}

/// Frame by frame. Frames where a side has no value are passed over, but one at least must have
/// both.
std::vector<Judgement::Trial> compare_every_frame(const ClaimSpec& claim, const CaseRecord& in,
                                                  const VariantRecord& variant,
                                                  const VariantRecord* of) {
  std::vector<Judgement::Trial> made;
  const auto has_value = [&](const VariantRecord& v, double parameter) {
    return value_at(in, v, claim.metric, parameter).has_value();
  };
  for (const FrameRecord& frame : variant.frames) {
    if (!has_value(variant, frame.parameter)) continue;
    if (of != nullptr && !has_value(*of, frame.parameter)) continue;
    ClaimSpec here = claim;
    here.at_parameter = frame.parameter;
    made.push_back(compare_in_case(here, in, variant, of));
  }
  if (made.empty()) {
    throw Error("no frame has a value of '" + claim.metric + "'",
                "claim '" + claim.text + "', case '" + in.name + "'");
  }
  return made;
}

const VariantRecord& require_variant(const ClaimSpec& claim, const CaseRecord& in,
                                     const std::string& name) {
  const VariantRecord* variant = find_variant(in, name);
  if (variant != nullptr && variant->status != "failed") return *variant;
  if (variant == nullptr) {
    throw Error("has no variant '" + name + "'",
                "claim '" + claim.text + "', case '" + in.name + "'");
  }
  throw Error("variant '" + name + "' " + failure_text(variant->frames.size(), variant->error),
              "claim '" + claim.text + "', case '" + in.name + "'");
}

}  // namespace

double margin_of(const ClaimSpec& claim, double left, double right) {
  if (claim.is == Comparison::equal) return claim.tolerance - std::abs(left - right);
  const bool below = claim.is == Comparison::less_equal || claim.is == Comparison::less;
  return below ? right - left : left - right;
}

const Judgement::Trial& Judgement::worst() const {
  return *std::min_element(trials.begin(), trials.end(), [](const auto& a, const auto& b) {
    return a.holds != b.holds ? b.holds : a.margin < b.margin;
  });
}

bool Judgement::fails_clearly(const Tolerance& tolerance) const {
  const auto failing = std::count_if(trials.begin(), trials.end(), [&](const auto& one) {
    return !one.holds && -one.margin > tolerance.of(one.left);
  });
  return 2 * static_cast<std::size_t>(failing) >= trials.size() && failing > 0;
}

Judgement judge(const ClaimSpec& claim, const CaseRecord& in, const std::string& variant) {
  require_parameter(claim, in);
  const VariantRecord& left = require_variant(claim, in, variant);
  const VariantRecord* of = claim.of ? &require_variant(claim, in, *claim.of) : nullptr;
  const bool every = claim.reduce == Reduction::every && !claim.at_parameter;
  if (every) return {compare_every_frame(claim, in, left, of)};
  return {{compare_in_case(claim, in, left, of)}};
}

Judgement judge_study(const ClaimSpec& claim, const std::vector<StudyRecord>& studies) {
  const std::string name = claim.metric.substr(6);
  for (const StudyRecord& study : studies) {
    if (study.name != name) continue;
    return {{compared(claim, study.kind + " of " + study.quantity + " (study '" + name + "')",
                      {study.value, ""}, claim.value.value_or(0))}};
  }
  throw Error("the run has no study '" + name + "'", "claim '" + claim.text + "'");
}

}  // namespace geoprior
