#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"

namespace geoprior {

/// How many claims a run has decided, and how.
struct ClaimCount {
  int hold = 0;
  int fall_short = 0;
};
ClaimCount count_claims(const RunRecord& record);

/// "4 hold, 1 falls short"; "none" for a run without claims.
std::string claim_count_text(const ClaimCount& count);

/// What the claim's null says of it, in words.
std::string null_text(const ClaimRecord& claim);

/// Claims with their verdicts, one line each; below it the numbers of those that fall short, or of
/// all.
void say_claims(const RunRecord& record, bool all_numbers);

/// Studies with their intervals.
void say_studies(const RunRecord& record);

/// One table a case: metrics by variants, and the median times; at most `most_cases` cases.
void say_summary(const RunRecord& record, std::size_t most_cases = 4);

/// True when every claim holds.
bool all_claims_hold(const RunRecord& record);

/// "variant 'x', case 'y': failed after 12 frames: why", for every variant that an error ended.
std::vector<std::string> failures(const RunRecord& record);

/// Identity, claims, studies and summary values of a run; NaN and infinities are null.
nlohmann::ordered_json outcome_json(const RunRecord& record, const std::filesystem::path& folder);

}  // namespace geoprior
