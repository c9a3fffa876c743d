#pragma once

#include <map>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/topic.h"

namespace geoprior {

/// A hash of what each column of a run came to (case, variant): of its metrics and summaries, its
/// events and its artifacts. Two columns in which an option differs and whose hashes are equal say
/// that the option did nothing there.
using Outcomes = std::map<std::string, std::map<std::string, std::string>>;

/// The hexadecimal digits of a SHA-256 that stand for an outcome: with 48 bits, two of a thousand
/// different columns agree once in half a billion runs.
constexpr std::size_t kOutcomeDigits = 12;

/// The outcomes of a run's columns, its nulls' too: what a null changes is turned by it.
///
/// Metrics that compare with a reference variant are left out: a base has no distance to itself,
/// so that every variant measured against it would seem to differ. Left out as well are cases that
/// decide claims only, and methods whose results do not repeat.
Outcomes outcomes_of(const RunRecord& record, const Topic& topic);

/// How the outcomes of a run stand to those that were blessed.
struct OutcomeDifference {
  /// Columns whose outcome is another one, or that are new; another processor or compiler rounds
  /// differently, and does so too.
  std::vector<std::string> notices;
  /// Columns that have become equal, or that are gone.
  std::vector<std::string> failures;
};

OutcomeDifference compare_outcomes(const Outcomes& now, const Outcomes& blessed);

}  // namespace geoprior
