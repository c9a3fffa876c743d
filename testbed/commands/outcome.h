#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"

namespace geoprior {

/// What decided claims came to, each in each of its cases: "holds in 7, falls short in 1, not told
/// apart in 2; 1 soft"; "none" of none.
std::string claim_count_text(const std::vector<ClaimRecord>& claims);

/// What the claim's null says of it, in words.
std::string null_text(const ClaimRecord& claim);

/// "soft: holds from s = 0.55 of …, graded by frames"; empty for a claim that is not graded.
std::string grade_text(const ClaimRecord& claim);

/// Claims with their verdicts, one line each; below it the numbers of those that fall short, or of
/// all.
void say_claims(const RunRecord& record, bool all_numbers);

/// The lines of artifacts of these names (`Topic::told_files`), below the folder that each is in.
void say_told_files(const RunRecord& record, const std::set<std::string>& names,
                    const std::filesystem::path& folder, bool on_stdout);

/// Studies with their intervals.
void say_studies(const RunRecord& record);

/// One table a case: metrics by variants, and the median times; at most `most_cases` cases.
void say_summary(const RunRecord& record, std::size_t most_cases = 4);

/// True when no claim falls short where it must hold.
bool all_claims_hold(const RunRecord& record);

/// "variant 'x', case 'y': failed after 12 frames: why", or "…: cannot run: why", for every variant
/// that an error ended.
std::vector<std::string> failures(const RunRecord& record);

/// Identity, claims, studies and summary values of a run; NaN and infinities are null.
nlohmann::ordered_json outcome_json(const RunRecord& record, const std::filesystem::path& folder);

}  // namespace geoprior
