#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "testbed/runner/spec/terms.h"

namespace geoprior {

struct StoredFile {
  std::string name;  ///< relative to the run folder
  std::string sha256;
};

struct FrameRecord {
  double parameter = 0;
  std::vector<StoredFile> files;  ///< one a part
};

struct MetricColumn {
  std::string unit;
  std::string definition;
  std::string direction;
  std::vector<double> values;  ///< one a frame; NaN where the metric has no value
};

struct DiagnosticColumn {
  std::string unit;  ///< empty, as the definition, where the topic's table has no such name
  std::string definition;
  std::vector<double> values;  ///< one a frame; NaN where absent
};

struct SummaryValue {
  double value = 0;
  std::string unit;
  std::string definition;
  std::string direction;
};

/// Resident memory of the process while a variant was prepared and run (bytes).
struct MemoryUse {
  std::uint64_t start = 0;  ///< before it
  std::uint64_t peak = 0;   ///< most at any time; minus `start`: what the variant needed
};

/// Everything known of one variant of one case.
struct VariantRecord {
  std::string name;
  std::string method;
  std::string role;
  std::string reference;
  std::string options_json;
  /// "done", "stopped", or "failed": `error` ended it, its frames are kept; without any it could
  /// not run
  std::string status;
  std::string error;  ///< of a failed variant
  std::vector<FrameRecord> frames;
  std::map<std::string, MetricColumn> metrics;
  std::map<std::string, SummaryValue>
      summary;  ///< sequence metrics, and max/median of frame metrics as "<name>.max"
  std::map<std::string, DiagnosticColumn> diagnostics;
  /// Phase: [frame][repetition] seconds. "load", "prepare" and "finish" (of a process: after its
  /// last frame) have one row.
  std::map<std::string, std::vector<std::vector<double>>> timing;
  std::optional<MemoryUse> memory;  ///< absent where it cannot be measured
  std::vector<Event> events;
  std::vector<StoredFile> artifacts;
};

/// A method that the scene is not for.
inline bool could_not_run(const VariantRecord& variant) {
  return variant.status == "failed" && variant.frames.empty();
}

/// The comparison of two variants' solve times in one run.
struct TimingRatio {
  std::string variant;
  std::string of;
  double median_ratio = 0;  ///< median over the pairs of time(variant) / time(of)
  double low = 0;           ///< bootstrap 95 % interval; NaN for one pair
  double high = 0;
  /// What a pair is: "frame" (frame and repetition), or "run" (a repetition) for processes whose
  /// frames differ.
  std::string paired = "frame";
};

struct CaseRecord {
  std::string name;
  std::string parameter_name;
  std::string parameter_unit;
  std::uint64_t seed = 0;
  int threads = 0;
  std::string scene_json;
  std::map<std::string, std::string> swept;
  std::map<std::string, double> facts;
  std::vector<std::string> warnings;
  std::string camera;  ///< that the scene suggests: keys of [figure_view] as TOML; empty: none
  std::vector<VariantRecord> variants;
  std::vector<TimingRatio> ratios;
  bool claims_only = false;  ///< decides claims and studies: not blessed, timed again or drawn
};

/// The variant of that name, or null.
inline const VariantRecord* find_variant(const CaseRecord& in, const std::string& name) {
  for (const VariantRecord& variant : in.variants) {
    if (variant.name == name) return &variant;
  }
  return nullptr;
}

struct StudyRecord {
  std::string name;
  std::string kind;
  std::string quantity;
  double value = 0;
  double low = 0;
  double high = 0;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> y_of;  ///< of "within-spread": the values of the variant compared with
};

/// The claim's inequality with its null in the place of its variant.
struct NullRecord {
  std::string variant;  ///< empty: the claim names none
  Discrimination verdict = Discrimination::unasked;
  double left = 0;  ///< of one seed: that in which the null came nearest to passing
  double right = 0;
  std::string detail;  ///< as the claim's; why it is undecided
};

/// How much of its method a claim needs: of output(s) = input + s (output - input), the smallest s,
/// in steps of 0.05, from which on it holds.
struct GradeRecord {
  std::string input;  ///< variant that does nothing; empty: none to grade from
  Graded of = Graded::not_graded;
  double least = std::numeric_limits<double>::quiet_NaN();  ///< 0: the input passes
};

struct ClaimRecord {
  std::string text;
  std::string case_name;
  std::string detail;  ///< "overlap_excess of implicit at angle 90 deg: 1e-07 <= 0.2 * 3e-06 m^3"
  double left = 0;
  double right = 0;
  bool holds = false;
  NullRecord null = {};
  std::string passed_too =
      {};  ///< further variants that the inequality holds for: "adaptive, dense"
  /// Of all others of the case, nulls too, the one that fails by least: "adaptive"; empty: none.
  std::string nearest = {};
  std::string excepted = {};  ///< why it need not hold in this case; empty: it must
  std::string variant = {};   ///< that speaks, of several that the claim is about
  GradeRecord grade = {};
};

/// A claim about a time whose interval does not tell it from equality: it names no null.
inline bool is_undecided_time(const ClaimRecord& claim) {
  return claim.null.verdict == Discrimination::undecided && claim.null.variant.empty();
}

/// What the record says: a claim that falls short does so whatever its null says.
inline ClaimOutcome outcome_of(const ClaimRecord& claim) {
  if (!claim.holds && !is_undecided_time(claim)) return ClaimOutcome::falls_short;
  const Discrimination verdict = claim.null.verdict;
  const bool told = verdict == Discrimination::discriminates || verdict == Discrimination::exempt;
  return told ? ClaimOutcome::holds : ClaimOutcome::not_told_apart;
}

/// Below this a claim is soft: what does a good part less than the method would pass, too.
inline constexpr double kSoftBelow = 0.7;

/// Whether the claim is graded, and soft.
inline bool is_soft(const ClaimRecord& claim) { return claim.grade.least < kSoftBelow; }

/// The memory image of a run: what run.h5 holds (docs/file-formats.md), what claims, check and
/// report read.
struct RunRecord {
  int schema_version = 4;
  std::string experiment_id;
  std::string title;
  std::string figure;
  std::string topic;
  bool quick = false;
  std::string experiment_toml;  ///< resolved text
  std::string spec_hash;
  std::string content_sha256;                     ///< frames and metrics, without times
  std::string frames_sha256;                      ///< frames, events and artifacts only
  std::string metrics_sha256;                     ///< metrics and summaries only
  std::map<std::string, std::string> provenance;  ///< git_commit, compiler, cpu, start, versions, …
  std::vector<StoredFile> inputs;                 ///< file name and sha256
  std::vector<CaseRecord> cases;
  std::vector<StudyRecord> studies;
  std::vector<ClaimRecord> claims;
};

/// Whether a variant of any case could not run.
inline bool lacks_a_variant(const RunRecord& record) {
  for (const CaseRecord& one : record.cases)
    for (const VariantRecord& variant : one.variants)
      if (could_not_run(variant)) return true;
  return false;
}

/// Writes run.h5 as temporary + fsync + rename. Throws Error naming the file.
void write_run_file(const RunRecord& record, const std::filesystem::path& file);

/// Throws Error naming the file and what is missing or damaged.
RunRecord read_run_file(const std::filesystem::path& file);

}  // namespace geoprior
