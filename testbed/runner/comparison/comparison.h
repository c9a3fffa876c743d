#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "testbed/runner/comparison/specification.h"
#include "testbed/runner/judgement/interval.h"
#include "testbed/runner/opened_run.h"
#include "testbed/topic.h"

namespace geoprior {

struct Gate;

/// What became of something between two runs. `worse` and `lost` are falls of quality.
enum class Change { worse, lost, better, changed };

/// Whether quality fell.
constexpr bool is_fall(Change change) { return change == Change::worse || change == Change::lost; }

/// A recorded summary value that moved by more than its tolerance, or came or went.
struct ValueChange {
  Change change = Change::changed;
  std::string case_name;
  std::string variant;  ///< "a → b" where variants of two names are compared
  std::string metric;   ///< "overlap_volume.max"; a metric of the sequence: its name
  std::string unit;
  Direction direction = Direction::none;
  double target = 0;          ///< for Direction::closer_to_target
  double before = 0;          ///< NaN: no value
  double after = 0;           ///< NaN: no value
  double tolerance = 0;       ///< of the value before
  std::string unjudged = {};  ///< why it cannot be a fall: "null control"; empty: it can
  /// How many tolerances it moved; infinite where one of the two has no value.
  [[nodiscard]] double tolerances() const;
};

/// A claim that comes to something else.
struct ClaimChange {
  Change change = Change::changed;
  std::string text;
  std::string case_name;
  std::string before;  ///< "holds", "falls short", "not told apart"
  std::string after;
  std::string detail;         ///< of the second run: the two sides
  std::string unjudged = {};  ///< why it cannot be a fall: "time", "excepted"; empty: it can
};

/// A variant that failed in one of the runs: its values are not compared.
struct StatusChange {
  Change change = Change::worse;
  std::string case_name;
  std::string variant;
  std::string before;  ///< "done", "failed: …"
  std::string after;
};

/// Time of the second run over that of the first.
struct TimeRatio {
  std::string case_name;
  std::string variant;
  std::string phase;    ///< "solve" of a pose method, "run" of a process, "whole run"
  double before_s = 0;  ///< median over frames and repetitions
  double after_s = 0;
  Interval ratio;         ///< median over the pairs; NaN bounds for one pair
  std::size_t pairs = 0;  ///< of equal frame and repetition
};

struct ComparisonRequest {
  bool common = false;  ///< compare what both have, whatever their specifications
  /// Variant of the first run, variant of the second. Empty: those of equal name.
  std::vector<std::pair<std::string, std::string>> variants = {};
};

/// What two runs differ in, each list with the worst first.
struct RunComparison {
  bool same_bytes = false;             ///< frames and metrics
  bool one_run = false;                ///< two variants of it
  std::vector<KeyDifference> keys;     ///< of the specifications
  std::vector<KeyDifference> options;  ///< of variants that were paired by hand
  std::vector<InputDifference> inputs;
  std::vector<ValueChange> values;
  std::size_t within = 0;  ///< values that moved by no more than their tolerance
  std::vector<ClaimChange> claims;
  std::size_t same_claims = 0;
  std::vector<StatusChange> statuses;
  std::vector<TimeRatio> times;
  bool same_processor = true;  ///< of both runs
  /// Metrics that no variant of one run has. Lost are those that this program judges.
  std::vector<std::string> added, gone, lost;
  std::vector<std::string> only_before, only_after;  ///< "case 'x'", "variant 'y', case 'x'"

  [[nodiscard]] bool fell() const;
  [[nodiscard]] std::size_t count(Change change) const;  ///< of values
};

/// Compares the summary values, claims and times of two runs of one topic. Directions and
/// tolerances are those of the topic's table and of the second run's [tolerance]; a metric that is
/// not in the table has its recorded direction and tolerance 0. Cases that decide claims only are
/// compared by their claims; of an experiment that bifurcates the median over the seeds is.
///
/// @throws Error  when the runs are of different topics; when their specifications differ and
///                `request.common` is false, naming keys; when they have nothing in common; for a
///                variant that a run does not have
RunComparison compare_runs(const OpenedRun& before, const OpenedRun& after, const Topic& topic,
                           const ComparisonRequest& request);

/// The comparison by itself: what changed of a value under a gate. Absent (NaN) values are a loss,
/// or merely a change where they appear.
/// @return  whether it is listed; `value` gets tolerance and change
bool judge_change(const Gate& gate, ValueChange& value);

}  // namespace geoprior
