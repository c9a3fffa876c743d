#include "testbed/runner/reference/slack.h"

#include <algorithm>
#include <string>

#include "core/error.h"
#include "testbed/runner/judgement/claims.h"
#include "testbed/runner/number_text.h"

namespace geoprior {

std::optional<double> times_held(const ClaimSpec& claim, const ClaimRecord& decided) {
  const std::optional<double> share = slack(decided);
  if (!share || *share < 0 || decided.right < 0) return std::nullopt;
  switch (direction_of(claim.is)) {
    case Direction::lower_is_better:
      return 1 / *share;
    case Direction::higher_is_better:
      return *share;
    default:
      return std::nullopt;
  }
}

namespace {

/// That of the case nearest to failing; absent where nothing can be said.
std::optional<double> least_held(const ClaimSpec& claim, const std::vector<ClaimRecord>& claims) {
  std::optional<double> least;
  for (const ClaimRecord& decided : claims) {
    const ClaimOutcome outcome = outcome_of(decided);
    if (decided.text != claim.text || outcome == ClaimOutcome::not_told_apart) continue;
    if (outcome == ClaimOutcome::falls_short) {
      if (decided.excepted.empty()) return std::nullopt;
      continue;
    }
    const std::optional<double> times = times_held(claim, decided);
    if (!times) return std::nullopt;
    least = std::min(least.value_or(*times), *times);
  }
  return least;
}

}  // namespace

void require_near_limits(const Experiment& experiment, const std::vector<ClaimRecord>& claims) {
  for (const ClaimSpec& claim : experiment.claims) {
    if (claim.exempt == Exemption::timing || claim.slack) continue;
    const std::optional<double> times = least_held(claim, claims);
    if (!times || *times <= kMostTimesHeld) continue;
    throw Error("'" + claim.text + "' is held by " + rounded_text(*times) + " times its limit",
                experiment.file.string(),
                "a limit that the case nearest to failing holds by " +
                    rounded_text(kMostTimesHeld) + " times at most, or `slack`, which says why");
  }
}

}  // namespace geoprior
