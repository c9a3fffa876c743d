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
#include "testbed/runner/judgement/timed_claims.h"
#include "testbed/runner/number_text.h"

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
    return "variant '" + side->name + "' " + failure_text(side->frames.size(), side->error);
  }
  return std::nullopt;
}

/// A time decides what its interval tells from equality, on the machine that it was taken on.
void ask_clock(const Interval& margin, const std::string& unit, Decision& decision) {
  NullRecord& record = decision.record.null;
  record.detail = "a single time, which has no interval";
  if (!std::isnan(margin.low)) {
    record.detail = "margin " + rounded_text(margin.value, 3) + unit + ", 95 % interval [" +
                    rounded_text(margin.low, 3) + ", " + rounded_text(margin.high, 3) + "]" + unit;
  }
  if (!is_decided(margin)) record.verdict = Discrimination::undecided;
}

bool is_about(const ClaimSpec& claim, const std::string& variant) {
  return variant == claim.variant ||
         std::find(claim.variants.begin(), claim.variants.end(), variant) != claim.variants.end();
}

/// All other variants of the case in the place of the claim's: which pass, and which fails by
/// least.
void ask_others(const ClaimSpec& claim, const CaseRecord& in, Decision& decision) {
  double least = -kInfinity;
  for (const VariantRecord& other : in.variants) {
    if (is_about(claim, other.name)) continue;
    try {
      const Judgement judgement = judge(claim, in, other.name);
      const bool named = claim.null == other.name || claim.of == other.name;
      if (!judgement.holds() && judgement.worst().margin > least) {
        least = judgement.worst().margin;
        decision.record.nearest = other.name;
      } else if (judgement.holds() && !named) {
        decision.passed_too.push_back(other.name);
      }
    } catch (const Error&) {  // has no value: it does not pass
    }
  }
}

Decision decide_in_case(const ClaimSpec& claim, const CaseRecord& in, const VariantRecord& variant,
                        const VariantRecord* of) {
  Decision decision;
  ClaimRecord& record = decision.record;
  record.text = claim.text;
  record.case_name = in.name;
  record.variant = claim.variant;
  const auto judge_null = [&](const std::string& null) { return judge(claim, in, null); };
  if (const auto reason = fallen_short(variant, of)) {
    record.left = record.right = std::numeric_limits<double>::quiet_NaN();
    record.detail = *reason;
    ask_null(claim, nullptr, judge_null, decision);
    return decision;
  }
  const Judgement own = judge(claim, in, claim.variant);
  speak(decision, own.worst());
  ask_others(claim, in, decision);
  ask_null(claim, &own, judge_null, decision);
  if (claim.exempt == Exemption::timing)
    ask_clock(timed_margin(claim, in, in.seed), " s", decision);
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
Decision over_seeds(const std::vector<Decision>& seeds, const Cases& group) {
  const auto worst = std::min_element(
      seeds.begin(), seeds.end(), [](const auto& a, const auto& b) { return a.margin < b.margin; });
  const std::size_t held =
      std::count_if(seeds.begin(), seeds.end(), [](const auto& d) { return d.record.holds; });
  Decision all = *worst;
  ClaimRecord& record = all.record;
  record.case_name = seeds.front().record.case_name;
  record.holds = most(held, seeds.size());
  record.detail = std::to_string(held) + " of " + std::to_string(seeds.size()) +
                  (seeds.size() == 1 ? " seed; worst: " : " seeds; worst: ") + worst->record.detail;
  record.null = null_over(seeds);
  for (const Decision& seed : seeds) {  // naming one of its seeds excepts the case
    if (record.excepted.empty()) record.excepted = seed.record.excepted;
  }
  all.passed_too = that_mostly_pass(seeds, group);
  return all;
}

/// What was swept beside the seed: cases that agree in it are one case under several seeds.
std::map<std::string, std::string> without_seed(std::map<std::string, std::string> swept) {
  swept.erase("seed");
  return swept;
}

/// The cases that a claim is decided in: one a group, or all seeds of one. Of what is not decided
/// over seeds (times and oracles, where further seeds run) the file's own seed decides.
std::vector<Cases> groups_of(const ClaimSpec& claim, const RunRecord& record) {
  std::vector<Cases> groups;
  for (const CaseRecord& in : record.cases) {
    const bool is_seed = in.claims_only && in.swept.contains("seed");
    if (is_seed && claim.over == ClaimOver::case_) continue;
    const auto same = [&](const Cases& group) {
      return claim.over == ClaimOver::seed &&
             without_seed(group.front()->swept) == without_seed(in.swept);
    };
    const auto found = std::find_if(groups.begin(), groups.end(), same);
    (found == groups.end() ? groups.emplace_back() : *found).push_back(&in);
  }
  return groups;
}

/// The decision in each case of the group that has the sides. Where they have no value in any, the
/// reason is put into `without_value`.
/// @throws Error  where they have a value in some of the cases only
std::vector<Decision> decide_group(const ClaimSpec& claim, const Cases& group,
                                   std::optional<Error>& without_value) {
  std::vector<Decision> decisions;
  std::optional<Error> missing;
  for (const CaseRecord* in : group) {
    const VariantRecord* variant = find_variant(*in, claim.variant);
    const VariantRecord* of = claim.of ? find_variant(*in, *claim.of) : nullptr;
    if (variant == nullptr || (claim.of && of == nullptr)) continue;
    try {
      decisions.push_back(decide_in_case(claim, *in, *variant, of));
    } catch (const Error& error) {
      missing = error;
      continue;
    }
    const auto excepted = claim.except.find(in->name);
    if (excepted != claim.except.end()) decisions.back().record.excepted = excepted->second;
  }
  if (missing && !decisions.empty()) throw Error(*missing);
  if (missing && !without_value) without_value = missing;
  return decisions;
}

/// In every case that has the sides, each with a value; over seeds, those that a case has, of which
/// one at least must have ten.
std::vector<Decision> decide_in_cases(const ClaimSpec& claim, const Experiment& experiment,
                                      const RunRecord& record) {
  std::vector<Decision> decided;
  std::optional<Error> without_value;
  std::size_t most_seeds = 0;
  for (const Cases& group : groups_of(claim, record)) {
    const std::vector<Decision> decisions = decide_group(claim, group, without_value);
    if (decisions.empty()) continue;
    const bool seeds = claim.over == ClaimOver::seed;
    decided.push_back(seeds ? over_seeds(decisions, group) : decisions.front());
    most_seeds = std::max(most_seeds, decisions.size());
    decided.back().record.passed_too = joined(decided.back().passed_too);
  }
  if (!decided.empty() && claim.over == ClaimOver::seed && !experiment.quick &&
      most_seeds < kLeastSeeds) {
    throw Error("only " + std::to_string(most_seeds) + " seeds have what it needs",
                "claim '" + claim.text + "'",
                "at least " + std::to_string(kLeastSeeds) + " in one case, of a sweep over `seed`");
  }
  if (!decided.empty()) return decided;
  if (without_value) throw Error(*without_value);
  throw Error("no case has what it is about", "claim '" + claim.text + "'",
              "variant '" + claim.variant + "'" + (claim.of ? " and '" + *claim.of + "'" : ""));
}

/// What speaks of several variants comes first: one that fails, one that its null passes too, the
/// one with the least margin.
bool speaks_before(const Decision& a, const Decision& b) {
  const auto rank = [](const Decision& one) {
    const ClaimOutcome outcome = outcome_of(one.record);
    return outcome == ClaimOutcome::falls_short      ? 0
           : outcome == ClaimOutcome::not_told_apart ? 1
                                                     : 2;
  };
  return rank(a) != rank(b) ? rank(a) < rank(b) : a.margin < b.margin;
}

/// One decision a case, of those of all variants that the claim is about.
void add_variant(std::vector<Decision> decided, std::vector<Decision>& all) {
  for (Decision& one : decided) {
    const auto known = std::find_if(all.begin(), all.end(), [&](const Decision& other) {
      return other.record.case_name == one.record.case_name;
    });
    if (known == all.end()) {
      all.push_back(std::move(one));
    } else if (speaks_before(one, *known)) {
      *known = std::move(one);
    }
  }
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

Decision decide_study(const ClaimSpec& claim, const Experiment& experiment, const RunRecord& record,
                      const std::vector<StudyRecord>& studies) {
  const Judgement own = judge_study(claim, studies);
  Decision decision;
  decision.record.text = claim.text;
  speak(decision, own.worst());
  const auto judge_null = [&](const std::string& null) {
    return judge_study(claim, studies_of_null(claim, experiment, record, null));
  };
  ask_null(claim, &own, judge_null, decision);
  if (claim.exempt == Exemption::timing) {
    const auto study = std::find_if(studies.begin(), studies.end(), [&](const StudyRecord& one) {
      return "study:" + one.name == claim.metric;
    });
    if (study != studies.end()) ask_clock(timed_margin(claim, *study), "", decision);
  }
  return decision;
}

/// A claim of one variant, in every case. Where a variant could not run it may be undecidable: it
/// falls short then, and the others are decided.
std::vector<Decision> decide_one(const ClaimSpec& claim, const Experiment& experiment,
                                 const RunRecord& record, const std::vector<StudyRecord>& studies) {
  try {
    if (claim.metric.starts_with("study:"))
      return {decide_study(claim, experiment, record, studies)};
    return decide_in_cases(claim, experiment, record);
  } catch (const Error& error) {
    if (!lacks_a_variant(record)) throw;
    Decision undecided;
    undecided.record.text = claim.text;
    undecided.record.detail = error.what();
    return {undecided};
  }
}

}  // namespace

std::vector<ClaimRecord> decide_claims(const Experiment& experiment, const RunRecord& record) {
  std::vector<ClaimRecord> decisions;
  std::vector<StudyRecord> studies = record.studies;
  if (studies.empty()) studies = make_studies(experiment, record);
  const std::vector<ClaimSpec>& claims = experiment.claims;
  for (auto claim = claims.begin(); claim != claims.end();) {
    const auto end = std::find_if(
        claim, claims.end(), [&](const ClaimSpec& other) { return other.text != claim->text; });
    std::vector<Decision> decided;
    for (; claim != end; ++claim)
      add_variant(decide_one(*claim, experiment, record, studies), decided);
    for (Decision& one : decided) decisions.push_back(std::move(one.record));
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

std::vector<ClaimRecord> unsound(const std::vector<ClaimRecord>& claims) {
  std::vector<ClaimRecord> found;
  for (const ClaimRecord& claim : claims) {
    const bool told = std::any_of(claims.begin(), claims.end(), [&](const ClaimRecord& other) {
      return other.text == claim.text && is_sound(other);
    });
    if (!told) found.push_back(claim);
  }
  return found;
}

}  // namespace geoprior
