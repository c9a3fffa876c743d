#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"
#include "testbed/topic.h"

namespace geoprior {

/// The steps that a grade is looked for in, from the input (0) to the method's own output.
inline constexpr int kGradeSteps = 20;

/// Grades the claims of a finished run: asks of each how much of its method it needs.
///
/// A graded mutation of a method is input + s (output - input), 0 <= s <= 1, where the input is
/// what the method begins with, or what does nothing. It is made of the recorded frames, and the
/// metric of the claim is measured of it anew, of the frames that the claim reads. Where frames of
/// the two have another topology, or the metric follows something else (artifacts, counts,
/// diagnostics: at s = 0 it is then not that of the input), the metric's own values are mixed in
/// place of the frames. Claims about a study mix its values in all cases; a claim over seeds is
/// graded in the first.
class Grader {
 public:
  /// All must outlive this. `folder` has the frames of the run that `record` is of.
  Grader(const Experiment& experiment, const std::vector<Topic>& topics, const RunRecord& record,
         std::filesystem::path folder);
  ~Grader();
  Grader(const Grader&) = delete;
  Grader& operator=(const Grader&) = delete;

  /// Not graded: a claim that falls short, one that needs no null (a time, an oracle), one about
  /// the input itself, and one of a case that has no input.
  [[nodiscard]] GradeRecord grade(const ClaimRecord& decided);
  /// Whether the claim holds of the mutation at `step` of kGradeSteps, graded as `of` says; absent
  /// where it has no value.
  [[nodiscard]] std::optional<bool> holds_at(const ClaimRecord& decided, Graded of, int step);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The cases that they were decided in, each once: a Grader keeps one scene at a time.
std::vector<std::string> cases_of(const std::vector<ClaimRecord>& claims);

/// Puts the grade of each claim into the record.
void grade_claims(const Experiment& experiment, const std::vector<Topic>& topics,
                  const std::filesystem::path& folder, RunRecord& record);

}  // namespace geoprior
