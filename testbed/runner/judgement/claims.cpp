#include "testbed/runner/judgement/claims.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "core/error.h"
#include "testbed/joined.h"
#include "testbed/runner/journal/frames_text.h"
#include "testbed/runner/judgement/judgement.h"
#include "testbed/runner/judgement/studies.h"

namespace geoprior {
namespace {

/// The share of the seeds in which a claim must hold, and its null must fail.
constexpr double kShareOfSeeds = 0.9;
constexpr std::size_t kLeastSeeds = 10;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What a claim comes to in one case, with the numbers behind it.
struct Decision {
  ClaimRecord record;
  double margin = -kInfinity;       ///< of the trial nearest to failing; -infinity: a side failed
  double null_margin = -kInfinity;  ///< of the null's; -infinity: it has no value
  std::vector<std::string> passed_too;
};

void speak(Decision& decision, const Judgement::Trial& worst) {
  ClaimRecord& record = decision.record;
  record.left = worst.left;
  record.right = worst.right;
  record.holds = worst.holds;
  record.detail = worst.detail;
  decision.margin = worst.margin;
}

/// What the null's judgement says of a claim that was judged `own`.
Discrimination verdict_of(const ClaimSpec& claim, const Judgement& own, const Judgement& null) {
  const Tolerance& tolerance = claim.metric_tolerance;
  bool seen = false;
  if (claim.known_shortfall && !own.holds()) {
    seen = own.worst().margin - null.worst().margin > tolerance.of(null.worst().left);
  } else if (null_is_yardstick(claim)) {
    seen = own.worst().margin > tolerance.of(own.worst().left);
  } else {
    seen = null.fails_clearly(tolerance);
  }
  return seen ? Discrimination::discriminates : Discrimination::is_void;
}

/// Adds what the null says; `own` is null where a side failed. `judge_null` puts the null in the
/// place of the variant; what it throws leaves the claim undecided.
template <class JudgeNull>
void ask_null(const ClaimSpec& claim, const Judgement* own, JudgeNull judge_null,
              Decision& decision) {
  NullRecord& record = decision.record.null;
  record.left = record.right = std::numeric_limits<double>::quiet_NaN();
  if (!claim.null) {
    const bool exempt = claim.exempt != Exemption::none;
    record.verdict = exempt ? Discrimination::exempt : Discrimination::unasked;
    return;
  }
  record.variant = *claim.null;
  record.verdict = Discrimination::undecided;
  record.detail = "the claim's own variant failed";
  if (own == nullptr) return;
  try {
    const Judgement null = judge_null(*claim.null);
    record.left = null.worst().left;
    record.right = null.worst().right;
    record.detail = null.worst().detail;
    record.verdict = verdict_of(claim, *own, null);
    decision.null_margin = null.worst().margin;
  } catch (const Error& error) {
    record.detail = error.what();
  }
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
  const auto judge_null = [&](const std::string& null) { return judge(claim, in, null); };
  if (const auto reason = fallen_short(variant, of)) {
    record.left = record.right = std::numeric_limits<double>::quiet_NaN();
    record.detail = *reason;
    ask_null(claim, nullptr, judge_null, decision);
    return decision;
  }
  const Judgement own = judge(claim, in, claim.variant);
  speak(decision, own.worst());
  decision.passed_too = others_that_pass(claim, in);
  ask_null(claim, &own, judge_null, decision);
  return decision;
}

bool most(std::size_t count, std::size_t of) {
  return static_cast<double>(count) >= kShareOfSeeds * static_cast<double>(of);
}

using Cases = std::vector<const CaseRecord*>;

/// Variants that pass in at least nine of ten of the cases that have them.
std::vector<std::string> that_mostly_pass(const std::vector<Decision>& seeds, const Cases& group) {
  std::map<std::string, std::size_t> passed;
  for (const Decision& seed : seeds) {
    for (const std::string& name : seed.passed_too) ++passed[name];
  }
  std::vector<std::string> names;
  for (const auto& [name, n] : passed) {
    const auto has = [&](const CaseRecord* in) { return find_variant(*in, name) != nullptr; };
    const std::size_t cases = std::count_if(group.begin(), group.end(), has);
    if (most(n, cases)) names.push_back(name);
  }
  return names;
}

/// What the null says in all seeds together: of seeds that it leaves undecided the first, else in
/// the words of the seed in which it comes nearest to passing.
NullRecord null_over(const std::vector<Decision>& seeds) {
  const auto is = [](Discrimination verdict) {
    return [verdict](const Decision& seed) { return seed.record.null.verdict == verdict; };
  };
  const Discrimination first = seeds.front().record.null.verdict;
  const bool asked = first != Discrimination::exempt && first != Discrimination::unasked;
  if (!asked) return seeds.front().record.null;
  const auto undecided = std::find_if(seeds.begin(), seeds.end(), is(Discrimination::undecided));
  if (undecided != seeds.end()) return undecided->record.null;
  NullRecord null = std::max_element(seeds.begin(), seeds.end(), [](const auto& a, const auto& b) {
                      return a.null_margin < b.null_margin;
                    })->record.null;
  const std::size_t failed =
      std::count_if(seeds.begin(), seeds.end(), is(Discrimination::discriminates));
  null.verdict =
      most(failed, seeds.size()) ? Discrimination::discriminates : Discrimination::is_void;
  return null;
}

/// "9 of 10 seeds; worst: …": the seed nearest to failing speaks for the claim.
ClaimRecord over_seeds(const std::vector<Decision>& seeds, const Cases& group) {
  const auto worst = std::min_element(
      seeds.begin(), seeds.end(), [](const auto& a, const auto& b) { return a.margin < b.margin; });
  const std::size_t held =
      std::count_if(seeds.begin(), seeds.end(), [](const auto& d) { return d.record.holds; });
  ClaimRecord record = worst->record;
  record.case_name = seeds.front().record.case_name;
  record.holds = most(held, seeds.size());
  record.detail = std::to_string(held) + " of " + std::to_string(seeds.size()) +
                  " seeds; worst: " + worst->record.detail;
  record.null = null_over(seeds);
  record.passed_too = joined(that_mostly_pass(seeds, group));
  return record;
}

/// What was swept beside the seed: cases that agree in it are one case under several seeds.
std::map<std::string, std::string> without_seed(std::map<std::string, std::string> swept) {
  swept.erase("seed");
  return swept;
}

bool named_by(const ClaimSpec& claim, const CaseRecord& in) {
  return std::find(claim.cases.begin(), claim.cases.end(), in.name) != claim.cases.end();
}

/// The cases that the claim is about: one a group, or all seeds of one.
std::vector<Cases> groups_of(const ClaimSpec& claim, const RunRecord& record) {
  std::vector<Cases> groups;
  for (const CaseRecord& in : record.cases) {
    if (in.claims_only && claim.over == ClaimOver::case_ && !named_by(claim, in)) continue;
    const auto same = [&](const Cases& group) {
      return claim.over == ClaimOver::seed &&
             without_seed(group.front()->swept) == without_seed(in.swept);
    };
    const auto found = std::find_if(groups.begin(), groups.end(), same);
    (found == groups.end() ? groups.emplace_back() : *found).push_back(&in);
  }
  std::erase_if(groups, [&](const Cases& group) {
    return !claim.cases.empty() && std::none_of(group.begin(), group.end(), [&](const auto* in) {
      return named_by(claim, *in);
    });
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
      decided.push_back(over_seeds(decisions, group));
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
  replaced.studies = {*study_of(claim, experiment.studies)};
  replaced.studies.front().variant = null;
  return make_studies(replaced, record);
}

ClaimRecord decide_study(const ClaimSpec& claim, const Experiment& experiment,
                         const RunRecord& record, const std::vector<StudyRecord>& studies) {
  const Judgement own = judge_study(claim, studies);
  Decision decision;
  decision.record.text = claim.text;
  speak(decision, own.worst());
  const auto judge_null = [&](const std::string& null) {
    return judge_study(claim, studies_of_null(claim, experiment, record, null));
  };
  ask_null(claim, &own, judge_null, decision);
  return decision.record;
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
  return claim.null.verdict == Discrimination::discriminates ||
         claim.null.verdict == Discrimination::exempt;
}

}  // namespace geoprior
