#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "testbed/runner/journal/journal.h"
#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/experiment.h"

namespace geoprior {

/// How far one variant of one case has come.
struct VariantState {
  VariantRecord record;  ///< summary: metrics of the sequence only; units are filled in at the end
  journal::Numbers prepare;        ///< "prepare" and the phases in it, s
  std::vector<StoredFile> inputs;  ///< beside the scene's
  bool begun = false;
  bool ended = false;
  std::optional<journal::CheckpointLine> checkpoint;
};

struct CaseState {
  CaseRecord record;                              ///< its `variants` are empty until `assemble`
  std::optional<std::vector<StoredFile>> inputs;  ///< absent: never loaded
  double load_seconds = 0;
  std::vector<VariantState> variants;  ///< in the order of the experiment
  bool timed = false;
};

/// What the lines of a journal add up to.
class RunState {
 public:
  /// A run of which nothing is done.
  explicit RunState(const Experiment& experiment);

  /// @throws Error  for a line that cannot follow those before it
  void apply(const journal::Line& line);

  [[nodiscard]] CaseState& case_of(const std::string& name);
  [[nodiscard]] VariantState& variant_of(const journal::Place& place);
  [[nodiscard]] const std::optional<journal::RunLine>& run() const { return run_; }
  /// Of the run so far, s; what a program used on a case that it was killed in is not known.
  [[nodiscard]] double processor_seconds() const { return processor_seconds_; }
  [[nodiscard]] std::vector<CaseState>& cases() { return cases_; }
  [[nodiscard]] const std::vector<CaseState>& cases() const { return cases_; }

 private:
  void apply(const journal::RunLine& line);
  void apply(const journal::CaseLine& line);
  void apply(const journal::BeginLine& line);
  void apply(const journal::RetryLine& line);
  void apply(const journal::FrameLine& line);
  void apply(const journal::EventLine& line);
  void apply(const journal::ArtifactLine& line);
  void apply(const journal::CheckpointLine& line);
  void apply(const journal::ResumeLine& line);
  void apply(const journal::EndLine& line);
  void apply(const journal::TimingLine& line);
  void apply(const journal::ErrorLine& /*line*/) {}
  void apply(const journal::ProcessorLine& line) { processor_seconds_ += line.seconds; }
  void apply(const journal::ResultLine& /*line*/) {}

  std::optional<journal::RunLine> run_;
  double processor_seconds_ = 0;
  std::vector<CaseState> cases_;
};

}  // namespace geoprior
