#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "testbed/runner/run_record.h"

namespace geoprior {

/// Claims with their numbers, one line each.
void say_claims(const RunRecord& record);

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
