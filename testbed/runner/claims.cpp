#include "testbed/runner/claims.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/error.h"
#include "testbed/runner/frames_text.h"
#include "testbed/runner/judgement.h"
#include "testbed/runner/number_text.h"
#include "testbed/runner/studies.h"

namespace geoprior {
namespace {

/// The share of the seeds in which a claim must hold, and its null must fail.
constexpr double kShareOfSeeds = 0.9;
constexpr std::size_t kLeastSeeds = 10;

/// What a claim comes to in one case, with the numbers behind it.
struct Decision {
  ClaimRecord record;
  std::optional<Judgement> own;  ///< absent where a side failed
  std::vector<std::string> passed_too;
};

void speak(ClaimRecord& record, const Judgement::Comparison& worst) {
  record.left = worst.left;
  record.right = worst.right;
  record.holds = worst.holds;
  record.detail = worst.detail;
}

/// The claim is `a < b` or `a > b` with its null for b: the null fails as a value is not less than
/// itself, and it is the claim's own margin that must be more than nothing.
bool null_is_yardstick(const ClaimSpec& claim) {
  return claim.null && claim.of == claim.null && claim.factor == 1 && claim.offset == 0 &&
         !claim.of_reduce;
}

bool is_clear(const Judgement::Comparison& worst, const Tolerance& tolerance) {
  return worst.margin > tolerance.absolute + tolerance.relative * std::abs(worst.left);
}

/// What the null's judgement says of a claim that was judged `own`.
Discrimination verdict_of(const ClaimSpec& claim, const Judgement& own, const Judgement& null) {
  const Tolerance& tolerance = claim.metric_tolerance;
  bool seen = false;
  if (claim.known_shortfall && !own.holds()) {
    const double gap = own.worst().margin - null.worst().margin;
    seen = gap > tolerance.absolute + tolerance.relative * std::abs(null.worst().left);
  } else if (null_is_yardstick(claim)) {
    seen = is_clear(own.worst(), tolerance);
  } else {
    seen = null.fails_clearly(tolerance);
  }
  return seen ? Discrimination::discriminates : Discrimination::is_void;
}

/// `judge_null` puts the null in the place of the variant; what it throws leaves the claim
/// undecided.
template <class JudgeNull>
NullRecord null_record(const ClaimSpec& claim, const std::optional<Judgement>& own,
                       JudgeNull judge_null) {
  NullRecord record;
  record.left = record.right = std::numeric_limits<double>::quiet_NaN();
  if (!claim.null) {
    const bool exempt = claim.exempt != Exemption::none;
    record.verdict = exempt ? Discrimination::exempt : Discrimination::unasked;
    return record;
  }
  record.variant = *claim.null;
  record.verdict = Discrimination::undecided;
  record.detail = "the claim's own variant failed";
  if (!own) return record;
  try {
    const Judgement null = judge_null(*claim.null);
    record.left = null.worst().left;
    record.right = null.worst().right;
    record.detail = null.worst().detail;
    record.verdict = verdict_of(claim, *own, null);
  } catch (const Error& error) {
    record.detail = error.what();
  }
  return record;
}

/// A variant that broke off has values of some frames only: they decide nothing.
std::optional<std::string> fallen_short(const VariantRecord& variant, const VariantRecord* of) {
  for (const VariantRecord* side : {&variant, of}) {
    if (side == nullptr || side->status != "failed") continue;
    return "variant '" + side->name + "' failed after " + frames_text(side->frames.size()) + ": " +
           side->error;
  }
  return std::nullopt;
}

/// The variants beside those of the claim that the inequality holds for.
std::vector<std::string> others_that_pass(const ClaimSpec& claim, const CaseRecord& in) {
  std::vector<std::string> names;
  for (const VariantRecord& other : in.variants) {
    const bool named =
        other.name == claim.variant || claim.null == other.name || claim.of == other.name;
    if (named || is_null_control(other.role)) continue;
    try {
      if (judge(claim, in, other.name).holds()) names.push_back(other.name);
    } catch (const Error&) {  // has no value: it does not pass
    }
  }
  return names;
}

Decision decide_in_case(const ClaimSpec& claim, const CaseRecord& in, const VariantRecord& variant,
                        const VariantRecord* of) {
  Decision decision;
  ClaimRecord& record = decision.record;
  record.text = claim.text;
  record.case_name = in.name;
  if (const auto reason = fallen_short(variant, of)) {
    record.left = record.right = std::numeric_limits<double>::quiet_NaN();
    record.detail = *reason;
  } else {
    decision.own = judge(claim, in, claim.variant);
    speak(record, decision.own->worst());
    decision.passed_too = others_that_pass(claim, in);
  }
  record.null = null_record(claim, decision.own,
                            [&](const std::string& null) { return judge(claim, in, null); });
  return decision;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

bool most(std::size_t count, std::size_t of) {
  return static_cast<double>(count) >= kShareOfSeeds * static_cast<double>(of);
}

/// Names that stand in at least nine of ten of the lists.
std::vector<std::string> in_most(const std::vector<Decision>& seeds) {
  std::map<std::string, std::size_t> count;
  for (const Decision& seed : seeds) {
    for (const std::string& name : seed.passed_too) ++count[name];
  }
  std::vector<std::string> names;
  for (const auto& [name, n] : count) {
    if (most(n, seeds.size())) names.push_back(name);
  }
  return names;
}

Discrimination verdict_over(const std::vector<Decision>& seeds) {
  std::size_t discriminating = 0;
  for (const Decision& seed : seeds) {
    const Discrimination verdict = seed.record.null.verdict;
    if (verdict == Discrimination::undecided || verdict == Discrimination::exempt ||
        verdict == Discrimination::unasked) {
      return verdict;
    }
    if (verdict == Discrimination::discriminates) ++discriminating;
  }
  return most(discriminating, seeds.size()) ? Discrimination::discriminates
                                            : Discrimination::is_void;
}

/// "9 of 10 seeds; worst: …": the seed nearest to failing speaks for the claim, that nearest to
/// passing for its null.
ClaimRecord over_seeds(const std::vector<Decision>& seeds) {
  const auto margin = [](const Decision& d) {
    return d.own ? d.own->worst().margin : -std::numeric_limits<double>::infinity();
  };
  const auto worst =
      std::min_element(seeds.begin(), seeds.end(),
                       [&](const auto& a, const auto& b) { return margin(a) < margin(b); });
  const auto held = static_cast<std::size_t>(
      std::count_if(seeds.begin(), seeds.end(), [](const auto& d) { return d.record.holds; }));
  ClaimRecord record = worst->record;
  record.case_name = seeds.front().record.case_name;
  record.holds = most(held, seeds.size());
  record.detail = std::to_string(held) + " of " + std::to_string(seeds.size()) +
                  " seeds; worst: " + worst->record.detail;
  record.null.verdict = verdict_over(seeds);
  const auto first = std::find_if(seeds.begin(), seeds.end(), [&](const Decision& d) {
    return d.record.null.verdict != Discrimination::discriminates;
  });
  if (first != seeds.end()) {
    const Discrimination verdict = record.null.verdict;
    record.null = first->record.null;
    record.null.verdict = verdict;
  }
  record.passed_too = joined(in_most(seeds));
  return record;
}

/// What was swept beside the seed: cases that agree in it are one case under several seeds.
std::map<std::string, std::string> without_seed(std::map<std::string, std::string> swept) {
  swept.erase("seed");
  return swept;
}

using Cases = std::vector<const CaseRecord*>;

/// The cases that the claim is about: one a group, or all seeds of one.
std::vector<Cases> groups_of(const ClaimSpec& claim, const RunRecord& record) {
  const auto named = [&](const CaseRecord& in) {
    return claim.cases.empty() ||
           std::find(claim.cases.begin(), claim.cases.end(), in.name) != claim.cases.end();
  };
  std::vector<Cases> groups;
  for (const CaseRecord& in : record.cases) {
    const auto same = [&](const Cases& group) {
      return claim.over == ClaimOver::seed &&
             without_seed(group.front()->swept) == without_seed(in.swept);
    };
    const auto found = std::find_if(groups.begin(), groups.end(), same);
    (found == groups.end() ? groups.emplace_back() : *found).push_back(&in);
  }
  std::erase_if(groups, [&](const Cases& group) {
    return std::none_of(group.begin(), group.end(), [&](const auto* in) { return named(*in); });
  });
  return groups;
}

/// The decision in each case of the group that has the sides; those are all of a group that `cases`
/// names.
std::vector<Decision> decide_group(const ClaimSpec& claim, const Cases& group) {
  std::vector<Decision> decisions;
  for (const CaseRecord* in : group) {
    const VariantRecord* variant = find_variant(*in, claim.variant);
    const VariantRecord* of = claim.of ? find_variant(*in, *claim.of) : nullptr;
    if (variant != nullptr && (!claim.of || of != nullptr)) {
      decisions.push_back(decide_in_case(claim, *in, *variant, of));
    } else if (!claim.cases.empty()) {
      throw Error("has not both variants", "claim '" + claim.text + "', case '" + in->name + "'");
    }
  }
  return decisions;
}

std::vector<ClaimRecord> decide_in_cases(const ClaimSpec& claim, const Experiment& experiment,
                                         const RunRecord& record) {
  std::vector<ClaimRecord> decided;
  for (const Cases& group : groups_of(claim, record)) {
    std::vector<Decision> decisions = decide_group(claim, group);
    if (decisions.empty()) continue;
    if (claim.over == ClaimOver::seed) {
      if (!experiment.quick && decisions.size() < kLeastSeeds) {
        throw Error("only " + std::to_string(decisions.size()) + " seeds have what it needs",
                    "claim '" + claim.text + "', case '" + group.front()->name + "'",
                    "at least " + std::to_string(kLeastSeeds) + ", of a sweep over `seed`");
      }
      decided.push_back(over_seeds(decisions));
    } else {
      decisions.front().record.passed_too = joined(decisions.front().passed_too);
      decided.push_back(std::move(decisions.front().record));
    }
  }
  if (decided.empty()) {
    throw Error("no case has what it is about", "claim '" + claim.text + "'",
                "variant '" + claim.variant + "'" + (claim.of ? " and '" + *claim.of + "'" : ""));
  }
  return decided;
}

/// The studies with `null` in the place of the variant of the one that the claim is about; `of`
/// stays.
std::vector<StudyRecord> studies_of_null(const ClaimSpec& claim, const Experiment& experiment,
                                         const RunRecord& record, const std::string& null) {
  Experiment replaced;
  for (const StudySpec& study : experiment.studies) {
    if ("study:" + study.name != claim.metric) continue;
    replaced.studies.push_back(study);
    replaced.studies.back().variant = null;
  }
  return make_studies(replaced, record);
}

ClaimRecord decide_study(const ClaimSpec& claim, const Experiment& experiment,
                         const RunRecord& record, const std::vector<StudyRecord>& studies) {
  const Judgement own = judge_study(claim, studies);
  ClaimRecord decided;
  decided.text = claim.text;
  speak(decided, own.worst());
  decided.null = null_record(claim, own, [&](const std::string& null) {
    return judge_study(claim, studies_of_null(claim, experiment, record, null));
  });
  return decided;
}

}  // namespace

std::vector<ClaimRecord> decide_claims(const Experiment& experiment, const RunRecord& record) {
  std::vector<ClaimRecord> decisions;
  std::vector<StudyRecord> studies = record.studies;
  if (studies.empty()) studies = make_studies(experiment, record);
  for (const ClaimSpec& claim : experiment.claims) {
    if (claim.metric.starts_with("study:")) {
      decisions.push_back(decide_study(claim, experiment, record, studies));
      continue;
    }
    for (ClaimRecord& decided : decide_in_cases(claim, experiment, record)) {
      decisions.push_back(std::move(decided));
    }
  }
  return decisions;
}

std::optional<double> slack(const ClaimRecord& claim) {
  if (claim.right == 0 || !std::isfinite(claim.left) || !std::isfinite(claim.right)) {
    return std::nullopt;
  }
  return claim.left / claim.right;
}

bool is_sound(const ClaimRecord& claim) {
  return claim.null.verdict != Discrimination::is_void &&
         claim.null.verdict != Discrimination::undecided;
}

}  // namespace geoprior
